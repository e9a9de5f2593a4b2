// SPDX-License-Identifier: MIT
#include "lattice/plan/sigma_method.hpp"

#include <algorithm>
#include <utility>

#include "lattice/plan/assignment.hpp"

namespace delf {
namespace {

/// c_e = d_u − σ(e, u) on the matching.
std::vector<int> matched_offsets(const StructuralAnalysis& analysis, const std::vector<Occurrence>& occurrences) {
  std::vector<int> c;
  for (const int match : analysis.match) c.push_back(analysis.d[occurrences[match].unknown] - occurrences[match].time);
  return c;
}

}  // namespace

StructuralAnalysis analyse(int size, const std::vector<Occurrence>& occurrences) {
  std::vector<Weight> weights(size * size);
  std::vector<int> latest(size * size, -1);
  for (int n = 0; n < static_cast<int>(occurrences.size()); ++n) {
    const Occurrence& o = occurrences[n];
    const int pair = o.equation * size + o.unknown;
    const Weight weight{1, o.time, -o.farness};
    if (latest[pair] < 0 || weights[pair] < weight) weights[pair] = weight, latest[pair] = n;  // σ(e, u)
  }

  StructuralAnalysis analysis;
  const std::vector<int> unknown_of = best_assignment(size, weights);
  for (int e = 0; e < size; ++e) {
    analysis.match.push_back(latest[e * size + unknown_of[e]]);
    if (analysis.match.back() >= 0) continue;
    analysis.unmatched_equations.push_back(e);
    analysis.unmatched_unknowns.push_back(unknown_of[e]);
  }
  std::ranges::sort(analysis.unmatched_unknowns);
  if (analysis.solvable()) raise_offsets(analysis, occurrences, std::vector<int>(size, 0));
  return analysis;
}

// The bounds on d: with c_e = d_u − σ(e, u) on the matching, d_v ≥ c_e + σ(e, v) bounds the difference of two. Moving
// d to the bound finds longest paths, and terminates: a cycle that gained rows would be a better matching.

void raise_offsets(StructuralAnalysis& analysis, const std::vector<Occurrence>& occurrences, std::vector<int> least) {
  std::vector<int>& d = analysis.d = std::move(least);
  for (bool raised = true; raised;) {
    raised = false;
    analysis.c = matched_offsets(analysis, occurrences);
    for (const Occurrence& o : occurrences)
      if (d[o.unknown] < analysis.c[o.equation] + o.time) d[o.unknown] = analysis.c[o.equation] + o.time, raised = true;
  }
}

void lower_offsets(StructuralAnalysis& analysis, const std::vector<Occurrence>& occurrences, std::vector<int> most) {
  std::vector<int>& d = analysis.d = std::move(most);
  std::vector<int>& c = analysis.c = matched_offsets(analysis, occurrences);
  for (bool lowered = true; lowered;) {
    lowered = false;
    for (const Occurrence& o : occurrences)
      if (c[o.equation] > d[o.unknown] - o.time) c[o.equation] = d[o.unknown] - o.time, lowered = true;
    for (std::size_t e = 0; e < c.size(); ++e) {
      const Occurrence& solved = occurrences[analysis.match[e]];
      d[solved.unknown] = c[e] + solved.time;
    }
  }
}

}  // namespace delf

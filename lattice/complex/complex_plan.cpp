// SPDX-License-Identifier: MIT
#include "lattice/complex/complex_plan.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/plan/block_order.hpp"

namespace delf {
namespace {

using Index = std::int32_t;

std::string some_names(const Complex& complex, const std::vector<Index>& sites, const std::vector<Index>& chosen) {
  constexpr std::size_t most = 3;
  std::string text;
  for (std::size_t n = 0; n < std::min(most, chosen.size()); ++n)
    text += (n == 0 ? "" : ", ") + complex.name(sites[chosen[n]]);
  if (chosen.size() > most) text += " and " + std::to_string(chosen.size() - most) + " more";
  return text;
}

[[noreturn]] void refuse(const Complex& complex, const ComplexIncidence& all, const Matching& matching) {
  const IllPosed parts = ill_posed_parts(all.contains, matching);
  std::string text = "lattice.mesh: the data do not pose a problem: ";
  if (!parts.rows.empty())
    text +=
        "more equations than unknowns at " + some_names(complex, all.equations, parts.rows) + "; give fewer data there";
  if (!parts.columns.empty())
    text += std::string(parts.rows.empty() ? "" : "; ") + "no equation is left for the values of " +
            some_names(complex, all.unknowns, parts.columns) + "; give data there";
  throw BadInput("lattice.mesh", text);
}

/// Of each unknown, the number of its block; a block is numbered after all that it needs.
std::vector<Index> blocks_of(const Incidence& contains, const Matching& matching, Index& count) {
  std::vector<std::pair<int, int>> edges;
  edges.reserve(contains.entries.size());
  for (Index u = 0; u < contains.columns; ++u)
    for (const Index v : contains.row(matching.row_of[u]))
      if (v != u) edges.emplace_back(u, v);
  const auto blocks = blocks_in_order(contains.columns, edges);
  count = static_cast<Index>(blocks.size());
  std::vector<Index> block(contains.columns);
  for (Index b = 0; b < count; ++b)
    for (const int u : blocks[b]) block[u] = b;
  return block;
}

}  // namespace

ComplexIncidence incidence_of(const Complex& complex, const Touching& touching) {
  ComplexIncidence all;
  std::vector<Index> number(complex.sites(), -1), seen(at(complex.sites()), -1);
  for (Index s = 0; s < complex.sites(); ++s) {
    if (complex.is_unknown(s)) number[s] = static_cast<Index>(all.unknowns.size()), all.unknowns.push_back(s);
    if (complex.has_equation(s)) all.equations.push_back(s);
  }
  all.contains.columns = static_cast<Index>(all.unknowns.size());
  for (const Index b : all.equations) {
    const auto begin = static_cast<std::ptrdiff_t>(all.contains.entries.size());
    for (const Index stencil : touching[b]) {
      const auto vertices = complex.vertices(stencil);
      const auto l = static_cast<int>(std::find(vertices.begin(), vertices.end(), b) - vertices.begin());
      for (int m = 0; m < static_cast<int>(vertices.size()); ++m) {
        const Index site = vertices[m];
        if (number[site] < 0 || seen[site] == b || !complex.shape(stencil).is_coupled(l, m)) continue;
        seen[site] = b;
        all.contains.entries.push_back(number[site]);
      }
    }
    std::sort(all.contains.entries.begin() + begin, all.contains.entries.end());
    all.contains.first.push_back(static_cast<std::int64_t>(all.contains.entries.size()));
  }
  return all;
}

ComplexPlan make_plan(const Complex& complex, const Touching& touching) {
  const ComplexIncidence all = incidence_of(complex, touching);
  const Matching matching = largest_matching(all.contains);
  if (!matching.is_perfect()) refuse(complex, all, matching);
  Index count = 0;
  const std::vector<Index> block = blocks_of(all.contains, matching, count);

  // A block's level is one more than those of all blocks that it contains unknowns of.
  std::vector<Index> by_block(block.size());
  std::iota(by_block.begin(), by_block.end(), 0);
  std::stable_sort(by_block.begin(), by_block.end(), [&](Index u, Index v) { return block[u] < block[v]; });
  std::vector<Index> level(count, 0);
  for (const Index u : by_block)
    for (const Index v : all.contains.row(matching.row_of[u]))
      if (block[v] != block[u]) level[block[u]] = std::max(level[block[u]], level[block[v]] + 1);
  std::stable_sort(by_block.begin(), by_block.end(),
                   [&](Index u, Index v) { return level[block[u]] < level[block[v]]; });

  ComplexPlan plan;
  for (std::size_t n = 0; n < by_block.size(); ++n) {
    const Index u = by_block[n];
    if (n > 0 && block[u] != block[by_block[n - 1]]) plan.first.push_back(static_cast<Index>(n));
    if (n == 0 || block[u] != block[by_block[n - 1]]) plan.level.push_back(level[block[u]]);
    plan.unknowns.push_back(all.unknowns[u]);
    plan.equations.push_back(all.equations[matching.row_of[u]]);
    plan.levels = std::max(plan.levels, level[block[u]] + 1);
  }
  if (!by_block.empty()) plan.first.push_back(static_cast<Index>(by_block.size()));
  std::vector<int> width(plan.levels, 0);
  for (int b = 0; b < plan.blocks(); ++b) {
    plan.largest = std::max(plan.largest, plan.first[at(b) + 1] - plan.first[b]);
    plan.widest = std::max(plan.widest, ++width[plan.level[b]]);
  }
  return plan;
}

std::vector<Index> ComplexPlan::level_of_sites(int sites) const {
  std::vector<Index> of_site(sites, -1);
  for (int b = 0; b < blocks(); ++b)
    for (Index n = first[b]; n < first[at(b) + 1]; ++n) of_site[unknowns[n]] = level[b];
  return of_site;
}

std::string ComplexPlan::describe() const {
  const std::string count = std::to_string(unknowns.size()) + " unknowns";
  if (unknowns.empty()) return "nothing to solve: every value is data";
  if (blocks() == 1) return "one block of " + count;
  const std::string in_levels = std::to_string(levels) + (levels == 1 ? " level, " : " levels, ") + count;
  if (largest == 1) return in_levels + ", each in a block of its own";
  return in_levels + " in " + std::to_string(blocks()) + " blocks, the largest of " + std::to_string(largest);
}

}  // namespace delf

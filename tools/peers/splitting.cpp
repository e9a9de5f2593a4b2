// SPDX-License-Identifier: MIT
#include "tools/peers/splitting.hpp"

#include <cstddef>

#include "jets/tables/splitting.hpp"

namespace delf::peers {
namespace {

/// w_1 … w_n, mirrored after the last of them, or at it.
std::vector<double> mirrored(std::vector<double> half, bool at_last) {
  const std::vector<double> given = half;
  half.insert(half.end(), given.rbegin() + (at_last ? 1 : 0), given.rend());
  return half;
}

/// The weights, mirrored, with the last one chosen so that all sum to 1.
std::vector<double> mirrored_to_one(std::vector<double> half, bool at_last) {
  double rest = at_last ? 1 : 0.5;
  for (const double w : half) rest -= at_last ? 2 * w : w;
  half.push_back(rest);
  return mirrored(half, at_last);
}

}  // namespace

Splitting composed(bool flows_first, const std::vector<double>& half) {
  const std::vector<double> inner = mirrored(half, true);
  std::vector<double> outer{inner.front() / 2};
  for (std::size_t i = 1; i < inner.size(); ++i) outer.push_back((inner[i - 1] + inner[i]) / 2);
  outer.push_back(inner.back() / 2);
  return {flows_first, outer, inner, {}};
}

Splitting strang() { return composed(true, {1}); }

// The peers get the splittings of the engine too, with their sources in jets/tables/splitting.hpp.
static Splitting kicks_first(const delf::Splitting& splitting) {
  return {false, splitting.kicks, splitting.drifts, {}};
}
Splitting blanes_moan_4() { return kicks_first(splitting_of_order(4)); }
Splitting blanes_moan_6b() { return kicks_first(splitting_of_order(6)); }
Splitting kahan_li_8_kicks() { return kicks_first(splitting_of_order(8)); }

// States are those between flows, and in the middle of kicks: the engine's processors go on to the rows of its kernels.
Splitting processed_ti4() {
  const delf::Splitting kernel = processed_splitting("ti4");
  Processor processor = kernel.processor;
  processor.drifts.back() -= kernel.offset;
  return {true, {0.5, 0.5}, {1}, processor, kernel.gradient};
}
Splitting processed_b6() {
  const delf::Splitting kernel = processed_splitting("b6");
  Processor processor = kernel.processor;
  processor.kicks.back() += kernel.kicks.front();
  return {false, kernel.kicks, kernel.drifts, processor};
}

// S. Blanes and P. C. Moan, J. Comput. Appl. Math. 142 (2002), Table 3: SRKN of order 6 with 14 stages, "a".
Splitting blanes_moan_6a() {
  return {true,
          mirrored_to_one({0.0378593198406116, 0.102635633102435, -0.0258678882665587, 0.314241403071447,
                           -0.130144459517415, 0.106417700369543, -0.00879424312851058},
                          true),
          mirrored_to_one({0.09171915262446165, 0.183983170005006, -0.05653436583288827, 0.004914688774712854,
                           0.143761127168358, 0.328567693746804},
                          false),
          {}};
}

Splitting kahan_li_8_flows() {
  const std::vector<double> gamma = splitting_of_order(8).drifts;
  return composed(true, {gamma.begin(), gamma.begin() + static_cast<std::ptrdiff_t>(gamma.size() + 1) / 2});
}

}  // namespace delf::peers

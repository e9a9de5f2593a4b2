// SPDX-License-Identifier: MIT
#include "jets/one_jet.hpp"

#include <algorithm>

#include "jets/simd/scratch_rows.hpp"

namespace delf {
namespace {

/// The first of a pack of equal jets.
template <class Evaluate>
std::vector<double> first_of(std::span<const double> jet, double t, double x, int results, const Evaluate& evaluate) {
  const int m = static_cast<int>(jet.size());
  const ScratchRows in(m + 1, lanes), out(results, lanes);
  for (int v = 0; v <= m; ++v) std::fill_n(in[v], lanes, v < m ? jet[v] : x);
  evaluate(JetBatch{lanes, in.data(), t, in[m]}, out.data());
  std::vector<double> first;
  for (int r = 0; r < results; ++r) first.push_back(out[r][0]);
  return first;
}

}  // namespace

std::vector<double> gradient_at(const BatchDensity& density, std::span<const double> jet, double t, double x) {
  return first_of(jet, t, x, density.variables(),
                  [&](const JetBatch& batch, double* const* g) { density.gradient(batch, g); });
}

std::vector<double> hessian_at(const BatchDensity& density, std::span<const double> jet, double t, double x) {
  return first_of(jet, t, x, density.variables() * density.variables(),
                  [&](const JetBatch& batch, double* const* H) { density.hessian(batch, H); });
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/families/mirror_check.hpp"

#include <cmath>
#include <cstddef>
#include <random>

#include "jets/simd/scratch_rows.hpp"

namespace delf {

bool has_mirror_images(const BatchDensity& density, Mirror mirror, std::span<const double> wall) {
  constexpr int trials = 64;
  // The tail of a kink ends near its vacuum, not on it. Equations and action agree about any wall; what is not even costs as
  // much accuracy.
  constexpr double tolerance = 1e-6;
  const int d = density.components(), m = density.variables();
  const ScratchRows jets(m, trials), images(m, trials), x(1, trials), values(2, trials);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> some(-2, 2);
  const double t = some(random);
  for (int i = 0; i < trials; ++i) {
    x[0][i] = some(random);
    for (int v = 0; v < m; ++v) jets[v][i] = (v < d ? wall[v] : 0) + some(random);
  }
  const auto even = [&](int first, const auto& image) {
    for (int v = 0; v < m; ++v)
      for (int i = 0; i < trials; ++i) images[v][i] = v / d == first ? image(v % d, jets[v][i]) : jets[v][i];
    density.value({trials, jets.data(), t, x[0]}, values[0]);
    density.value({trials, images.data(), t, x[0]}, values[1]);
    for (int i = 0; i < trials; ++i)
      if (!(std::abs(values[0][i] - values[1][i]) <= tolerance * (1 + std::abs(values[0][i])))) return false;
    return true;
  };
  if (!even(2, [](int, double phi_x) { return -phi_x; })) return false;
  return mirror == Mirror::even || even(0, [&](int a, double phi) { return 2 * wall[a] - phi; });
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/warnings/linear_limit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "schemes/stability/linear_stability.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {
namespace {

// The largest |z| of the waves that the lattice has near θ: θ_j = 2πj/N on a circle, πj/(N − 1) between walls.
double growth_near(const Symbol& symbol, const Lattice& lattice, double theta) {
  if (lattice.space() == Space::point) return symbol.amplification(0);
  const double apart = (lattice.is_circle() ? 2 : 1) * std::numbers::pi / lattice.cells();
  const auto nearest = static_cast<int>(std::lround(theta / apart));
  constexpr int window = 16;
  double most = 1;
  for (int j = std::max(0, nearest - window); j <= nearest + window; ++j)
    most = std::max(most, symbol.amplification(std::min(j * apart, std::numbers::pi)));
  return most;
}

}  // namespace

std::optional<std::string> beyond_linear_limit(const Scene& scene, const Simulation& simulation, std::int64_t steps) {
  const auto symbol = symbol_of(scene, simulation);
  if (!symbol || steps == 0) return {};
  // A few wave numbers for the many roots of an element; between them the analysis looks where roots meet.
  const StabilityVerdict verdict = linear_stability(*symbol, symbol->size() > 1 ? 33 : 101);
  if (verdict.stable) return {};
  const double growth = growth_near(*symbol, scene.problem.lattice, verdict.worst_theta);
  if (!std::isfinite(growth)) return {};  // steps of that wave have no solution, and these had one: walls hold it
  const double decades = static_cast<double>(steps) * std::log10(growth);
  if (!(decades > 1)) return {};
  return fmt::format(
      "beyond the linear limit of the scheme: waves near qk = {:.3g} grow by {:.4g} in each step, by "
      "1e{:.0f} in all; reduce {} (`delf stability` finds the limit)",
      verdict.worst_theta, growth, decades,
      scene.problem.lattice.space() == Space::point ? "lattice.time_step" : "lattice.courant");
}

}  // namespace delf

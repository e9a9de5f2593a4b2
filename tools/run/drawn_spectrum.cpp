// SPDX-License-Identifier: MIT
#include "tools/run/drawn_spectrum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "jets/simd/scratch_rows.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {
namespace {

/// Waves e^{i(kx − ωt)} of one field about a constant: ℓ_tt ω² − 2ℓ_tx ωk + ℓ_xx k² + ℓ_φφ = 0, ℓ_tt = ∂²ℓ/∂φ_t², ….
void add_continuum(const BatchDensity& density, double constant, double k, std::vector<std::array<double, 2>>& waves) {
  if (density.components() != 1 || density.slots() != 3) return;
  const ScratchRows jet(4, lanes), H(9, lanes);
  for (int a = 0; a < 4; ++a) std::fill_n(jet[a], lanes, a == 0 ? constant : 0.0);
  density.hessian({lanes, jet.data(), 0, jet[3]}, H.data());
  const double tt = H[4][0], tx = H[5][0], xx = H[8][0], values = H[0][0];
  const double c = xx * k * k + values, root = tx * tx * k * k - tt * c;
  if (tt == 0) {
    if (tx != 0 && k != 0) waves.push_back({k, std::abs(c / (2 * tx * k))});
  } else if (root >= 0) {
    waves.push_back({k, std::abs((tx * k + std::sqrt(root)) / tt)});
    if (tx != 0) waves.push_back({k, std::abs((tx * k - std::sqrt(root)) / tt)});
  }
}

}  // namespace

DrawnSpectrum waves_of(const Scene& scene, const Simulation& simulation) {
  DrawnSpectrum spectrum;
  const auto vacuum = stable_vacuum(scene, simulation);
  const auto symbol = symbol_of(scene, simulation);
  if (!vacuum || !symbol || symbol->zone() == 0) return spectrum;
  constexpr int count = 300;
  constexpr double damped = 0.5;  // a root that loses half of itself in a step is no wave
  for (int n = 1; n <= count; ++n) {
    const double theta = symbol->zone() * n / count, k = theta / symbol->space_step();
    for (const std::complex<double>& z : symbol->roots(theta))
      if (std::isfinite(std::abs(z)) && std::abs(z) > damped)
        spectrum.lattice.push_back({k, std::abs(std::arg(z)) / symbol->time_step()});
    add_continuum(simulation.theory().density(), *vacuum, k, spectrum.continuum);
  }
  spectrum.about = fmt::format("φ = {:.4g}", *vacuum);
  return spectrum;
}

}  // namespace delf

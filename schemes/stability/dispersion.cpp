// SPDX-License-Identifier: MIT
#include "schemes/stability/dispersion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <set>

#include "lattice/error.hpp"

namespace delf {
namespace {

using Complex = Symbol::Complex;
using std::numbers::pi;

/// |⟨v, w⟩|²/|v|²|w|² of the mode and the plane wave of the same θ, w = e^{iκk x}, over the nodes on the rows.
double likeness(const Symbol& symbol, Complex z, double wave_number) {
  const std::vector<Complex> v = symbol.mode(z, wave_number);
  Complex product = 0;
  double of_mode = 0, of_wave = 0;
  for (int i = 0; i < symbol.size(); ++i) {
    const NodePosition at = symbol.position(i);
    if (at.time != 0) continue;
    const Complex value = v[i];
    product += std::polar(1.0, -wave_number * at.space) * value;
    of_mode += std::norm(value), of_wave += 1;
  }
  return of_mode > 0 ? std::norm(product) / (of_mode * of_wave) : 0;
}

}  // namespace

std::vector<DispersionPoint> dispersion(const Symbol& symbol, double mass, int count) {
  if (symbol.fields() != 1)
    throw BadInput("theory.name", "theory.name: the dispersion relation is written for one field; use such a theory");
  if (symbol.zone() == 0)
    throw BadInput("theory.name", "theory.name: a point has no waves, and so no dispersion relation; use a field");
  std::set<double> columns;
  for (int v = 0; v < symbol.components(); ++v) columns.insert(symbol.position(v).space);
  const double end = pi * static_cast<double>(columns.size()), h = symbol.time_step(), k = symbol.space_step();

  // Small strides between the points, so that roots do not change places unseen.
  const int strides = std::max(1, static_cast<int>(std::ceil(end / pi * 200 / std::max(count - 1, 1))));
  std::vector<DispersionPoint> result;
  double phase = 0, before = 0;
  for (int i = 0; i <= (count - 1) * strides; ++i) {
    const double wave_number = end * i / std::max((count - 1) * strides, 1);
    const double exact = h * std::hypot(mass, wave_number / k);
    std::vector<Complex> z = symbol.roots(wave_number);
    double best = 0;
    std::vector<double> like;
    for (const Complex& root : z) {
      const bool usable = std::isfinite(root.real()) && std::abs(root) > 1e-8;
      like.push_back(usable ? likeness(symbol, root, wave_number) : 0);
      best = std::max(best, like.back());
    }
    // The branch is the root like a plane wave nearest to what is expected; at κ = 0 that in the upper half.
    // It goes from one root to the next as the exact ones go.
    const double expected = i == 0 ? std::min(exact, pi) : phase + exact - before;
    double nearest = std::numeric_limits<double>::infinity(), found = expected, size = std::abs(z[0]);
    for (std::size_t r = 0; r < z.size(); ++r) {
      if (!(like[r] >= 0.98 * best) || best == 0) continue;
      double angle = std::arg(z[r]);
      if (i == 0) angle = std::abs(angle);
      angle += 2 * pi * std::round((expected - angle) / (2 * pi));
      if (std::abs(angle - expected) >= nearest) continue;
      nearest = std::abs(angle - expected), found = angle, size = std::abs(z[r]);
    }
    before = exact, phase = found;
    if (i % strides == 0) result.push_back({wave_number, exact, found, size});
  }
  return result;
}

}  // namespace delf

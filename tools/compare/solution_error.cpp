// SPDX-License-Identifier: MIT
#include "tools/compare/solution_error.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "lattice/index.hpp"
#include "schemes/state.hpp"

namespace delf {

namespace {

// The site i of a field that gains `monodromy` around a circle.
double continued(const Lattice& lattice, std::span<const double> row, int d, int a, double monodromy, int i) {
  const int home = lattice.wrapped(i), times = (i - home) / lattice.sites();
  return row[home * d + a] + monodromy * times;
}

}  // namespace

bool has_exact(const Scene& scene, double until) {
  if (scene.from_file()) return false;
  try {
    const auto state = make_state(scene.initial, scene.problem.lattice);
    return state->exact() && until <= state->exact_until();
  } catch (const BadInput& bad) {
    throw scene.settings.located(bad);
  }
}

ComparedSolution ComparedSolution::exact(const Scene& scene, double until) {
  if (!has_exact(scene, until)) throw std::logic_error("no exact solution of this scene is known");
  ComparedSolution solution;
  solution.scene_ = &scene;
  solution.components_ = make_state(scene.initial, scene.problem.lattice)->components();
  return solution;
}

ComparedSolution ComparedSolution::reference(const Lattice& fine, int d, double monodromy, std::vector<double> row) {
  ComparedSolution solution;
  solution.components_ = d;
  solution.fine_ = fine;
  solution.monodromy_ = monodromy;
  solution.row_ = std::move(row);
  return solution;
}

std::vector<double> ComparedSolution::at(const Lattice& lattice, double t) const {
  const int N = lattice.sites(), d = components_;
  std::vector<double> out(N * d);
  if (scene_) {
    make_state(scene_->initial, lattice)->values(t, lattice, out);
    return out;
  }
  // Lagrange's polynomial through the ten fine sites around x; at a fine site, the value there.
  constexpr int points = 10;
  const int M = fine_->sites(), used = std::min(points, M);
  for (int i = 0; i < N; ++i) {
    const double place = lattice.position(i) / fine_->space_step(), nearest = std::round(place);
    const bool on_site = std::abs(place - nearest) < 1e-9 * std::max(1.0, nearest);
    int first = static_cast<int>(std::floor(place)) - used / 2 + 1;
    if (!fine_->is_circle()) first = std::clamp(first, 0, M - used);
    for (int a = 0; a < d; ++a) {
      double sum = 0;
      for (int m = 0; m < used && !on_site; ++m) {
        double weight = 1;
        for (int n = 0; n < used; ++n)
          if (n != m) weight *= (place - (first + n)) / (m - n);
        sum += weight * continued(*fine_, row_, d, a, monodromy_, first + m);
      }
      out[i * d + a] = on_site ? continued(*fine_, row_, d, a, monodromy_, static_cast<int>(nearest)) : sum;
    }
  }
  return out;
}

double gradient_centre(const Lattice& lattice, std::span<const double> field, int components, double monodromy) {
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  if (lattice.space() == Space::point) return unknown;
  const int N = lattice.sites();
  double total = 0, moment = 0;
  std::complex<double> around = 0;
  for (int i = lattice.is_circle() ? 0 : 1; i < (lattice.is_circle() ? N : N - 1); ++i) {
    // φ_x at site i, from both sides
    const double slope = continued(lattice, field, components, 0, monodromy, i + 1) -
                         continued(lattice, field, components, 0, monodromy, i - 1);
    const double weight = slope * slope;
    total += weight, moment += weight * lattice.position(i);
    around += weight * std::polar(1.0, 2 * std::numbers::pi * lattice.position(i) / lattice.length());
  }
  if (!(total > 0)) return unknown;
  if (!lattice.is_circle()) return moment / total;
  constexpr double least = 0.05;  // of a field spread evenly the angle means nothing
  if (!(std::abs(around) > least * total)) return unknown;
  return std::arg(around) * lattice.length() / (2 * std::numbers::pi);
}

double separation(const Lattice& lattice, double a, double b) {
  return lattice.is_circle() ? std::remainder(a - b, lattice.length()) : a - b;
}

}  // namespace delf

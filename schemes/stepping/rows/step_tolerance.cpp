// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/step_tolerance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/index.hpp"

namespace delf {
namespace {

constexpr double round_off_of_step = std::numeric_limits<double>::epsilon();

/// The change of y by a change of 1 in a source term, [source][component]: exact on a circle, where one impulse shows
/// it. In the middle of an interval it is near enough: the tolerance is tested by it, and the change itself is what
/// ends an iteration.
std::vector<std::vector<double>> gains_of(int d, const RowEquations& equations, const RowLayout& layout,
                                          RowTable& table) {
  constexpr std::int64_t first_step = -1;
  std::vector<std::vector<double>> gains;
  for (const SourceRow& source : equations.sources()) {
    std::vector<double>& gain = gains.emplace_back(at(d), 0.0);
    if (!source.reads_unknown) continue;
    double* const delta = table[source.correction];
    // Two sites in the middle: a source term at a wall, or between bricks, is read by no equation.
    for (const SourceRow& other : equations.sources())
      if (other.reads_unknown) std::fill_n(table[other.correction], layout.doubles(), 0.0);
    for (const int site : {layout.sites() / 2 - 1, layout.sites() / 2}) {
      std::fill_n(delta, layout.doubles(), 0.0);
      for (const int slot : layout.slots_of(site)) delta[slot] = 1;
      layout.fill_halo(delta);
      RowBuffer memory(layout, d);
      std::vector<double*> w;
      for (int a = 0; a < d; ++a) w.push_back(memory.row(a));
      equations.right_sides(table, first_step, Solving::correction, 0, layout.packs(), w.data());
      equations.solver(first_step).solve(w.data());
      std::vector<double> sites(layout.sites());
      for (std::size_t a = 0; a < gain.size(); ++a) {
        layout.gather(w[a], sites);
        double sum = 0;
        for (const double x : sites) sum += std::abs(x);
        gain[a] = std::max(gain[a], sum);
      }
    }
    std::fill_n(delta, layout.doubles(), 0.0);
  }
  return gains;
}

}  // namespace

StepTolerance::StepTolerance(const LatticeSystem& system, const RowEquations& equations, const RowLayout& layout,
                             RowTable& table, const StepOptions& options)
    : equations_(equations),
      layout_(layout),
      d_(system.components()),
      tolerance_(options.tolerance),
      contraction_(equations, gains_of(d_, equations, layout, table)) {
  for (const std::vector<double>& of_source : contraction_.gains())
    gains_.push_back(*std::ranges::max_element(of_source));
}

double StepTolerance::effect_of(const std::vector<double>& changes) const {
  double effect = 0;
  for (std::size_t s = 0; s < gains_.size(); ++s) effect += gains_[s] * changes[s];
  return effect;
}

void StepTolerance::see_span(const RowTable& table) {
  span_ = 0;
  for (int a = 0; a < d_; ++a) {
    const double* const y = table[equations_.y().row(1, a)];
    const double some = y[layout_.slot(0)];
    Pack above(0.0), below(0.0);
    for (int p = 0; p < layout_.packs(); ++p) {
      const Pack difference = Pack::load(y + layout_.at(p)) - some;
      above = max_or_nan(difference, above), below = max_or_nan(-difference, below);
    }
    span_ = std::max(span_, max_or_nan(above) + max_or_nan(below));
  }
}

/// A share of the tolerance, which is relative to what the field spans, as its mean may have drifted anywhere, but not below
/// what rounding leaves at its size. The share: a prediction's error has the same sign step after step, and moves the energy,
/// in 5000 collisions (N = 255, h = k/8, tolerance 6e-8) by 1e-4 with all of the tolerance, out of the band that the paper
/// prints with 0.04 of it, and by this share as little as the exact root. The smallest tolerances ask for all that can be
/// seen, after many steps too: with half a unit in the last place of y a million steps of Kepler's midpoint lose 1e-9 of the
/// angular momentum, and with a hundredth of it no more than by rounding.
double StepTolerance::enough(double size) const {
  constexpr double share = 0.01;
  if (tolerance_ < smallest_estimated) return share * round_off_of_step * size;
  const double spanned = span_ > 0 ? std::min(span_, size) : size;
  return share * std::max(tolerance_ * spanned, 4 * round_off_of_step * size);
}

}  // namespace delf

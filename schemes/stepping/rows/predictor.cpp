// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/predictor.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace delf {
namespace {

constexpr int most_order = 8;
// The lowest useful order: errors of lower ones are in phase with the wave, and feed or damp it step after step.
constexpr int lowest_order = 4;
// Lower orders serve where what all steps of a unit of time leave together is less than this part of the tolerance.
constexpr double left_in_unit_time = 0.05;
// The cost of an iteration, in rows read: an evaluation of the density and a solve.
constexpr double rows_per_iteration = 24;
constexpr int steps_between_choices = 128;
constexpr int sites_in_cache = 1 << 15;

}  // namespace

int Predictor::rows_for(int wanted, int sites) {
  return std::clamp(wanted, 1, sites <= sites_in_cache ? most_order : 3);
}

Predictor::Predictor(const RowEquations& equations, const RowLayout& layout, int most_rows)
    : equations_(equations), layout_(layout), most_(most_rows) {}

void Predictor::choose(const RowTable& table, std::int64_t n, int rows_there, const std::vector<double>& gains,
                       double contraction, double allowed, double time_step) {
  // ∇^p g needs p + 1 rows.
  const int most = std::min(most_, rows_there - 1);
  order_ = std::max(1, std::min(most_, rows_there));
  next_choice_ = rows_there >= most_ ? n + steps_between_choices : n + 1;
  if (most < 1 || !(contraction < 0.5)) return;
  double change[most_order + 1] = {};
  for (std::size_t s = 0; s < equations_.sources().size(); ++s) {
    const SourceRow& source = equations_.sources()[s];
    if (!source.reads_unknown) continue;
    Pack worst[most_order + 1];
    std::fill_n(worst, most_order + 1, Pack(0.0));
    // Bricks fill every second pack.
    const int own = source.stride == 2 ? static_cast<int>((n + source.newest - 1) & 1) : 0;
    for (int pack = own; pack < layout_.packs(); pack += source.stride) {
      Pack difference[most_order + 1];
      for (int j = 0; j <= most; ++j)
        difference[j] = Pack::load(table[source.ring.row(1 + j * source.stride)] + layout_.at(pack));
      for (int p = 1; p <= most; ++p) {
        for (int j = 0; j <= most - p; ++j) difference[j] -= difference[j + 1];
        worst[p] = largest_magnitude(worst[p], difference[0]);
      }
    }
    // A prediction goes astray twice as fast as it did where the field gets steeper.
    for (int p = 1; p <= most; ++p) change[p] += 2 * gains[s] * max_or_nan(worst[p]);
  }
  double cheapest = std::numeric_limits<double>::infinity();
  for (int p = 1; p <= most; ++p) {
    if (p < std::min(lowest_order, most) && !(change[p] <= left_in_unit_time * time_step * allowed)) continue;
    int iterations = 1;
    for (double left = change[p]; iterations < 9 && !(left <= allowed); left *= contraction) ++iterations;
    const double cost = p + rows_per_iteration * iterations;
    if (cost < cheapest) cheapest = cost, order_ = p;
  }
}

}  // namespace delf

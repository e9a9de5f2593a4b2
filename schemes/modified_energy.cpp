// SPDX-License-Identifier: MIT
#include "schemes/modified_energy.hpp"

#include <algorithm>

#include "jets/simd/pack.hpp"
#include "jets/simd/scratch_rows.hpp"
#include "lattice/index.hpp"

namespace delf {
namespace {

constexpr int widest = 8;

/// c_m = (−1)^{m+1} (w!)²/(m (w − m)! (w + m)!): Σ c_m (y_m − y_−m) is the slope at 0, of order 2w.
std::vector<double> slope_weights(int w) {
  std::vector<double> weights;
  double ratio = 1;  // (w!)²/((w − m)! (w + m)!)
  for (int m = 1; m <= w; ++m) {
    ratio *= static_cast<double>(w - m + 1) / (w + m);
    weights.push_back((m % 2 ? 1 : -1) * ratio / m);
  }
  return weights;
}
/// The value at 0 from those at ±1, ±3, …, of order 2w, by Lagrange's polynomial.
std::vector<double> middle_weights(int w) {
  std::vector<double> weights;
  for (int m = 1; m <= w; ++m) {
    double product = 0.5;
    const double own = 2 * m - 1;
    for (int n = 1; n <= w; ++n) {
      const double other = 2 * n - 1;
      if (n != m) product *= other * other / (other * other - own * own);
    }
    weights.push_back(product);
  }
  return weights;
}

}  // namespace

ModifiedEnergy::ModifiedEnergy(ModifiedLagrangian modified, const StencilTable& table, int fields, double time_step,
                               const Lattice& lattice, double gain)
    : fields_(fields),
      sites_(lattice.sites()),
      time_step_(time_step),
      space_step_(lattice.space() == Space::point ? 1 : lattice.space_step()),
      gain_(gain),
      has_kinds_(table.pattern.placement == Placement::brick_wall),
      slope_(slope_weights(std::clamp((sites_ - 1) / 2, 0, widest))),
      between_(middle_weights(std::clamp(sites_ / 4, 0, widest))) {
  const ModifiedLagrangian::OfRows rows = modified.of_rows(time_step, space_step_);
  inputs_ = rows.inputs;
  for (const auto& input : inputs_) derivatives_ = std::max(derivatives_, input.in_x);
  tape_ = expressions::Tape(rows.graph, {rows.energy, rows.momentum}, static_cast<int>(inputs_.size()) + 2);
  // The Lagrangian is about the middle of the stencil, where a density of x was expanded: any site, for the sum over all.
  for (int i = 0; i < sites_; ++i) places_.push_back(i * space_step_);
}

void ModifiedEnergy::differentiate(const std::vector<double>& row, double gain, std::vector<double>& out) const {
  const int n = sites_;
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int m = 1; m <= static_cast<int>(slope_.size()); ++m) {
      const int right = i + m, left = i - m;
      const double above = row[at(right % n)] + (right >= n ? gain : 0);
      const double below = row[at((left + n) % n)] - (left < 0 ? gain : 0);
      sum += slope_[at(m - 1)] * (above - below);
    }
    out[at(i)] = sum / space_step_;
  }
}

/// Half of each value, and half of what its neighbours of the other kind have there.
void ModifiedEnergy::take_mean_of_kinds(std::vector<double>& row, double gain) const {
  const int n = sites_;
  const std::vector<double> y = row;
  for (int i = 0; i < n; ++i) {
    double sum = 0;
    for (int m = 1; m <= static_cast<int>(between_.size()); ++m) {
      const int right = i + 2 * m - 1, left = i - 2 * m + 1;
      sum += between_[at(m - 1)] *
             (y[at(right % n)] + (right >= n ? gain : 0) + y[at((left + n) % n)] - (left < 0 ? gain : 0));
    }
    row[at(i)] = 0.5 * (y[at(i)] + sum);
  }
}

ModifiedEnergy::Sums ModifiedEnergy::of(std::span<const double> earlier, std::span<const double> later,
                                        double t) const {
  const int n = sites_;
  // [field][in_t][in_x]
  std::vector<std::vector<double>> jets(at(fields_ * 2 * (derivatives_ + 1)), std::vector<double>(at(n)));
  const auto jet = [&](int field, int in_t, int in_x) -> std::vector<double>& {
    return jets[at((field * 2 + in_t) * (derivatives_ + 1) + in_x)];
  };
  for (int a = 0; a < fields_; ++a)
    for (const int in_t : {0, 1}) {
      std::vector<double>& row = jet(a, in_t, 0);
      for (int i = 0; i < n; ++i) {
        const double before = earlier[at(i * fields_ + a)], after = later[at(i * fields_ + a)];
        row[at(i)] = in_t ? (after - before) / time_step_ : 0.5 * (before + after);
      }
      const double gain = in_t ? 0 : gain_;
      if (has_kinds_) take_mean_of_kinds(row, gain);
      for (int in_x = 1; in_x <= derivatives_; ++in_x)
        differentiate(jet(a, in_t, in_x - 1), in_x == 1 ? gain : 0, jet(a, in_t, in_x));
    }
  const int count = (n + lanes - 1) / lanes * lanes, m = static_cast<int>(inputs_.size());
  ScratchRows in(m + 1, count), out(2, count);
  for (int i = 0; i < count; ++i) {
    const int site = std::min(i, n - 1);
    for (int v = 0; v < m; ++v)
      in[v][i] = jet(inputs_[at(v)].field, inputs_[at(v)].in_t, inputs_[at(v)].in_x)[at(site)];
    in[m][i] = places_[at(site)];
  }
  tape_.run(count, in.data(), t + 0.5 * time_step_, out.data());
  Sums sums{0, 0};
  for (int i = 0; i < n; ++i) sums.energy += out[0][i], sums.momentum += out[1][i];
  return {space_step_ * sums.energy, space_step_ * sums.momentum};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/composition_stepper.hpp"
#include "schemes/stepping/pair_strips.hpp"

// The force gradient of a CompositionStepper.

namespace delf {

/// Nothing for a family that is not the square of the first one's force at the sites of row 0.
std::optional<CompositionStepper::ForceGradient> CompositionStepper::read_gradient(const StencilFamily& of,
                                                                                   const StencilFamily& given,
                                                                                   double k) {
  const DensityOnTable *jets = given.made_of(), *first = of.made_of();
  const ForceSquared* density = jets ? jets->density->squared_force() : nullptr;
  if (!density || jets->table.points.size() != 1) return std::nullopt;
  if (!first || first->density.get() != &density->of()) return std::nullopt;
  const auto& vertices = given.pattern().vertices;
  const TablePoint& point = jets->table.points[0];
  ForceGradient gradient{density, {}, {}, point.weight * jets->table.measure};
  for (const TablePoint::Entry& e : point[JetSlot::phi_xx]) {
    const Site v = vertices[e.vertex];
    if (v.time != 0 || v.node != 0) return std::nullopt;
    if (v.space <= 0) continue;  // differences alone, the same on both sides
    gradient.weights.resize(std::max(gradient.weights.size(), delf::at(v.space)), 0.0);
    gradient.weights[v.space - 1] += e.weight / (k * k);
  }
  gradient.sums = gradient.weights;
  for (std::size_t j = gradient.sums.size(); j-- > 1;) gradient.sums[j - 1] += gradient.sums[j];
  return gradient;
}

/// u += (hk/K) (∂ℓ̃/∂φ + Σ_m w_m (G(i + m) − 2G(i) + G(i − m))) of the squared force ℓ̃, G = ∂ℓ̃/∂φ_xx.
void CompositionStepper::add_gradient(std::int64_t n, const SubStep& step, const double* from,
                                      const double* differences, double* velocity) const {
  constexpr int strip = 32;
  const ScratchRows second(d_, strip * lanes);
  const int Q = static_cast<int>(gradient_.weights.size());
  for (int first = 0; first < layout_.packs(); first += strip) {
    const int packs = std::min(strip, layout_.packs() - first);
    const std::ptrdiff_t begin = layout_.at(first);
    for (int a = 0; a < d_; ++a) {
      const auto row = static_cast<std::ptrdiff_t>(a) * static_cast<std::ptrdiff_t>(size_) + begin;
      now_[a] = from + row;
      for (int part = 0; part < 3; ++part) out_[part * d_ + a] = squares_.row(part) + row;
      with_reach(Q, [&]<int R>(std::integral_constant<int, R>) {
        sum_pairs<R>(packs, gradient_.sums.data(), differences + row, second[a]);
      });
    }
    gradient_.density->gradient_at_rest(
        {packs * lanes, now_.data(), static_cast<double>(n) * system_.time_step() + step.time,
         positions_.rows() ? positions_.row(0) + begin : nullptr},
        second.data(), out_.data());
  }
  const double kick = step.gradient * gradient_.kick;
  for (int a = 0; a < d_; ++a) {
    const auto row = static_cast<std::ptrdiff_t>(a) * static_cast<std::ptrdiff_t>(size_);
    double* const G = squares_.row(1) + row;
    for (const Held& held : held_) G[held.slot] = 0;  // a sum of images, with the opposite sign
    layout_.fill_halo(G);
    for (const Image& image : values_beyond_) G[image.to] = image.sign * G[image.from];
    const std::ptrdiff_t at = row + layout_.at(0);
    with_reach(Q, [&]<int R>(std::integral_constant<int, R>) {
      add_squares<R>(layout_.packs(), kick, gradient_.weights.data(), squares_.row(0) + at, squares_.row(1) + at,
                     velocity + at);
    });
  }
}

}  // namespace delf

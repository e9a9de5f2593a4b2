// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/argument_rows.hpp"

#include <algorithm>
#include <cmath>

#include "schemes/families/argument_loop.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

std::optional<Mixture> Mixture::of(const LatticeSystem& system) {
  if (system.lattice().sites() < RowLook::most_parts * lanes) return {};  // a stencil is no longer than an arc
  if (system.components() != 1 || system.families().size() != 1 || !system.lattice().is_circle()) return {};
  const RowKernel* const kernel = system.families()[0]->row_kernel();
  if (!kernel || !kernel->evaluates_arguments()) return {};
  if (kernel->arguments().size() != 1) return of_pair(*kernel);
  Mixture mixture;
  double known[RowLook::most_parts] = {};
  for (const Argument::Part& part : kernel->arguments()[0].parts) {
    const int row = part.vertex.time - kernel->outputs_read_until(), p = part.vertex.space;
    if (row < -1 || p < 0 || p >= RowLook::most_parts) return {};
    (row == 0 ? mixture.weights : known)[p] += part.weight;
    if (row == 0) mixture.parts = std::max(mixture.parts, p + 1);
  }
  mixture.is_known_alike = std::ranges::equal(known, mixture.weights);
  if (mixture.is_known_alike) {
    mixture.known_weight = 1;
    return mixture;
  }
  if (std::ranges::count(known, 0) < RowLook::most_parts - 1) return {};
  mixture.known_site = static_cast<int>(std::ranges::find_if(known, [](double w) { return w != 0; }) - known);
  if (mixture.known_site == RowLook::most_parts) mixture.known_site = 0;  // nothing is known
  mixture.known_weight = known[mixture.known_site];
  return mixture;
}

/// Of the values in the latest row and in one of the two before it, in this order.
std::optional<Mixture> Mixture::of_pair(const RowKernel& kernel) {
  Mixture mixture;
  mixture.parts = 1, mixture.weights[0] = 1, mixture.known_weight = 1;
  mixture.known_row = kernel.outputs_read_until() - kernel.arguments()[1].parts[0].vertex.time;
  return mixture;
}

ArgumentRows::ArgumentRows(const RowLayout& layout, const Mixture& mixture, int most_order)
    : layout_(&layout),
      mixture_(mixture),
      // One more than is read, to see what the highest order would have missed.
      ring_(layout, most_order + 2),
      slots_(most_order + 2),
      most_order_(most_order) {
  row_.layout = &layout, row_.known_weight = mixture.known_weight;
  for (int twice = 0; twice < 2; ++twice)
    for (int slot = ring_.rows() - 1; slot >= 0; --slot) all_.push_back(ring_.row(slot));
  for (int order = 0; order <= most_order; ++order) growth_.push_back(std::exp2(order + 1) - 1);
  begin(0);
}

void ArgumentRows::put_extrapolated(int past_rows) {
  delf::put_extrapolated(*layout_, row_.past, past_rows, row_.unknown);
}

void put_extrapolated(const RowLayout& layout, const double* const* past, int past_rows, double* to) {
  with_past_rows<ArgumentRows::highest_order + 1>(past_rows, [&]<int rows>() {
    const PastRows<rows> read(past);
    if constexpr (rows > 0)
      for (int v = 0; v < layout.packs(); ++v) extrapolated(read, layout.at(v)).store(to + layout.at(v));
  });
}

double ArgumentRows::find(const double* y, const PackRange& packs) {
  Pack change(0.0);
  double* const u = row_.unknown;
  for (int v = packs.first; v < packs.last; ++v) {
    Pack sum(0.0);
    for (int p = 0; p < mixture_.parts; ++p) sum += mixture_.weights[p] * Pack::load(y + layout_->at(v + p));
    change = max_or_nan(abs(sum - Pack::load(u + layout_->at(v))), change);
    sum.store(u + layout_->at(v));
  }
  return max_or_nan(change);
}

}  // namespace delf

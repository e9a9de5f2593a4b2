// SPDX-License-Identifier: MIT
#include "schemes/argument_rows.hpp"

#include <algorithm>

#include "schemes/extrapolation.hpp"
#include "schemes/lattice_system.hpp"

namespace delf {

std::optional<Mixture> Mixture::of(const LatticeSystem& system) {
  if (system.lattice().sites() < RowLook::most_parts * lanes) return {};  // a stencil is no longer than an arc
  if (system.components() != 1 || system.families().size() != 1 || !system.lattice().is_circle()) return {};
  const RowKernel* const kernel = system.families()[0]->row_kernel();
  if (!kernel || !kernel->evaluates_arguments() || kernel->arguments().size() != 1) return {};
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

ArgumentRows::ArgumentRows(const RowLayout& layout, const Mixture& mixture, int most_order)
    : layout_(&layout),
      mixture_(mixture),
      // One more than is read, to see what the highest order would have missed.
      ring_(layout, most_order + 2),
      slots_(most_order + 2) {
  for (int order = 0; order <= most_order; ++order) {
    std::vector<double> of_rows;
    for (int j = 1; j <= order + 1; ++j) of_rows.push_back(extrapolation_weight(order + 1, j));
    coefficients_.push_back(std::move(of_rows));
  }
}

ArgumentRow ArgumentRows::argument(const double* y) {
  return {.layout = layout_,
          .unknown = row(0),
          .known = mixture_.is_known_alike ? row(1) : y + static_cast<std::ptrdiff_t>(mixture_.known_site) * lanes,
          .known_weight = mixture_.known_weight,
          .positions = nullptr,
          .t = 0,
          .time_step = 0,
          .space_step = 0};
}

void ArgumentRows::extrapolate(int order, ArgumentRow& row) const {
  const int highest = static_cast<int>(std::min<std::int64_t>(n_, static_cast<std::int64_t>(coefficients_.size()) - 1));
  order = std::clamp(order, 1, highest);
  row.past_rows = order + 1;
  row.coefficients = coefficients_[static_cast<std::size_t>(order)].data();
  row.ring = ring_.row(0), row.stride = ring_.stride(), row.slots = ring_.rows(), row.slot = slots_(0);
}

Pack ArgumentRows::find(const double* y, const PackRange& packs) {
  Pack change(0.0);
  double* const u = row(0);
  for (int v = packs.first; v < packs.last; ++v) {
    Pack sum(0.0);
    for (int p = 0; p < mixture_.parts; ++p) sum += mixture_.weights[p] * Pack::load(y + layout_->at(v + p));
    change = max_or_nan(abs(sum - Pack::load(u + layout_->at(v))), change);
    sum.store(u + layout_->at(v));
  }
  return change;
}

}  // namespace delf

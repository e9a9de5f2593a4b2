// SPDX-License-Identifier: MIT
#include "schemes/system/end_work.hpp"

#include <algorithm>

#include "lattice/index.hpp"

namespace delf {

DrivenEnds driven_ends(const LatticeSystem& system) {
  DrivenEnds ends;
  for (const auto& family : system.families())
    if (const DrivenEnd* const end = family->driven_end())
      ends.emplace_back(end->is_left() ? 0 : system.lattice().sites() - 1, end);
  return ends;
}

void set_driven_ends(const LatticeSystem& system, const DrivenEnds& ends, std::int64_t row, std::span<double> y) {
  const RowTimes& times = *system.times();
  for (const auto& [column, end] : ends)
    for (int c = 0; c < system.components(); ++c) {
      const Component& component = system.component(c);
      if (component.role != Role::multiplier && system.is_held(column, c))
        y[at(column * system.components() + c)] =
            end->value(component.field, times.time(row) + component.at.time * times.step(row));
    }
}

bool has_flux(const LatticeSystem& system) {
  return std::ranges::any_of(system.families(), [](const auto& family) { return family->is_flux(); });
}

EndWork::EndWork(const LatticeSystem& system, std::vector<EndFlux> fluxes)
    : system_(system), fluxes_(std::move(fluxes)) {
  Assembly::Parts parts{.equations = {}, .past = system.height(), .future = system.height()};
  for (const auto& [column, end] : driven_ends(system))
    for (int c = 0; c < system.components(); ++c)
      if (system.component(c).role != Role::multiplier && system.is_held(column, c))
        parts.equations.push_back({{0, column}, c});
  if (!parts.equations.empty()) walls_ = std::make_unique<const Assembly>(system, std::move(parts));
}

void EndWork::add(const Window& rows) {
  const std::int64_t newest = rows.last_row(), row = newest - 1;
  const RowTimes& times = *system_.times();
  const auto moved = [&](int column, int component) {
    return 0.5 * (rows(newest, column, component) - rows(row - 1, column, component));
  };
  if (walls_) {
    std::vector<double> E;
    walls_->residual(SectionRing(rows, row - system_.height(), row + system_.height()), row, E);
    for (int n = 0; n < walls_->size(); ++n) {
      const auto& [site, c] = walls_->equation(n);
      sum_ -= E[at(n)] / times.step(row) * moved(site.space, c);
    }
  }
  for (const EndFlux& end : fluxes_)
    for (std::size_t a = 0; a < end.flux.size(); ++a)
      sum_ += end.flux[a](times.time(row)) * moved(end.column, system_.field_component(static_cast<int>(a)));
}

}  // namespace delf

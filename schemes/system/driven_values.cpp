// SPDX-License-Identifier: MIT
#include "schemes/system/driven_values.hpp"

#include <algorithm>

#include "lattice/index.hpp"
#include "schemes/system/end_work.hpp"

namespace delf {

DrivenValues::DrivenValues(const LatticeSystem& system) : system_(system) {
  for (const auto& [column, driven] : driven_ends(system))
    for (int c = 0; c < system.components(); ++c)
      if (const Component& component = system.component(c); is_given(system, column, c, *driven))
        values_.push_back({column * system.components() + c, component.role == Role::field,
                           [end = driven, field = component.field, part = component.at.time](double t, double h) {
                             return end->value(field, t, h, part);
                           }});
  for (const auto& [point, given] : driven_points(system))
    for (int c = 0; c < system.components(); ++c)
      if (const Component& component = system.component(c); component.role != Role::multiplier)
        values_.push_back({point * system.components() + c, component.role == Role::field,
                           [of = given.get(), field = component.field, part = component.at.time](double t, double h) {
                             return of->value(field, t + part * h);
                           }});
}

void DrivenValues::put_into(std::int64_t row, std::span<double> y) const {
  const RowTimes& times = *system_.times();
  for (const Value& value : values_) y[at(value.place)] = value.at(times.time(row), times.step(row));
}

std::vector<int> DrivenValues::places_of_fields() const {
  std::vector<int> places;
  for (const Value& value : values_)
    if (value.is_field) places.push_back(value.place);
  return places;
}

std::span<const MeshSpace::AtPoint> driven_points(const LatticeSystem& system) {
  const auto& mesh = system.lattice().mesh();
  return mesh ? std::span(mesh->driven) : std::span<const MeshSpace::AtPoint>();
}

bool has_flux(const LatticeSystem& system) {
  const auto& mesh = system.lattice().mesh();
  return (mesh && !mesh->fluxes.empty()) ||
         std::ranges::any_of(system.families(), [](const auto& family) { return family->is_flux(); });
}

}  // namespace delf

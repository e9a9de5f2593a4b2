// SPDX-License-Identifier: MIT
#include "schemes/system/driven_points.hpp"

#include "lattice/index.hpp"

namespace delf {

std::span<const MeshSpace::AtPoint> driven_points(const LatticeSystem& system) {
  const auto& mesh = system.lattice().mesh();
  return mesh ? std::span(mesh->driven) : std::span<const MeshSpace::AtPoint>();
}

std::vector<int> places_of_driven_points(const LatticeSystem& system) {
  std::vector<int> places;
  for (const auto& [point, given] : driven_points(system))
    for (int c = 0; c < system.components(); ++c)
      if (system.component(c).role == Role::field) places.push_back(point * system.components() + c);
  return places;
}

bool has_flux_of_mesh(const LatticeSystem& system) {
  const auto& mesh = system.lattice().mesh();
  return mesh && !mesh->fluxes.empty();
}

void set_driven_points(const LatticeSystem& system, std::int64_t row, std::span<double> y) {
  const RowTimes& times = *system.times();
  for (const auto& [point, given] : driven_points(system))
    for (int c = 0; c < system.components(); ++c)
      if (const Component& component = system.component(c); component.role != Role::multiplier)
        y[at(point * system.components() + c)] =
            given->value(component.field, times.time(row) + component.at.time * times.step(row));
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/system/mesh_energy.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <utility>

#include "jets/tables/cell_points.hpp"
#include "jets/tables/space_table.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/stress_energy.hpp"

namespace delf {

MeshEnergy::MeshEnergy(std::shared_ptr<const BatchDensity> density, const MeshSpace& space)
    : density_(std::move(density)),
      masses_(lumped_masses(space.mesh)),
      cells_(mesh_families(point_space(), density_, space)) {  // a table of one row, without φ_t
  cells_.erase(cells_.begin());                                // the sites
}

double MeshEnergy::of_cells(std::span<const double> values, double t) const {
  const auto d = static_cast<std::size_t>(density_->components());
  double sum = 0;
  std::vector<double> y;
  for (const auto& family : cells_)
    for (int s = 0; s < family->listed()->size(); ++s) {
      y.clear();
      for (int i = 0; i < family->size(); ++i)
        y.push_back(values[static_cast<std::size_t>(family->column(s, i)) * d + static_cast<std::size_t>(i) % d]);
      sum += family->lagrangian({1, 1, t, 0, s}, y).value();
    }
  return sum;
}

double MeshEnergy::operator()(std::span<const double> values, std::span<const double> rates, double t) const {
  const auto d = static_cast<std::size_t>(density_->components());
  double sum = 0;
  std::vector<double> jet(static_cast<std::size_t>(density_->variables()), 0.0);
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    std::ranges::copy(values.subspan(i * d, d), jet.begin());
    std::ranges::copy(rates.subspan(i * d, d), jet.begin() + static_cast<std::ptrdiff_t>(d));
    sum += masses_[i] * stress_energy(*density_, jet.data(), t, 0).energy;
  }
  // ℓ(0, 0, 0) is in the gradients too, where it is no energy.
  return sum - of_cells(values, t) + of_cells(std::vector<double>(values.size(), 0.0), t);
}

std::vector<double> MeshEnergy::rates(std::span<const double> values, std::span<const double> momenta,
                                      double t) const {
  const std::size_t d = momenta.size() / masses_.size();
  std::vector<double> p(momenta.begin(), momenta.end());
  for (std::size_t n = 0; n < p.size(); ++n) p[n] /= masses_[n / d];
  const auto found = velocity_of(*density_, values, p, t);
  return found ? *found : std::vector(p.size(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace delf

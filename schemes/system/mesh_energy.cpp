// SPDX-License-Identifier: MIT
#include "schemes/system/mesh_energy.hpp"

#include <limits>
#include <utility>

#include "jets/tables/cell_points.hpp"
#include "jets/tables/space_table.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/system/legendre.hpp"

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
  for (std::size_t i = 0; i < masses_.size(); ++i)
    sum += masses_[i] * energy_of(*density_, values.subspan(i * d, d), rates.subspan(i * d, d), t);
  // ℓ(0, 0, 0) is in the gradients too, where it is no energy.
  return sum - of_cells(values, t) + of_cells(std::vector<double>(values.size(), 0.0), t);
}

std::vector<double> MeshEnergy::rates(std::span<const double> values, std::span<const double> momenta,
                                      double t) const {
  const auto d = static_cast<std::size_t>(density_->components());
  std::vector<double> rates, p(d);
  for (std::size_t i = 0; i < masses_.size(); ++i) {
    for (std::size_t a = 0; a < d; ++a) p[a] = momenta[i * d + a] / masses_[i];
    const auto found = velocity_of(*density_, values.subspan(i * d, d), p, t);
    for (std::size_t a = 0; a < d; ++a)
      rates.push_back(found ? (*found)[a] : std::numeric_limits<double>::quiet_NaN());
  }
  return rates;
}

}  // namespace delf

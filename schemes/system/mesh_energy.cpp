// SPDX-License-Identifier: MIT
#include "schemes/system/mesh_energy.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <numeric>
#include <utility>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/cell_points.hpp"
#include "jets/tables/space_table.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/listed_strips.hpp"
#include "schemes/system/stress_energy.hpp"

namespace delf {

MeshEnergy::MeshEnergy(std::shared_ptr<const BatchDensity> density, const MeshSpace& space)
    : density_(std::move(density)),
      masses_(lumped_masses(space.mesh)),
      cells_(mesh_families(point_space(), density_, {space.mesh, space.fixed})) {  // a table of one row, without φ_t
  cells_.erase(cells_.begin());                                                    // the sites
  for (const Mesh::Point& p : space.mesh.points) places_.push_back(p[0]);
}

double MeshEnergy::of_cells(std::span<const double> values, double t) const {
  const ScratchRows L(1, 64);
  double sum = 0;
  for (const auto& family : cells_)
    each_listed_strip(*family, values, density_->components(), t, [&](const StencilBatch& cells, int count) {
      family->lagrangian(cells, L[0]);
      sum += std::accumulate(L[0], L[0] + count, 0.0);
    });
  return sum;
}

double MeshEnergy::operator()(std::span<const double> values, std::span<const double> rates, double t) const {
  const int d = density_->components(), sites = static_cast<int>(masses_.size());
  constexpr int most = 64;  // sites at once
  const ScratchRows jet(density_->variables(), most), slope(density_->variables(), most), l(1, most), x(1, most);
  for (int v = 0; v < density_->variables(); ++v) std::fill_n(jet[v], most, 0.0);
  double sum = 0;
  for (int first = 0; first < sites; first += most) {
    const int own = std::min(most, sites - first), count = (own + lanes - 1) / lanes * lanes;
    for (int s = 0; s < count; ++s) {
      const int i = first + std::min(s, own - 1);  // the last one fills whole packs
      x[0][s] = places_[i];
      for (int a = 0; a < d; ++a) {
        jet[a][s] = values[i * d + a];
        jet[d + a][s] = rates[i * d + a];
      }
    }
    density_->gradient({count, jet.data(), t, x[0]}, slope.data(), l[0]);
    for (int s = 0; s < own; ++s) {
      double energy = -l[0][s];
      for (int a = 0; a < d; ++a) energy += jet[d + a][s] * slope[d + a][s];
      sum += masses_[first + s] * energy;
    }
  }
  // ℓ(0, 0, 0) is in the gradients too, where it is no energy.
  return sum - of_cells(values, t) + of_cells(std::vector<double>(values.size(), 0.0), t);
}

double MeshEnergy::between(std::span<const double> before, std::span<const double> y, double h, double t) const {
  std::vector<double> rates(y.size());
  for (std::size_t n = 0; n < y.size(); ++n) rates[n] = (y[n] - before[n]) / h;
  return 0.5 * ((*this)(before, rates, t - h) + (*this)(y, rates, t));
}

std::vector<double> MeshEnergy::rates(std::span<const double> values, std::span<const double> momenta, double t) const {
  const std::size_t d = momenta.size() / masses_.size();
  std::vector<double> p(momenta.begin(), momenta.end());
  for (std::size_t n = 0; n < p.size(); ++n) p[n] /= masses_[n / d];
  const auto found = velocity_of(*density_, values, p, t);
  return found ? *found : std::vector(p.size(), std::numeric_limits<double>::quiet_NaN());
}

}  // namespace delf

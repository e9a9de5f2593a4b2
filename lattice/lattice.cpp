// SPDX-License-Identifier: MIT
#include "lattice/lattice.hpp"

#include <cmath>
#include <string>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/space/mesh_space.hpp"

namespace delf {

Lattice::Lattice(Space space, int sites, double length, Wall left, Wall right)
    : space_(space), sites_(sites), length_(length), left_(left), right_(right) {
  if (sites < (space == Space::point || space == Space::mesh ? 1 : 2))
    throw BadInput("lattice.sites", "lattice.sites = " + std::to_string(sites) +
                                        ": a lattice needs at least 2 sites; raise lattice.sites");
  if (!(length > 0) || !std::isfinite(length))
    throw BadInput("lattice.length", "lattice.length must be a positive, finite number");
}

Lattice Lattice::circle(int sites, double length) {
  return {Space::circle, sites, length, Wall::natural, Wall::natural};
}

Lattice Lattice::point() { return {Space::point, 1, 1, Wall::natural, Wall::natural}; }

Lattice Lattice::interval(int sites, double length, Wall left, Wall right) {
  return {Space::interval, sites, length, left, right};
}

Lattice Lattice::on(std::shared_ptr<const MeshSpace> mesh) {
  const auto sites = static_cast<int>(mesh->mesh.points.size());
  Lattice lattice{Space::mesh, sites, static_cast<double>(sites), Wall::natural, Wall::natural};
  lattice.mesh_ = std::move(mesh);
  return lattice;
}

double Lattice::mesh_position(int i) const noexcept { return mesh_->mesh.points[i][0]; }
bool Lattice::is_fixed_on_mesh(int i) const noexcept { return mesh_->fixed[i] != 0; }

}  // namespace delf

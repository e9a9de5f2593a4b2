// SPDX-License-Identifier: MIT
#pragma once
#include <memory>


namespace delf {

struct MeshSpace;

enum class Space { circle, interval, point, mesh };

/// The condition at a wall of an interval: `fixed` keeps the initial value (no equation there, V = 0); `clamped` keeps
/// φ_x too, by the action's terms at the wall, which is for densities of second order; `natural` varies the value, so that
/// the equation is what the stencils inside the lattice and the action's terms at the wall give.
enum class Wall { fixed, clamped, natural };

/// A regular lattice: ℤ in time, and in space N sites on a circle (x_i = iL/N), on an interval that holds both walls
/// (x_i = iL/(N−1)), one point, for mechanics, or the points of a mesh. Time is ℤ: row 0 is data, not a wall.
class Lattice {
 public:
  /// Throws BadInput (keys lattice.sites, lattice.length) unless sites ≥ 2 and length is positive and finite.
  static Lattice circle(int sites, double length);
  static Lattice interval(int sites, double length, Wall left = Wall::fixed, Wall right = Wall::fixed);

  /// One site, x = 0, L = k = 1: it has no stencils with neighbouring sites in space.
  static Lattice point();
  /// The points of a mesh, whose stencils are listed (ListedStencils): L = N, k = 1, and x_i the first coordinate.
  static Lattice on(std::shared_ptr<const MeshSpace>);
  /// A copy of the lattice with site 0 at x₀, for the positions of nodes inside the cells.
  Lattice shifted(double x_0) const {
    Lattice other = *this;
    other.origin_ = x_0;
    return other;
  }

  Space space() const noexcept { return space_; }
  bool is_circle() const noexcept { return space_ == Space::circle; }
  int sites() const noexcept { return sites_; }
  double length() const noexcept { return length_; }
  Wall left() const noexcept { return left_; }
  Wall right() const noexcept { return right_; }
  /// k
  double space_step() const noexcept { return length_ / cells(); }
  /// x_i; exact at the walls.
  double position(int i) const noexcept { return mesh_ ? mesh_position(i) : origin_ + i * length_ / cells(); }
  /// Cells between neighbouring sites: N on a circle, N − 1 on an interval.
  int cells() const noexcept { return space_ == Space::interval ? sites_ - 1 : sites_; }
  /// The site i of the circle that an index outside 0 … N−1 stands for.
  int wrapped(int i) const noexcept { return ((i % sites_) + sites_) % sites_; }
  /// On an interval the index itself, which may be beyond a wall.
  int home(int i) const noexcept { return is_circle() ? wrapped(i) : i; }
  /// A site that a wall keeps at its value: it has no equation.
  bool is_fixed(int i) const noexcept {
    if (mesh_) return is_fixed_on_mesh(i);
    return !is_circle() && (i < sites_kept_by(left_) || i >= sites_ - sites_kept_by(right_));
  }
  /// Null unless the space is a mesh.
  const std::shared_ptr<const MeshSpace>& mesh() const noexcept { return mesh_; }

 private:
  Lattice(Space, int sites, double length, Wall, Wall);
  double mesh_position(int i) const noexcept;
  bool is_fixed_on_mesh(int i) const noexcept;
  static int sites_kept_by(Wall wall) noexcept { return wall == Wall::natural ? 0 : 1; }
  Space space_;
  int sites_;
  double length_, origin_ = 0;
  Wall left_, right_;
  std::shared_ptr<const MeshSpace> mesh_ = nullptr;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "lattice/space/mesh_space.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The values of a system that are given for all times: at driven ends of an interval, and at driven points of a mesh. They are
/// listed once, so that steps look at no family for them.
class DrivenValues {
 public:
  /// The system outlives it.
  explicit DrivenValues(const LatticeSystem&);
  /// Puts them into a row, y[i·C + c], a node inside the step at its own time.
  void put_into(std::int64_t row, std::span<double> y) const;
  /// The places of the fields among them, i·C + c.
  std::vector<int> places_of_fields() const;

 private:
  struct Value {
    int place;
    bool is_field;
    std::function<double(double t, double h)> at;  ///< of the row at t, whose step is h
  };
  const LatticeSystem& system_;
  std::vector<Value> values_;
};

/// The points of a mesh whose values follow data; none on lattices.
std::span<const MeshSpace::AtPoint> driven_points(const LatticeSystem&);
/// Something flows in at a natural wall, or at the boundary of a mesh.
bool has_flux(const LatticeSystem&);

}  // namespace delf

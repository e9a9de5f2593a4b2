// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "schemes/complex/complex_system.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/verify/region_system.hpp"
#include "tools/complex/complex_scene.hpp"

namespace delf {

/// Rows of a system that are checked: all of them as a region, with its data.
struct CheckedRows {
  std::shared_ptr<const RegionSystem> everywhere;
  Window rows;
  std::function<std::string(Site)> name;  ///< "site 17 at (t, x, y, z) = (0.5, 1, 0, 0)"
};

/// A complex, which is one row; y[site·d + a].
CheckedRows checked(const ComplexSystem&, std::vector<double> y);

/// Windows of consecutive rows on a mesh, whose fixed points are data. The lists of a window serve all that have as many rows.
class WindowsOnMesh {
 public:
  explicit WindowsOnMesh(const LatticeSystem& system) : system_(system) {}
  const LatticeSystem& system() const { return system_; }
  CheckedRows operator()(Window);

 private:
  const LatticeSystem& system_;
  std::size_t rows_ = 0;
  std::shared_ptr<RegionSystem> everywhere_;
};

/// The system of the usual method's rows on the scene's mesh, and that of one row without time.
LatticeSystem system_of_rows(const ComplexScene&);
LatticeSystem system_of_field(const ComplexScene&);
/// A row of these: the fields [i·d + a], and of a constraint the multipliers [i], 0 where none are given.
std::vector<double> row_of(const LatticeSystem&, std::span<const double> fields,
                           std::span<const double> multipliers = {});
/// The fields of a row, [i·d + a].
std::vector<double> fields_of(const LatticeSystem&, std::span<const double> row);

}  // namespace delf

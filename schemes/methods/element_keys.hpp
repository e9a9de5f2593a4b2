// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/stencil_table.hpp"
#include "schemes/parameter.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The keys that elements in time share: S functions of a basis, and a quadrature rule of R points.
struct ElementKeys {
  /// R is S if scheme.points is not given. Throws BadInput for a basis that has not so few functions.
  explicit ElementKeys(const ParameterValues&);
  /// Throws BadInput for a rule that has not so few points.
  LineRule rule() const;

  std::string basis_name = "lagrange-lobatto", quadrature = "gauss";
  int functions = 3, points = 2;
  LineBasis basis;

 protected:
  ElementKeys() = default;
  /// Reads the keys that are given, but for the points.
  void read(const ParameterValues&);
  /// Throws that BadInput.
  const NamedLineBasis& named_basis() const;
};

Parameter basis_parameter(const std::string& fallback);
Parameter functions_parameter(int fallback, int fewest);
Parameter quadrature_parameter();
Parameter points_parameter(const std::string& otherwise, int fallback);

/// Multipliers that are momenta of the d fields.
std::vector<Component> momentum_components(const char* name, int d);

}  // namespace delf

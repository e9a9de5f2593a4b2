// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/time_element.hpp"
#include "schemes/parameter.hpp"

namespace delf {

/// The keys that say what an element of time is: scheme.basis, functions, degree, quadrature, points, continuity; or
/// scheme.tableau, which stands for all but the last. Throws BadInput for what they cannot mean.
struct TimeElementKeys {
  explicit TimeElementKeys(const ParameterValues&);

  static std::vector<Parameter> parameters();
  LineRule rule() const;  ///< on each span of the basis
  StencilTable element() const { return time_element(basis, rule(), continuity); }
  /// "gauss2", or "lagrange-lobatto 3 functions, gauss 2 points"; then what joins the steps.
  std::string in_words() const;

  std::string tableau;  ///< empty: none
  std::string basis_name = "lagrange-lobatto", quadrature = "gauss";
  int functions = 3, degree, points;
  LineBasis basis;
  Continuity continuity;
};

}  // namespace delf

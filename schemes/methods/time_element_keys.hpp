// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/time_element.hpp"
#include "schemes/methods/element_keys.hpp"
#include "schemes/parameter.hpp"

namespace delf {

/// The keys that say what an element of time is: scheme.basis, functions, degree, quadrature, points, continuity; or
/// scheme.tableau, which stands for all but the last. Throws BadInput for what they cannot mean.
struct TimeElementKeys : ElementKeys {
  explicit TimeElementKeys(const ParameterValues&);

  static std::vector<Parameter> parameters();
  StencilTable element() const { return time_element(basis, rule(), continuity); }
  /// "gauss2", or "lagrange-lobatto 3 functions, gauss 2 points"; then what joins the steps.
  std::string in_words() const;

  std::string tableau;  ///< empty: none
  int degree;
  Continuity continuity;
};

}  // namespace delf

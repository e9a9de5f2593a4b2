// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// The largest difference of the coefficients of two discrete equations, and where it is.
struct EquationDifference {
  double largest;
  std::string where;  ///< "phi(j+1,i): 0.25 here, 0.5 printed"
};

/// Compares the equation that `delf plan` printed with one in its notation, in values phi(j+1,i-1) and h, k, m, at random
/// ones of all of these: coefficient by coefficient, ∂/∂phi(j+a,i+b) of one with that of the other, after the printed one
/// is multiplied by the number that makes both as alike as may be (paper and program differ in sign and scale). Where the
/// plan has a table of coefficients and no equation, as for a residual that is given directly, it is that table.
/// Throws BadInput where it has neither. A table is of numbers: h and k stand above it, and m is `mass`.
EquationDifference equation_difference(const std::string& plan, const std::string& printed, double mass = 1);

}  // namespace delf

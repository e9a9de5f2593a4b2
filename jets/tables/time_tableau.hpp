// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf {

/// A variational Runge–Kutta method by its usual name: the basis of a time element with so many functions, and its rule
/// with so many points (jets/tables/line_basis.hpp, line_rule.hpp).
struct TimeTableau {
  std::string name;
  std::string basis;
  int functions;
  std::string quadrature;
  int points;
  std::string words = {};                 ///< in a paper: "the midpoint rule"
  std::vector<std::string> sources = {};  ///< keys of tools/cite/references.bib
};

/// midpoint, stormer-verlet; gauss1 … gauss6; lobatto2 … lobatto6.
///
///     Gauss of s stages                s + 1 functions and Gauss's rule of s points: order 2s
///     Lobatto IIIA–IIIB of s stages    s + 1 functions and Lobatto's rule of s points: order 2s − 2. Beside the Lagrange
///                                      functions of the s points there is the bubble Π(τ − c_i), which is at none of them
///     Störmer–Verlet                   2 functions and the trapezoidal rule; lobatto2 where the mass is constant
const std::vector<TimeTableau>& time_tableaux();

}  // namespace delf

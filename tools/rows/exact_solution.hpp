// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "jets/expressions/field_equation.hpp"
#include "schemes/state.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The field equations at a point of a solution, and what rounding of its derivatives may make of them.
struct TriedPoint {
  std::string place;  ///< "t = 1, x = 2"
  std::vector<FieldEquations::Value> values;
  std::function<std::vector<double>(double rounding)> floor;
};
/// Throws BadInput for exact.FIELD if a field equation is not solved at one of the points.
void require_solved(const std::vector<TriedPoint>&, const std::vector<std::string>& fields);

/// Tries the formulas exact.FIELD at random points of the lattice and of the time of the run. Throws BadInput, with the point,
/// if they do not solve the field equations of the theory there. Walls and seams are not checked: a kink of the line is
/// a solution between walls that are far away.
void require_solution(const Scene&, const State& exact);

/// Returns "phi has no value at t = 1, x = 2" for one of those points; empty if it has a value at all of them.
std::string without_value(const Scene&, const State& exact);

}  // namespace delf

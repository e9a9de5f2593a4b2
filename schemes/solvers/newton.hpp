// SPDX-License-Identifier: MIT
#pragma once
#include <concepts>

#include "schemes/solvers/stopping.hpp"

namespace delf {

/// Equations E(y) = 0 as Newton's method takes them, with the y that they stand at.
template <class T>
concept NewtonEquations = requires(T equations, NewtonProgress& at) {
  { equations.linearise(at) } -> std::same_as<bool>;  // a matrix that stands for J = ∂E/∂y; false: it is singular
  equations.apply(equations.solve(equations.residual()), at);
};

/// Newton's method, from where the equations stand until a criterion ends it. The matrix need not be new for every correction;
/// a damped method takes a part of δ in apply().
template <NewtonEquations Equations, class... Criteria>
Stop newton(Equations& equations, NewtonProgress& at, const Criteria&... criteria) {
  for (;;) {
    ++at.iteration;
    if (!equations.linearise(at)) return Stop::singular;
    // J δ = E(y),   y ← y − δ
    equations.apply(equations.solve(equations.residual()), at);
    if (const Stop stop = first_of(at, criteria...); stop != Stop::no) return stop;
  }
}

}  // namespace delf

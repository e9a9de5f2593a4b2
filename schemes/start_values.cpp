// SPDX-License-Identifier: MIT
#include "schemes/start_values.hpp"

#include <algorithm>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/momenta.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

bool is_of_first_order_in_time(const BatchDensity& density) {
  const int d = density.components();
  bool moves = false;
  for (int a = d; a < 2 * d; ++a) {
    moves = moves || density.depends_on(a);
    for (int b = d; b < 2 * d; ++b)
      if (!density.is_zero(a, b)) return false;
  }
  for (int a = 3 * d; a < 5 * d && a < density.variables(); ++a)  // φ_tt, φ_tx
    if (density.depends_on(a)) return false;
  return moves;
}

bool has_field_of_first_order(const BatchDensity& density) {
  const int d = density.components();
  for (int a = d; a < 2 * d; ++a) {
    bool inert = false;
    for (int b = d; b < 2 * d; ++b) inert = inert || !density.is_zero(a, b);
    if (!inert && density.depends_on(a)) return true;
  }
  return false;
}

bool is_of_first_order_in_time(const Problem& problem) {
  return is_of_first_order_in_time(make_theory(find_theory(problem.theory), problem.parameters)->density());
}

bool may_start_from_values(const Problem& problem) {
  const MethodEntry& method = find_method(problem.method);
  return method.start == StartRule::values ||
         (std::ranges::count(method.starts, StartRule::values) > 0 && is_of_first_order_in_time(problem));
}

void start_from_values(Simulation& simulation, std::span<const double> row0, double monodromy) {
  const LatticeSystem& system = simulation.evolution().system();
  const bool of_fields =
      std::ranges::all_of(system.all_components(), [](const Component& c) { return c.role == Role::field; });
  if (system.height() != 1)
    throw BadInput("initial.start",
                   "initial.start = values: this stencil reaches over three rows, and starts from two; use "
                   "lattice.stencil = six-tuple, or give a solution as exact.FIELD");
  if (!is_of_first_order_in_time(simulation.theory().density()) || !of_fields)
    throw BadInput("initial.start", "initial.start = values: is for densities that are linear in phi_t; use centred");
  // ½(D₂ − D₁) L(y₀, y₀), in which the terms without φ_t cancel
  start_from_rates(simulation, row0, std::vector<double>(row0.size(), 0.0), monodromy);
}

void start_from_rates(Simulation& simulation, std::span<const double> row0, std::span<const double> v,
                      double monodromy) {
  const LatticeSystem& system = simulation.evolution().system();
  const std::vector<double> row(row0.begin(), row0.end());
  std::vector<double> before = row, after = row;
  for (std::size_t n = 0; n < row.size(); ++n)
    before[n] -= system.time_step() * v[n], after[n] += system.time_step() * v[n];
  std::vector<double> p = half_equations(system, system.window(-1, {before, row}, monodromy), 0, Side::below);
  const std::vector<double> above = half_equations(system, system.window(0, {row, after}, monodromy), 0, Side::above);
  for (std::size_t n = 0; n < p.size(); ++n) p[n] = 0.5 * (p[n] + above[n]);
  simulation.start_momenta(row, p);
}

}  // namespace delf

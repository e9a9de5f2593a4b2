// SPDX-License-Identifier: MIT
#include "jets/tables/named_tables.hpp"
#include "schemes/complex/complex_solver.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/complex/complex_forms.hpp"
#include "tests/schemes/complex/lattice_complex.hpp"
#include "tests/schemes/complex/lattice_values.hpp"
#include "tests/schemes/support.hpp"

namespace {

using namespace delf;
using namespace delf::testing;

TEST_CASE("a regular lattice given as a complex has the same plan, rows and forms") {
  Problem problem;
  problem.theory = "sine-gordon";
  const auto theory = theory_named(problem);
  for (const NamedTable& named : named_tables()) {
    if (named.is_for_point()) continue;
    for (const bool circle : {true, false}) {
      if (!circle && (named.name == "hexagon" || named.name == "six-tuple" || named.name == "nine-tuple")) continue;
      CAPTURE(named.name, circle);
      // (−1)ⁱ on an even circle is a null mode of the nine-tuple; a brick wall needs an even one
      const int N = named.name == "hexagon" ? 14 : 15, steps = 5;
      const Lattice lattice =
          circle ? Lattice::circle(N, 0.5 * N) : Lattice::interval(N, 0.5 * (N - 1), Wall::fixed, Wall::fixed);
      const double h = 0.4 * lattice.space_step();
      Evolution evolution(lattice, {theory->variational(named.name)}, h);
      const SolvePlan& plan = evolution.plan();
      Random random(3);
      std::vector<Row> rows = random_rows(random, evolution.stepper().starting_rows(), N, 1.0);
      if (!circle)
        for (Row& row : rows) row.front() = rows[0].front(), row.back() = rows[0].back();
      evolution.stepper().start(rows);

      const int count = plan.history + steps;
      const LatticeComplex whole(lattice, plan, named.table, theory->shared_density(), h, count);
      const ComplexSystem& system = whole.system;
      const ComplexSolver solver(system);
      CHECK(solver.plan().blocks() == steps * plan.blocks);
      CHECK(static_cast<long long>(solver.plan().unknowns.size()) == steps * plan.unknowns);
      CHECK((solver.plan().largest == 1) == (plan.blocks == plan.unknowns));
      if (plan.kind == SolveKind::explicit_) CHECK(solver.plan().levels == steps);

      std::vector<double> y = first_values(whole, rows, count);
      solver.solve(y);
      for (int j = plan.history; j < count; ++j) {
        evolution.stepper().step();
        const Row row = evolution.stepper().row(0);
        for (std::size_t i = 0; i < row.size(); ++i)
          CHECK(std::abs(y[whole.site(j, static_cast<int>(i))] - row[i]) < 1e-13);
      }

      std::mt19937_64 seed(1);
      const ComplexForms form(system, drawn_region(system, 9, seed), y);
      const auto V = form.first_variations(2, seed);
      CHECK(form.form_formula(V[0], V[1]).relative() < 1e-13);
    }
  }
}

}  // namespace

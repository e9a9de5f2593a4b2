// SPDX-License-Identifier: MIT
#include "schemes/families/r_adaptive.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "lattice/index.hpp"
#include "lattice/lattice.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/r_adaptive.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/verify/region_system.hpp"
#include "tests/catch.hpp"
#include "tests/verification/r_adaptive_rows.hpp"

using namespace delf;

namespace {

namespace reference = r_adaptive_rows;

std::vector<double> row(const auto& phi, const auto& mesh) {
  std::vector<double> values;
  for (std::size_t i = 0; i < std::size(phi); ++i) values.insert(values.end(), {phi[i], mesh[i], 0.0});
  return values;
}

/// One soliton, N = 15 nodes between the walls.
Evolution soliton(double alpha, double tolerance = StepOptions{}.tolerance) {
  return {Lattice::interval(17, 25),
          {std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
           std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{alpha})},
          reference::time_step,
          {.tolerance = tolerance},
          {{"phi"}, {"X"}, {"lambda", Role::multiplier, {}}}};
}

/// Stepped to row 10: the largest differences in φ and X.
std::pair<double, double> distance_to_row_10(double alpha) {
  Evolution evolution = soliton(alpha);
  Stepper& stepper = evolution.stepper();
  stepper.start({row(reference::y0, reference::X0), row(reference::y1, reference::X1)});
  while (stepper.newest() < 10) {
    stepper.step();
    CHECK(stepper.residual() < 1e-12);
  }
  const auto newest = stepper.row(0);
  std::pair<double, double> worst{0, 0};
  for (std::size_t i = 0; i < std::size(reference::y10); ++i) {
    worst.first = std::max(worst.first, std::abs(newest[3 * i] - reference::y10[i]));
    worst.second = std::max(worst.second, std::abs(newest[3 * i + 1] - reference::X10[i]));
  }
  return worst;
}

}  // namespace

TEST_CASE("the trapezoidal r-adaptive scheme gives row 10 of an independent program to 1e-11") {
  const auto [phi, mesh] = distance_to_row_10(reference::alpha);
  CAPTURE(phi, mesh);
  CHECK(phi < 1e-11);
  CHECK(mesh < 1e-11);
}

TEST_CASE("the comparison can fail: another alpha moves the mesh elsewhere") {
  CHECK(distance_to_row_10(1.01 * reference::alpha).second > 1e-4);
}

// The equations are a block of 45, whose Jacobian is kept from step to step. Every step is solved once more from the same
// two rows, as far as rounding allows.
TEST_CASE("a kept Jacobian leaves less than the tolerance in every step, for 400 steps") {
  const double tolerance = GENERATE(1e-6, 1e-9, 1e-12);
  Evolution kept = soliton(reference::alpha, tolerance), converged = soliton(reference::alpha, 0);
  std::vector<std::vector<double>> rows{row(reference::y0, reference::X0), row(reference::y1, reference::X1)};
  kept.stepper().start(rows);
  double worst = 0;
  int iterations = 0;
  for (int n = 0; n < 400; ++n) {
    kept.stepper().step(), iterations += kept.stepper().iterations();
    converged.stepper().start(rows), converged.stepper().step();
    const auto found = kept.stepper().row(0), root = converged.stepper().row(0);
    for (std::size_t i = 0; i < found.size(); ++i)
      if (i % 3 != 2) worst = std::max(worst, std::abs(found[i] - root[i]));
    rows = {rows[1], found};
  }
  CAPTURE(tolerance, worst, iterations);
  CHECK(worst <= tolerance * 25);  // of the largest value, a position
  // The comparison sees what is left: where the tolerance is looser, more than the tightest would allow.
  if (tolerance > 1e-12) CHECK(worst > 1e-12 * 25);
  CHECK(iterations < 4 * 400);
}

namespace {

/// Half of the rectangle at the left wall once more: what (152) as printed has, where the weight is 1 and not ½ as it is for
/// every other rectangle of a six-tuple.
class PrintedWall final : public StencilFamily {
 public:
  PrintedWall()
      : StencilFamily({MovingRectangle{}.pattern().vertices, Placement::left_mirror}, MovingRectangle{}.values(),
                      true) {}
  using StencilFamily::jacobian;
  using StencilFamily::residual;
  void residual(const StencilBatch& batch, std::span<const int> equations, double* r) const override {
    of_.residual(batch, equations, r);
    for (std::size_t n = 0; n < equations.size() * delf::at(batch.count); ++n) r[n] *= 0.5;
  }
  void jacobian(const StencilBatch& batch, std::span<const int> equations, std::span<const int> unknowns,
                double* J) const override {
    of_.jacobian(batch, equations, unknowns, J);
    for (std::size_t n = 0; n < equations.size() * unknowns.size() * delf::at(batch.count); ++n) J[n] *= 0.5;
  }

 private:
  LagrangianFamily<MovingRectangle> of_{{}};
};

}  // namespace

TEST_CASE("six-tuples at the walls have weight one half: with the printed 1 the form formula fails") {
  std::vector<std::shared_ptr<const StencilFamily>> families{
      std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
      std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{2.5})};
  const std::vector<Component> components{{"phi"}, {"X"}, {"lambda", Role::multiplier, {}}};
  const Lattice lattice = Lattice::interval(17, 25);
  const LatticeSystem right(lattice, families, 0.01, components);
  families.push_back(std::make_shared<PrintedWall>());
  const LatticeSystem printed(lattice, families, 0.01, components);

  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const auto& [first, least, most] : {std::tuple{0, 1e-4, 1.0}, {3, 0.0, 1e-13}}) {
    const RegionSystem here(right, Region::rectangle(lattice, patterns_of(right), {0, 4}, {first, first + 5}));
    const RegionSystem there(printed, Region::rectangle(lattice, patterns_of(printed), {0, 4}, {first, first + 5}));
    RegionSystem::Values y(here.nodes());
    for (std::size_t n = 0; n < y.size(); ++n) {
      const Node at = here.node(n);
      y[n] = (at.component == 1 ? at.site.space : 0) + 0.2 * uniform(random);
    }
    // first variations of the equations (151), in both sums
    auto V = here.first_variations(y, 2, random);
    const RegionSystem::Pair pair{V[0], V[1]};
    CAPTURE(first);
    CHECK(here.form_formula(y, {&pair, 1})[0].relative() < 1e-13);
    const double as_printed = there.form_formula(y, {&pair, 1})[0].relative();
    CHECK(as_printed >= least);
    CHECK(as_printed <= most);
  }
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/verify/form_check.hpp"
#include "tests/catch.hpp"
#include "tests/verification/time_elements.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using delf::testing::distance;

/// max |difference of (q, p)| of two schemes over the rows 1 … steps.
double distance(const std::string& theory, double h, const Elements& a, const Elements& b, int steps) {
  const Numbers q = theory == "pendulum" ? Numbers{1.5} : Numbers{0.25, 0.125},
                v = theory == "pendulum" ? Numbers{0.25} : Numbers{-0.1, 0.3};
  Body one(theory, h, a, q, v), other(theory, h, b, q, v);
  double most = 0;
  for (int n = 1; n <= steps; ++n) {
    one.to(n), other.to(n);
    most = std::max({most, distance(one.q(), other.q()), distance(one.p(), other.p())});
  }
  return most;
}

/// Gauss's collocation method of R stages for q″ = −sin q, its stages by iteration.
std::array<double, 2> gauss_step(int R, double h, std::array<double, 2> y) {
  const LineRule rule = gauss_rule(R), fine = gauss_rule(12);
  const LagrangeBasis psi(rule.points);
  const std::size_t n = R;
  std::vector<Numbers> a(n, Numbers(n, 0.0));  // a_ij = ∫₀^{c_i} ψ_j
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t k = 0; k < fine.points.size(); ++k) {
      const Numbers at = psi.values(rule.points[i] * fine.points[k]);
      for (std::size_t j = 0; j < n; ++j) a[i][j] += rule.points[i] * fine.weights[k] * at[j];
    }
  Numbers Q(n, y[0]), P(n, y[1]);
  for (int iteration = 0; iteration < 200; ++iteration)
    for (Numbers* stages : {&Q, &P}) {
      const Numbers before_Q = Q, before_P = P;
      for (std::size_t i = 0; i < n; ++i) {
        (*stages)[i] = stages == &Q ? y[0] : y[1];
        for (std::size_t j = 0; j < n; ++j)
          (*stages)[i] += h * a[i][j] * (stages == &Q ? before_P[j] : -std::sin(before_Q[j]));
      }
    }
  for (std::size_t i = 0; i < n; ++i)
    y = {y[0] + h * rule.weights[i] * P[i], y[1] - h * rule.weights[i] * std::sin(Q[i])};
  return y;
}

/// Whether an oscillator of ωh = z stays where it can be over 3000 steps.
bool stays(const Elements& e, double z) {
  try {
    Body body("harmonic-oscillator", z, e, {1}, {0.3});
    double most = 0;
    for (int n = 1; n <= 3000; ++n) {
      const double q = body.to(n).q()[0];
      if (!(std::abs(q) < 1e6)) return false;
      most = std::max(most, std::abs(q));
    }
    return most < 1e3;
  } catch (const NumericalFailure&) {
    return false;
  }
}

const Elements shared{3, "gauss", 2, "lagrange-lobatto", "shared"},
    broken{3, "gauss", 2, "lagrange-lobatto", "multipliers"};

}  // namespace

TEST_CASE("continuous Galerkin integrators make the states of an independent program in quadruple precision") {
  struct Reference {
    Elements elements;
    int row;
    double q, p;
  };
  // pendulum, q0 = 1.5, p0 = 0.25, h = 0.25
  const Reference references[] = {
      {{2, "gauss", 2, "lagrange-gauss"}, 1, 1.53130775997486070614, 0.0003901844559285963079},
      {{2, "gauss", 2, "lagrange-gauss"}, 20, -0.9661746538258794590, 1.0277462573463954685579},
      {{2, "lobatto", 2}, 1, 1.53132828166862329903, 0.0004104719486960544614},
      {{2, "lobatto", 2}, 20, -0.9554004402582227115, 1.0332022742281003124624},
      {{2, "gauss", 1}, 1, 1.53129750756434518440, 0.0003800605147614752261},
      {{2, "gauss", 1}, 20, -0.9715166382490977780, 1.0249473229891996283949},
      {{3, "gauss", 3, "lagrange-gauss"}, 1, 1.53129880362519853694, 0.0003226136159487447244},
      {{3, "gauss", 3, "lagrange-gauss"}, 20, -0.9631323036780431100, 1.0309848915825443694593},
      {{3, "lobatto", 3}, 1, 1.53129943688928138073, 0.0003236154211208244117},
      {{3, "lobatto", 3}, 20, -0.9631235007662725834, 1.0309861993748018888573},
      {{3, "gauss", 2}, 1, 1.53129838145290122531, 0.0003219456847271436212},
      {{3, "gauss", 2}, 20, -0.9631381501290700862, 1.0309840363835791926667}};
  for (const Reference& r : references) {
    CAPTURE(r.elements.functions, r.elements.quadrature, r.elements.points, r.elements.basis, r.row);
    Body body("pendulum", 0.25, r.elements, {1.5}, {0.25});
    body.to(r.row);
    CHECK(std::abs(body.q()[0] - r.q) < 1e-12);
    CHECK(std::abs(body.p()[0] - r.p) < 1e-12);
  }
}

TEST_CASE("the check can fail: another rule, or another number of functions, makes other states") {
  Body body("pendulum", 0.25, {3, "lobatto", 3}, {1.5}, {0.25});
  CHECK(std::abs(body.to(20).q()[0] + 0.9631381501290700862) > 1e-6);
}

TEST_CASE("steps that share their end nodes and steps joined by multipliers are one method") {
  for (const char* theory : {"pendulum", "henon-heiles", "double-pendulum"})
    for (const char* basis : {"lagrange-lobatto", "lagrange-chebyshev", "bernstein"})
      for (const int S : {2, 3, 4}) {
        CAPTURE(theory, basis, S);
        CHECK(distance(theory, 0.1, {S, "gauss", S - 1, basis, "shared"}, {S, "gauss", S - 1, basis, "multipliers"},
                       40) < 1e-13);
      }
  CHECK(distance("pendulum", 0.1, {3, "gauss", 2}, {3, "gauss", 3}, 40) > 1e-9);
}

TEST_CASE("what counts is the space of the functions and the rule, not the basis") {
  for (const NamedLineBasis& named : named_line_bases())
    for (const NamedLineRule& rule : named_line_rules()) {
      CAPTURE(named.name, rule.name);
      CHECK(distance("henon-heiles", 0.1, {4, rule.name, 4}, {4, rule.name, 4, named.name}, 20) < 1e-13);
    }
}

TEST_CASE("with S functions and a rule of order r the order is the smaller of 2S - 2 and r, from both sides") {
  struct Case {
    Elements elements;
    int order, steps;
  };
  for (const Case& c : {Case{{2, "gauss", 1}, 2, 40},          Case{{2, "gauss", 2}, 2, 40},
                        Case{{2, "lobatto", 2}, 2, 40},        Case{{2, "radau", 2}, 2, 40},
                        Case{{3, "gauss", 2}, 4, 16},          Case{{3, "gauss", 3}, 4, 16},
                        Case{{3, "lobatto", 3}, 4, 16},        Case{{3, "clenshaw-curtis", 3}, 4, 16},
                        Case{{3, "fejer", 3}, 4, 16},          Case{{3, "lobatto", 2}, 2, 40},
                        Case{{3, "radau", 2}, 3, 24},          Case{{4, "gauss", 3}, 6, 8},
                        Case{{4, "gauss", 4}, 6, 8},           Case{{4, "lobatto", 4}, 6, 8},
                        Case{{4, "radau", 4}, 6, 8},           Case{{4, "clenshaw-curtis", 4}, 4, 16},
                        Case{{4, "fejer", 5}, 6, 8},           Case{{4, "lobatto", 3}, 4, 16},
                        Case{{5, "gauss", 4}, 8, 5},           Case{{5, "gauss", 5}, 8, 5},
                        Case{{5, "lobatto", 5}, 8, 6},         Case{{5, "radau", 4}, 7, 6},
                        Case{{5, "clenshaw-curtis", 5}, 6, 8}, Case{{5, "lobatto", 4}, 6, 8}}) {
    const double slope = std::log2(swing_error(c.elements, c.steps) / swing_error(c.elements, 2 * c.steps));
    CAPTURE(c.elements.functions, c.elements.quadrature, c.elements.points, slope);
    CHECK(std::abs(slope - c.order) < (c.order == 8 ? 0.35 : 0.15));  // of order 8 rounding leaves coarse steps only
  }
}

TEST_CASE("with Gauss's rule of S - 1 points it is Gauss's collocation method, for two functions the midpoint rule") {
  for (const int S : {2, 3, 4}) {
    Body body("pendulum", 0.25, {S, "gauss", S - 1}, {1.5}, {0.25});
    std::array<double, 2> y{1.5, 0.25};
    double most = 0;
    for (int n = 1; n <= 20; ++n) {
      y = gauss_step(S - 1, 0.25, y);
      body.to(n);
      most = std::max({most, std::abs(body.q()[0] - y[0]), std::abs(body.p()[0] - y[1])});
    }
    CAPTURE(S, most);
    CHECK(most < 1e-13);
    CHECK(std::abs(gauss_step(S, 0.25, y)[0] - body.to(21).q()[0]) > 1e-10);
  }
}

TEST_CASE("an oscillator is stable up to the limits of its rule, and not beyond") {
  struct Limit {
    Elements elements;
    double z;
  };
  for (const Limit& l : {Limit{{2, "lobatto", 2}, 2}, Limit{{3, "lobatto", 3}, std::sqrt(8.0)},
                         Limit{{2, "gauss", 2}, std::sqrt(12.0)}, Limit{{3, "gauss", 3}, std::sqrt(10.0)}}) {
    CAPTURE(l.elements.functions, l.elements.quadrature, l.elements.points);
    CHECK(stays(l.elements, 0.999 * l.z));
    CHECK_FALSE(stays(l.elements, 1.001 * l.z));
  }
  CHECK(stays({3, "lobatto", 3}, 3.6));
  for (const int S : {2, 3, 4}) CHECK(stays({S, "gauss", S - 1}, 7.3));
}

TEST_CASE("a planet keeps its angular momentum, joined either way, and its energy is H of q and p") {
  StateRequest request;
  request.name = "kepler-orbit", request.theory = "kepler";
  const auto state = make_state(request, Lattice::point());
  Numbers q(2), v(2);
  state->values(0, Lattice::point(), q), state->velocities(0, Lattice::point(), v);
  for (const Elements& e : {shared, broken}) {
    CAPTURE(e.continuity);
    Body body("kepler", 0.05, e, q, v);
    REQUIRE(body.simulation().conserved_names() == std::vector<std::string>{"angular_momentum"});
    double drift = 0;
    for (int n = 1; n <= 1000; ++n) {
      body.to(n);
      if (n % 10 == 0) drift = std::max(drift, std::abs(body.simulation().monitors().conserved[0] - 0.8));
    }
    CHECK(drift < 1e-12);
    const Numbers at = body.q(), p = body.p();
    const auto monitors = body.simulation().monitors();
    CHECK(std::abs(at[0] * p[1] - at[1] * p[0] - 0.8) < 1e-12);
    CHECK(std::abs(monitors.energy - (0.5 * (p[0] * p[0] + p[1] * p[1]) - 1 / std::hypot(at[0], at[1]))) < 1e-14);
    CHECK(std::abs(monitors.energy + 0.5) < 1e-2);
  }
}

TEST_CASE("momenta of a row are the same from below and from above, and those of the multipliers") {
  Body body("double-pendulum", 0.1, broken, {0.5, -0.2}, {0.3, 0.1});
  body.to(3);
  const Numbers below = body.p();
  Numbers found(4);
  body.simulation().copy_row(0, found, Role::multiplier);
  for (std::size_t a = 0; a < 2; ++a) {
    CHECK(std::abs(found[a] - below[a]) < 1e-14);      // λ_3 = p_3
    CHECK(std::abs(found[2 + a] + below[a]) < 1e-14);  // μ_3 = −p_3
  }
  const Numbers above = body.to(4).simulation().momenta(1);
  for (std::size_t a = 0; a < 2; ++a) CHECK(std::abs(above[a] - below[a]) < 1e-14);
}

TEST_CASE("the constraint of a run is that of the rows where the plan has it") {
  Body body("henon-heiles", 0.1, broken, {0.25, 0.125}, {0, 0});
  CHECK(body.to(10).simulation().monitors().constraint < 1e-15);
}

TEST_CASE("the form formula holds for either continuity, and a residual of the first step is none") {
  std::vector<RegionRequest> regions;
  for (const RegionKind kind : region_kinds()) regions.push_back({to_string(kind), kind});
  for (const Elements& e :
       {shared, broken, Elements{4, "lobatto", 4, "bernstein"}, Elements{2, "gauss", 2, "lagrange-gauss"}})
    for (const char* theory : {"henon-heiles", "double-pendulum"}) {
      CAPTURE(theory, e.functions, e.continuity);
      const Simulation simulation(problem_of(theory, 0.1, e));
      const LatticeSystem& system = simulation.evolution().system();
      const int rows = FormCheck::rows_wanted(system, simulation.evolution().plan(), regions);
      std::mt19937_64 random(3);
      std::uniform_real_distribution<double> uniform(-1, 1);
      std::vector<Numbers> values(rows);
      for (Numbers& row : values)
        for (int c = 0; c < system.components(); ++c) row.push_back(uniform(random));
      for (const bool fault : {false, true}) {
        FormCheck check(system, simulation.evolution().plan(), rows,
                        {.regions = regions, .pairs = 1, .break_variation = fault});
        check.at(system.window(0, values, 0), random);
        double worst = 0;
        for (const Check& c : check.checks()) worst = std::max(worst, c.value);
        CHECK((worst > 1e-13) == fault);
      }
    }
}

TEST_CASE("a symmetry of the fields acts on the multipliers that are momenta by its transpose inverse") {
  const Simulation simulation(problem_of("kepler", 0.1, broken));
  const LatticeSystem& system = simulation.evolution().system();
  // of every stencil of the trace, whose Lagrangian is p·(x − q); shear is no rotation
  const LinearSymmetry shear{"shear", {0, 1, 0, 0}, {0, 0}};
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (std::size_t f = 1; f < system.families().size(); ++f) {
    const StencilFamily& family = *system.families()[f];
    Numbers y(delf::at(family.size())), r(y.size()), xi;
    for (double& value : y) value = uniform(random);
    family.residual({0.1, 1, 0, 0}, y, r);
    generator(system, family, shear, y, xi);
    double change = 0;
    for (std::size_t i = 0; i < y.size(); ++i) change += r[i] * xi[i];
    CHECK(std::abs(change) < 1e-15);
  }
}

TEST_CASE("what the method cannot be built for is refused with the key and a remedy") {
  const auto refusal = [](const Problem& p) -> std::string {
    try {
      Simulation simulation(p);
    } catch (const BadInput& bad) {
      return bad.key();
    }
    return "accepted";
  };
  Problem circle = problem_of("sine-gordon", 0.1, shared);
  circle.lattice = Lattice::circle(31, 20);
  CHECK(refusal(circle) == "accepted");
  circle.theory = "wave-map";
  CHECK(refusal(circle) == "scheme.method");
  CHECK(refusal(problem_of("pendulum", 0.1, {2, "lobatto", 1})) == "scheme.points");
  CHECK(refusal(problem_of("pendulum", 0.1, {3, "gauss", 2, "lagrange-gauss", "shared"})) == "scheme.continuity");
  CHECK(refusal(problem_of("pendulum", 0.1, {1, "gauss", 1})) == "scheme.functions");
  CHECK(refusal(problem_of("pendulum", 0.1, {3, "simpson", 2})) == "scheme.quadrature");
  CHECK(refusal(problem_of("pendulum", 0.1, {3, "gauss", 2, "lagrange-gauss"})) == "accepted");
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/pair_element.hpp"
#include "jets/tables/radau_element.hpp"
#include "jets/tables/space_table.hpp"
#include "jets/tables/table_product.hpp"
#include "jets/tables/time_element.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/verify/form_check.hpp"
#include "tests/catch.hpp"
#include "tests/verification/element_run.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A time element and a space, by their keys.
struct Scheme {
  int functions;
  std::string quadrature;
  int points;
  std::string space = "lumped";
  int of_space = 0;  ///< the order of pairs, or the degree of spectral elements
  std::string basis = "lagrange-lobatto";
  std::string continuity = "shared";
};

Problem problem_of(const Scheme& s, const Lattice& lattice, double h, const std::string& theory = "sine-gordon") {
  Problem p;
  p.theory = theory, p.method = "cgvi", p.lattice = lattice, p.time_step = h;
  p.parameters["scheme.functions"] = s.functions, p.parameters["scheme.quadrature"] = s.quadrature;
  p.parameters["scheme.points"] = s.points, p.parameters["scheme.space"] = s.space;
  p.parameters["scheme.basis"] = s.basis, p.parameters["scheme.continuity"] = s.continuity;
  if (s.space == "pairs") p.parameters["lattice.space_order"] = s.of_space;
  if (s.space == "spectral") p.parameters["scheme.degree_space"] = s.of_space;
  return p;
}
Problem radau(int stages, const Lattice& lattice, double h) {
  Problem p;
  p.method = "radau-iia", p.lattice = lattice, p.time_step = h, p.parameters["scheme.stages"] = stages;
  return p;
}

StateRequest breather(double position = 0, double speed = 0) {
  StateRequest request;
  request.name = "breather", request.values["initial.frequency"] = 0.6;
  request.values["initial.position"] = position, request.values["initial.speed"] = speed;
  return request;
}

/// A breather in the middle of a circle, or half a one at a natural wall; the other wall is fixed. Spectral elements are
/// on fewer cells, so that steps resolve their fastest modes.
const Lattice circle = Lattice::circle(24, 16), half = Lattice::interval(13, 8, Wall::natural, Wall::fixed),
              other_half = Lattice::interval(13, 8, Wall::fixed, Wall::natural), few = Lattice::circle(8, 16);
StateRequest breather_on(const Lattice& lattice) {
  return breather(lattice.is_circle() ? lattice.length() / 2 : lattice.right() == Wall::natural ? lattice.length() : 0);
}

constexpr double until = 1.6;

/// The fields at t = 1.6, n steps after the start.
Row at_end(const Problem& p, int n) { return ElementRun(p, breather_on(p.lattice)).to(n).fields(); }
/// The order in time: of the distance to small steps of a method of order eight over the same space.
double order_in_time(const std::function<Problem(double h)>& problem, Scheme fine, const Lattice& lattice, int n) {
  fine.functions = 5, fine.quadrature = "gauss", fine.points = 4;
  const Row exact = at_end(problem_of(fine, lattice, until / 24), 24);
  return order(distance(at_end(problem(until / n), n), exact), distance(at_end(problem(until / (2 * n)), 2 * n), exact),
               2);
}
double order_in_time(const Scheme& s, const Lattice& lattice, int n) {
  return order_in_time([&](double h) { return problem_of(s, lattice, h); }, s, lattice, n);
}

/// q_n+1 and the momenta there of Gauss's method with the stages R, for Σ k (½v_i² − ½((q_{i+1} − q_i)/k)² + cos q_i − 1)
/// on a circle, its stages by iteration.
void gauss_step(int R, double h, double k, Row& q, Row& v) {
  const LineRule rule = gauss_rule(R);
  const LagrangeBasis basis(rule.points);
  const std::size_t N = q.size(), n = at(R);
  const auto force = [&](const Row& y, std::size_t i) {
    return (y[(i + 1) % N] - 2 * y[i] + y[(i + N - 1) % N]) / (k * k) - std::sin(y[i]);
  };
  std::vector a(n, Row(n, 0.0));  // ∫₀^{c_i} ℓ_j
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t g = 0; g < n; ++g) {
      const Row values = basis.values(rule.points[i] * rule.points[g]);
      for (std::size_t j = 0; j < n; ++j) a[i][j] += rule.points[i] * rule.weights[g] * values[j];
    }
  std::vector Q(n, q), V(n, v);
  for (int iteration = 0; iteration < 200; ++iteration) {
    const auto Q_0 = Q, V_0 = V;
    for (std::size_t s = 0; s < n; ++s)
      for (std::size_t i = 0; i < N; ++i) {
        Q[s][i] = q[i], V[s][i] = v[i];
        for (std::size_t j = 0; j < n; ++j)
          Q[s][i] += h * a[s][j] * V_0[j][i], V[s][i] += h * a[s][j] * force(Q_0[j], i);
      }
  }
  for (std::size_t j = 0; j < n; ++j)
    for (std::size_t i = 0; i < N; ++i)
      q[i] += h * rule.weights[j] * V[j][i], v[i] += h * rule.weights[j] * force(Q[j], i);
}

}  // namespace

TEST_CASE("time elements on every space are of order 2S - 2 in time, from both sides, on a breather") {
  struct Case {
    Scheme scheme;
    int order, steps;
  };
  for (const Case& c : {Case{{2, "gauss", 1, "lumped"}, 2, 24}, Case{{2, "lobatto", 2, "linear"}, 2, 24},
                        Case{{3, "gauss", 2, "lumped"}, 4, 8}, Case{{3, "gauss", 2, "pairs", 6}, 4, 8},
                        Case{{3, "lobatto", 3, "spectral", 2}, 4, 8}, Case{{3, "lobatto", 3, "linear"}, 4, 8},
                        Case{{4, "gauss", 3, "linear"}, 6, 4}, Case{{4, "lobatto", 4, "pairs", 4}, 6, 4},
                        Case{{4, "gauss", 3, "spectral", 3}, 6, 4}, Case{{5, "gauss", 4, "lumped"}, 8, 2},
                        // the rule's own order, where it is less
                        Case{{3, "lobatto", 2, "lumped"}, 2, 24}, Case{{3, "radau", 2, "lumped"}, 3, 12},
                        // Lobatto IIIA–IIIB of three stages
                        Case{{4, "lobatto", 3, "lumped"}, 4, 8}}) {
    const double found = order_in_time(c.scheme, c.scheme.space == "spectral" ? few : circle, c.steps);
    CAPTURE(c.scheme.functions, c.scheme.quadrature, c.scheme.points, c.scheme.space, found);
    CHECK(std::abs(found - c.order) < 0.25);
  }
}

TEST_CASE("so they are near a natural wall and a fixed one") {
  for (const Lattice& lattice : {half, other_half})
    for (const Scheme& s :
         {Scheme{3, "gauss", 2, "lumped"}, Scheme{3, "lobatto", 3, "linear"}, Scheme{4, "gauss", 3, "spectral", 2}}) {
      const bool few_cells = s.space == "spectral";
      const Lattice walls = Lattice::interval(few_cells ? 5 : 13, 8, lattice.left(), lattice.right());
      const double found = order_in_time(s, walls, few_cells ? 4 : 16);
      CAPTURE(s.functions, s.space, lattice.left() == Wall::natural, found);
      CHECK(std::abs(found - (2 * s.functions - 2)) < 0.25);
    }
}

TEST_CASE("their space is of the order of its table, near walls too") {
  struct Case {
    std::string space;
    int of_space, order, cells;
    double tolerance;
  };
  const auto error = [](const Case& c, const Lattice& lattice) {
    // a kink is odd about its middle, but for 2π; a breather is even
    return ElementRun(problem_of({4, "gauss", 3, c.space, c.of_space}, lattice, 0.1), breather_on(lattice))
        .to(10)
        .error();
  };
  for (const Case& c : {Case{"lumped", 0, 2, 64, 0.1}, Case{"linear", 0, 2, 64, 0.1}, Case{"pairs", 4, 4, 64, 0.3},
                        Case{"pairs", 6, 6, 64, 0.6}, Case{"spectral", 1, 2, 64, 0.1}, Case{"spectral", 2, 4, 32, 0.3},
                        Case{"spectral", 3, 5, 32, 0.5}}) {
    const auto on_circle = [&](int cells) { return error(c, Lattice::circle(cells, 60)); };
    const double found = order(on_circle(2 * c.cells), on_circle(4 * c.cells), 2);
    CAPTURE(c.space, c.of_space, found);
    CHECK(std::abs(found - c.order) < c.tolerance);
    if (c.space == "pairs") continue;
    const auto on_interval = [&](int cells) {
      return error(c, Lattice::interval(cells + 1, 30, Wall::natural, Wall::fixed));
    };
    const double at_wall = order(on_interval(c.cells), on_interval(2 * c.cells), 2);
    CAPTURE(at_wall);
    CHECK(std::abs(at_wall - c.order) < c.tolerance);
  }
}

TEST_CASE("Gauss's rule of S - 1 points is Gauss's collocation method on the lumped lattice") {
  for (const int S : {2, 3, 4}) {
    const double h = 0.1, k = circle.space_step();
    ElementRun run(problem_of({S, "gauss", S - 1}, circle, h), breather_on(circle));
    Row q(24), v(24);
    run.state().values(0, circle, q), run.state().velocities(0, circle, v);
    double most = 0, other = 0;
    Row q_other = q, v_other = v;
    for (int n = 1; n <= 10; ++n) {
      gauss_step(S - 1, h, k, q, v), gauss_step(S, h, k, q_other, v_other);
      most = std::max(most, distance(run.to(n).fields(), q));
      other = std::max(other, distance(run.fields(), q_other));
      const std::vector<double> p = run.simulation().momenta();
      const std::size_t C = run.simulation().components().size();
      for (std::size_t i = 0; i < v.size(); ++i) most = std::max(most, std::abs(p[i * C] / k - v[i]));
    }
    CAPTURE(S, most, other);
    CHECK(most < 1e-12);
    CHECK(other > 1e-11);
  }
}

TEST_CASE("special cases are the schemes that they are: spacetime elements, leapfrog") {
  const auto fields = [](const Problem& p) { return ElementRun(p, breather_on(p.lattice)).to(12).fields(); };
  for (const Lattice& lattice : {circle, half}) {
    Problem spacetime = problem_of({3, "gauss", 2}, lattice, 0.1);
    spacetime.method = "spacetime", spacetime.parameters = {};
    spacetime.parameters["scheme.degree_time"] = 2, spacetime.parameters["scheme.degree_space"] = 2;
    CHECK(distance(fields(problem_of({3, "gauss", 2, "spectral", 2}, lattice, 0.1)), fields(spacetime)) < 1e-14);
    CHECK(distance(fields(problem_of({3, "gauss", 2, "spectral", 3}, lattice, 0.1)), fields(spacetime)) > 1e-6);
  }
  Problem leapfrog = problem_of({2, "lobatto", 2}, circle, 0.1);
  leapfrog.method = "composition", leapfrog.parameters = {};
  leapfrog.parameters["scheme.order"] = 2, leapfrog.parameters["lattice.space_order"] = 4;
  CHECK(distance(fields(problem_of({2, "lobatto", 2, "pairs", 4}, circle, 0.1)), fields(leapfrog)) < 1e-12);
  CHECK(distance(fields(problem_of({2, "lobatto", 2, "pairs", 2}, circle, 0.1)), fields(leapfrog)) > 1e-6);
}

TEST_CASE("elements joined by multipliers are those that share their ends, and their multipliers are momenta") {
  for (const Lattice& lattice : {circle, half, other_half})
    for (const Scheme& s :
         {Scheme{3, "gauss", 2, "lumped"}, Scheme{3, "lobatto", 3, "spectral", 2}, Scheme{2, "gauss", 2, "linear"}}) {
      Scheme broken = s;
      broken.continuity = "multipliers", broken.basis = "lagrange-gauss";
      ElementRun one(problem_of(s, lattice, 0.1), breather_on(lattice)),
          other(problem_of(broken, lattice, 0.1), breather_on(lattice));
      CAPTURE(s.functions, s.space, lattice.is_circle());
      CHECK(distance(one.to(12).fields(), other.to(12).fields()) < 1e-12);
      const std::vector<double> p = one.simulation().momenta(), q = other.simulation().momenta();
      const std::size_t C = one.simulation().components().size(), D = other.simulation().components().size();
      std::vector<double> multipliers(at(lattice.sites() * other.simulation().count(Role::multiplier)));
      other.simulation().copy_row(0, multipliers, Role::multiplier);
      const std::size_t M = multipliers.size() / at(lattice.sites());
      double most = 0, of_lambda = 0;
      for (std::size_t i = 0; i < at(lattice.sites()); ++i) {
        if (lattice.is_fixed(static_cast<int>(i))) continue;
        most = std::max(most, std::abs(p[i * C] - q[i * D]));
        of_lambda = std::max(of_lambda, std::abs(multipliers[i * M + M / 2] + p[i * C]));  // μ_n = −p_n
      }
      CHECK(most < 1e-12);
      CHECK(of_lambda < 1e-12);
    }
}

TEST_CASE(
    "the energy is H of the scheme's momenta and fields, and follows that of the solution to the scheme's order") {
  // at the start it is that of the fields alone, in time exact
  for (const Lattice& lattice : {circle, half})
    for (const Scheme& s :
         {Scheme{3, "gauss", 2, "lumped"}, Scheme{3, "gauss", 2, "linear"}, Scheme{3, "gauss", 2, "spectral", 2}}) {
      const auto drift = [&](double h) {
        ElementRun run(problem_of(s, lattice, h), breather_on(lattice));
        const int steps = static_cast<int>(std::lround(until / h));
        const double first = run.to(1).simulation().monitors().energy;
        return std::abs(run.to(steps).simulation().monitors().energy - first);
      };
      const double found = order(drift(0.2), drift(0.1), 2);
      CAPTURE(s.space, lattice.is_circle(), drift(0.1), found);
      CHECK(found > 3.5);
      CHECK(found < 5.5);
    }
  // k Σ (½v² + ½((q_{i+1} − q_i)/k)² + 1 − cos q)
  ElementRun run(problem_of({3, "gauss", 2}, circle, 0.1), breather_on(circle));
  const Row q = run.to(5).fields();
  const std::vector<double> p = run.simulation().momenta();
  const double k = circle.space_step();
  const std::size_t C = run.simulation().components().size();
  double energy = 0;
  for (std::size_t i = 0; i < q.size(); ++i)
    energy += k * (0.5 * std::pow(p[i * C] / k, 2) + 0.5 * std::pow((q[(i + 1) % q.size()] - q[i]) / k, 2) + 1 -
                   std::cos(q[i]));
  CHECK(std::abs(run.simulation().monitors().energy - energy) < 1e-12);
}

TEST_CASE("a charge of two fields is kept to round-off over time elements, and not by Radau's method") {
  StateRequest request;
  request.name = "charged-wave";
  const Lattice lattice = Lattice::circle(16, 10);
  for (const Scheme& s : {Scheme{3, "gauss", 2, "lumped"}, Scheme{3, "lobatto", 3, "spectral", 2},
                          Scheme{3, "gauss", 2, "linear", 0, "lagrange-gauss", "multipliers"}}) {
    ElementRun run(problem_of(s, lattice, 0.2, "complex-klein-gordon"), request);
    REQUIRE(run.simulation().conserved_names().size() == 1);
    const double first = run.to(2).simulation().monitors().conserved[0];
    REQUIRE(std::abs(first) > 0.1);
    CAPTURE(s.space, s.continuity);
    CHECK(std::abs(run.to(100).simulation().monitors().conserved[0] / first - 1) < 1e-12);
  }
}

TEST_CASE("every theory of fields without a constraint steps on every space, and solves its equations") {
  int tried = 0;
  for (const TheoryInfo& theory : theories())
    for (const Scheme& s :
         {Scheme{3, "gauss", 2, "linear"}, Scheme{3, "lobatto", 3, "pairs", 4}, Scheme{2, "gauss", 1, "spectral", 2}}) {
      const Lattice lattice = Lattice::circle(10, 8);
      CAPTURE(theory.name, s.space);
      try {
        Simulation simulation(problem_of(s, lattice, 0.1, theory.name));
        const int d = simulation.theory().components();
        if (simulation.theory().density().is_zero(2 * d, 2 * d)) continue;  // mechanics: neighbours are not coupled
        const std::size_t C = simulation.components().size();
        std::vector<double> row(10 * C), rate(10 * C, 0.0);
        for (std::size_t i = 0; i < 10; ++i)
          for (std::size_t c = 0; c < C; ++c) {
            const Component& component = simulation.components()[c];
            row[i * C + c] = 0.4 + 0.1 * component.field +
                             0.2 * std::sin(0.2 * std::numbers::pi * (static_cast<double>(i) + component.at.space));
          }
        simulation.start_legendre(row, rate);
        for (int n = 0; n < 4; ++n) simulation.step();
        CHECK(simulation.residual() < 1e-12);
        CHECK(std::isfinite(simulation.monitors().energy));
        ++tried;
      } catch (const BadInput& bad) {  // has a constraint, or is for mechanics
        CHECK((bad.key() == "scheme.method" || bad.key() == "theory.density"));
      }
    }
  CHECK(tried >= 3 * 8);
}

TEST_CASE("the form formula holds on patches and strips of every space, with the nodes inside, and finds a fault") {
  constexpr double k = 0.6, h = 0.3;
  std::mt19937_64 random(53);
  const LineBasis cubic = lagrange_basis(lobatto_rule(4).points), quadratic = lagrange_basis(lobatto_rule(3).points);
  for (const StencilTable& space : {spectral_space(1), linear_space(), pair_space(pair_weights(2)), spectral_space(3)})
    for (const StencilTable& time : {time_element(quadratic, gauss_rule(2), Continuity::shared),
                                     time_element(cubic, lobatto_rule(3), Continuity::shared)}) {
      const FamilyList families{jet_family(product(time, space), SineGordon{})};
      const int nodes = static_cast<int>(time.nodes.size() * space.nodes.size());
      const Lattice lattice = Lattice::circle(12, 12 * k);
      std::vector<Site> strip;  // two rows of elements meet there
      for (int i = 0; i < lattice.sites(); ++i) strip.push_back({1, i});
      for (const auto& centres : {strip, random_centres(random, 9, nodes), random_centres(random, 9, nodes)}) {
        Patch patch(lattice, families, h, centres);
        REQUIRE(patch.U().regular());
        patch.y = random_values(random, patch.on.nodes());
        const auto inner =
            std::ranges::count_if(patch.on.equations(), [&](std::size_t n) { return patch.on.node(n).component > 0; });
        CAPTURE(nodes, patch.on.equations().size(), inner);
        CHECK(inner >= nodes - 1);
        auto pair = patch.variations(random);
        CHECK(patch.form_formula(pair).relative() < 1e-13);
        const auto node = patch.on.coupling_node(patch.y);
        REQUIRE(node);
        pair.V[*node] += 0.01;
        CHECK(patch.form_formula(pair).relative() > 1e-7);
      }
    }
}

namespace {

/// The worst of the form formula's sums on all kinds of regions, at random rows; with a broken variation if asked.
double worst_form(const Problem& p, bool fault) {
  std::vector<RegionRequest> regions;
  for (const RegionKind kind : region_kinds()) regions.push_back({to_string(kind), kind});
  const Simulation simulation(p);
  const LatticeSystem& system = simulation.evolution().system();
  const int rows = FormCheck::rows_wanted(system, simulation.evolution().plan(), regions);
  std::mt19937_64 random(3);
  std::vector<std::vector<double>> values;
  for (int r = 0; r < rows; ++r) values.push_back(random_values(random, at(system.components() * p.lattice.sites())));
  FormCheck check(system, simulation.evolution().plan(), rows,
                  {.regions = regions, .pairs = 1, .break_variation = fault});
  check.at(system.window(0, values, 0), random);
  double worst = 0;
  for (const Check& c : check.checks()) worst = std::max(worst, c.value);
  return worst;
}

}  // namespace

TEST_CASE("so it does with multipliers, and between walls") {
  for (const Lattice& lattice : {Lattice::circle(9, 5), Lattice::interval(9, 5, Wall::natural, Wall::fixed)})
    for (const Scheme& s : {Scheme{3, "gauss", 2, "spectral", 2}, Scheme{2, "gauss", 1, "linear"},
                            Scheme{2, "gauss", 1, "spectral", 2, "lagrange-gauss", "multipliers"},
                            Scheme{3, "gauss", 2, "linear", 0, "lagrange-lobatto", "multipliers"}}) {
      CAPTURE(s.space, s.continuity, lattice.is_circle());
      CHECK(worst_form(problem_of(s, lattice, 0.3), false) < 1e-13);
      CHECK(worst_form(problem_of(s, lattice, 0.3), true) > 1e-9);
    }
}

TEST_CASE("Radau IIA of s stages is of order 2s - 1, loses energy, and has no form formula") {
  for (const auto& [stages, steps] : {std::pair{2, 16}, {3, 8}}) {
    const double found =
        order_in_time([&, s = stages](double h) { return radau(s, circle, h); }, {5, "gauss", 4}, circle, steps);
    CAPTURE(stages, found);
    CHECK(std::abs(found - (2 * stages - 1)) < 0.3);
  }
  ElementRun run(radau(3, circle, 0.4), breather_on(circle)),
      gauss(problem_of({3, "gauss", 2}, circle, 0.4), breather_on(circle));
  const double first = run.to(1).simulation().monitors().energy, of_gauss = gauss.to(1).simulation().monitors().energy;
  CHECK(run.to(500).simulation().monitors().energy < 0.999 * first);
  CHECK(std::abs(gauss.to(500).simulation().monitors().energy / of_gauss - 1) < 1e-3);
  CHECK_FALSE(is_variational(run.simulation().evolution().system()));
  CHECK(worst_form(radau(3, circle, 0.3), false) > 1e-6);
}

TEST_CASE("what does not go together is refused with its key") {
  const auto refusal = [](const Problem& p) -> std::string {
    try {
      Simulation simulation(p);
    } catch (const BadInput& bad) {
      return bad.key();
    }
    return "accepted";
  };
  CHECK(refusal(problem_of({3, "gauss", 2, "pairs", 4}, half, 0.1)) == "scheme.space");
  CHECK(refusal(problem_of({3, "gauss", 2, "pairs", 5}, circle, 0.1)) == "lattice.space_order");
  CHECK(refusal(problem_of({3, "gauss", 2, "pairs", 12}, Lattice::circle(12, 5), 0.1)) == "lattice.sites");
  CHECK(refusal(problem_of({3, "gauss", 2, "spectral", 13}, circle, 0.1)) == "scheme.degree_space");
  CHECK(refusal(problem_of({3, "gauss", 2, "cubic"}, circle, 0.1)) == "scheme.space");
  Problem of_another = problem_of({3, "gauss", 2, "linear"}, circle, 0.1);
  of_another.parameters["scheme.degree_space"] = 2;
  CHECK(refusal(of_another) == "scheme.degree_space");
  CHECK(refusal(problem_of({3, "gauss", 2, "linear"}, Lattice::point(), 0.1, "pendulum")) == "scheme.space");
  CHECK(refusal(problem_of({3, "gauss", 2}, circle, 0.1, "wave-map")) == "scheme.method");
  CHECK(refusal(problem_of({3, "gauss", 2}, circle, 0.1)) == "accepted");
}

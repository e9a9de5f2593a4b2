// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <boost/numeric/odeint/integrate/integrate_n_steps.hpp>
#include <boost/numeric/odeint/stepper/runge_kutta_fehlberg78.hpp>
#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/verify/flux_check.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/tangent.hpp"
#include "tests/catch.hpp"
#include "tests/row_distance.hpp"

using namespace delf;
using delf::testing::distance;

namespace {

using Numbers = std::vector<double>;

struct Elements {
  int functions;
  std::string flux;
  std::string gauge = "full";
  double nu = 0;
  std::string basis = "lagrange-gauss";
};

Problem problem_of(const std::string& theory, double h, const Elements& e) {
  Problem p;
  p.theory = theory, p.method = "dgvi", p.lattice = Lattice::point(), p.time_step = h;
  p.parameters["scheme.functions"] = e.functions, p.parameters["scheme.flux"] = e.flux;
  p.parameters["scheme.nu"] = e.nu, p.parameters["scheme.basis"] = e.basis;
  if (theory == "lotka-volterra") p.parameters["theory.gauge"] = e.gauge;
  return p;
}

Problem text_problem(const std::string& density, const std::string& fields, double h, const Elements& e) {
  Problem p = problem_of("text", h, e);
  p.parameters["theory.density"] = density, p.parameters["theory.fields"] = fields;
  return p;
}

/// A body whose traces are q − ½ jump and q + ½ jump at row 0.
class Body {
 public:
  Body(const Problem& p, const Numbers& q, const Numbers& jump = {}) : simulation_(p), d_(q.size()) {
    Numbers row;
    for (const Component& c : simulation_.components()) {
      const std::size_t a = c.field;
      const double off = c.role == Role::trace && !jump.empty() ? (c.name.ends_with('-') ? -0.5 : 0.5) * jump[a] : 0;
      row.push_back(c.role == Role::multiplier ? 0 : q[a] + off);
    }
    simulation_.start({row});
  }
  Body& to(int row) {
    while (simulation_.newest() < row) simulation_.step();
    return *this;
  }
  Numbers q() const { return newest(Role::field, d_); }
  /// q⁻, then q⁺
  Numbers traces() const { return newest(Role::trace, 2 * d_); }
  Simulation& simulation() { return simulation_; }

 private:
  Numbers newest(Role role, std::size_t size) const {
    Numbers row(size);
    simulation_.copy_row(0, row, role);
    return row;
  }
  Simulation simulation_;
  std::size_t d_;
};

/// The error at t = 1 of predators and prey that start at (1, 1), against Fehlberg's method of order 8.
double error(const Elements& e, int n) {
  static const Numbers exact = [] {
    namespace odeint = boost::numeric::odeint;
    Numbers q{1, 1};
    odeint::runge_kutta_fehlberg78<Numbers> stepper;
    const auto rate = [](const Numbers& at, Numbers& v, double) { v = {at[0] * (at[1] - 2), at[1] * (1 - at[0])}; };
    odeint::integrate_n_steps(stepper, rate, q, 0.0, 1.0 / 200, 200);
    return q;
  }();
  return distance(Body(problem_of("lotka-volterra", 1.0 / n, e), {1, 1}).to(n).q(), exact);
}

double order(const Elements& e, int n) { return std::log2(error(e, n) / error(e, 2 * n)); }

/// det(z − M) of the step of a linear scheme in (q⁻, q⁺), four numbers: coefficients of 1, z, z², z³, by Faddeev and LeVerrier.
std::array<double, 4> characteristic(const Problem& p) {
  constexpr std::size_t n = 4;
  using Matrix = std::array<std::array<double, n>, n>;
  Matrix M{};
  for (std::size_t k = 0; k < n; ++k) {
    Numbers unit(n, 0.0);
    unit[k] = 1;
    const Numbers q{0.5 * (unit[0] + unit[2]), 0.5 * (unit[1] + unit[3])}, jump{unit[2] - unit[0], unit[3] - unit[1]};
    const Numbers image = Body(p, q, jump).to(1).traces();
    for (std::size_t i = 0; i < n; ++i) M[i][k] = image[i];
  }
  std::array<double, 4> c{};
  Matrix A{};
  double last = 1;
  for (std::size_t k = 1; k <= n; ++k) {
    // A ← M A + c I, c ← −tr(M A)/k
    Matrix next{};
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) {
        for (std::size_t m = 0; m < n; ++m) next[i][j] += M[i][m] * A[m][j];
        if (i == j) next[i][j] += last;
      }
    A = next;
    double trace = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t m = 0; m < n; ++m) trace += M[i][m] * A[m][i];
    c[n - k] = last = -trace / static_cast<double>(k);
  }
  return c;
}

/// A start of predators and prey with random rows around 1, as many as a check of forms wants.
std::vector<Numbers> rows_around_one(const LatticeSystem& system, int rows, std::mt19937_64& random) {
  std::uniform_real_distribution<double> uniform(0.8, 1.2);
  std::vector<Numbers> values(rows);
  for (Numbers& row : values)
    for (int c = 0; c < system.components(); ++c) row.push_back(uniform(random));
  return values;
}

std::string refusal(const Problem& p) {
  try {
    Simulation simulation(p);
  } catch (const BadInput& bad) {
    return bad.key() + " | " + bad.what();
  }
  return "accepted";
}

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("discontinuous Galerkin integrators make the states of an independent program in quadruple precision") {
  struct Reference {
    Elements elements;
    int row;
    Numbers minus, plus, average;
  };
  // q0 = (1, 1), h = 0.125
  const Reference references[] = {{{2, "midpoint"},
                                   1,
                                   {0.880295306941841038, 1.005105273514816987},
                                   {0.885280379275761176, 1.009914046641980948},
                                   {0.882787843108801107, 1.007509660078398967}},
                                  {{2, "midpoint"},
                                   8,
                                   {0.409362768771800285, 1.403315069505969492},
                                   {0.440814189672472058, 1.437184153068088364},
                                   {0.425088479222136171, 1.420249611287028928}},
                                  {{2, "trapezoid"},
                                   1,
                                   {0.880295306941841038, 1.005105273514816987},
                                   {0.885254440899839317, 1.009946701777526303},
                                   {0.882774873920840178, 1.007525987646171645}},
                                  {{2, "trapezoid"},
                                   8,
                                   {0.412374822833591888, 1.401895297398698315},
                                   {0.436437434814791604, 1.437917405928838598},
                                   {0.424406128824191746, 1.419906351663768456}},
                                  {{2, "gauss2"},
                                   1,
                                   {0.880295306941841038, 1.005105273514816987},
                                   {0.885271704706475228, 1.009924904064222149},
                                   {0.882783505824158133, 1.007515088789519568}},
                                  {{2, "gauss2"},
                                   8,
                                   {0.410483895403543360, 1.403033347867799500},
                                   {0.439089294753131253, 1.436937707572935987},
                                   {0.424786595078337307, 1.419985527720367743}},
                                  {{3, "midpoint"},
                                   1,
                                   {0.882782429050579259, 1.007541929208325898},
                                   {0.882769346056394441, 1.007490097223548654},
                                   {0.882775887553486850, 1.007516013215937276}},
                                  {{3, "midpoint"},
                                   8,
                                   {0.424583415731008297, 1.419804222486903433},
                                   {0.424569714930355893, 1.419832260354240706},
                                   {0.424576565330682095, 1.419818241420572070}},
                                  {{3, "trapezoid"},
                                   1,
                                   {0.882782429050579259, 1.007541929208325898},
                                   {0.882769345622915649, 1.007490098655823700},
                                   {0.882775887336747454, 1.007516013932074799}},
                                  {{3, "trapezoid"},
                                   8,
                                   {0.424583414131537563, 1.419804227566845239},
                                   {0.424569716444274922, 1.419832253731138725},
                                   {0.424576565287906242, 1.419818240648991982}},
                                  {{3, "gauss2"},
                                   1,
                                   {0.882782429050579259, 1.007541929208325898},
                                   {0.882769345911903349, 1.007490097700980954},
                                   {0.882775887481241304, 1.007516013454653426}},
                                  {{3, "gauss2"},
                                   8,
                                   {0.424583415197856735, 1.419804224180584840},
                                   {0.424569715434987291, 1.419832258145990153},
                                   {0.424576565316422013, 1.419818241163287497}}};
  for (const Reference& r : references) {
    CAPTURE(r.elements.functions, r.elements.flux, r.row);
    Body body(problem_of("lotka-volterra", 0.125, r.elements), {1, 1});
    body.to(r.row);
    const Numbers traces = body.traces();
    for (std::size_t a = 0; a < 2; ++a) {
      CHECK(std::abs(traces[a] - r.minus[a]) < 1e-12);
      CHECK(std::abs(traces[2 + a] - r.plus[a]) < 1e-12);
      CHECK(std::abs(body.q()[a] - r.average[a]) < 1e-12);
    }
  }
}

TEST_CASE("so does the nodal flux, which has its value and momentum between the traces") {
  struct Reference {
    int functions, row;
    Numbers q, minus;
  };
  const Reference references[] = {
      {2, 1, {0.885254440899839317, 1.009946701777526303}, {0.880295306941841038, 1.005105273514816987}},
      {2, 8, {0.424229229760063362, 1.419713895951399639}, {0.424924702345318098, 1.419905701079808193}},
      {3, 1, {0.882769345622915649, 1.007490098655823700}, {0.882782429050579259, 1.007541929208325898}},
      {3, 8, {0.424450427565777341, 1.419772607894461373}, {0.424702679369998475, 1.419863619763092232}}};
  for (const Reference& r : references) {
    CAPTURE(r.functions, r.row);
    Body body(problem_of("lotka-volterra", 0.125, {r.functions, "nodal"}), {1, 1});
    body.to(r.row);
    CHECK(distance(body.q(), r.q) < 1e-12);
    CHECK(distance({body.traces()[0], body.traces()[1]}, r.minus) < 1e-12);
  }
}

TEST_CASE("the check can fail: another flux, or another gauge, makes other states") {
  const Numbers reference{0.425088479222136171715, 1.42024961128702892853};
  for (const Elements& e : {Elements{2, "gauss2"}, Elements{2, "simpson"}, Elements{2, "midpoint", "symmetric"}})
    CHECK(distance(Body(problem_of("lotka-volterra", 0.125, e), {1, 1}).to(8).q(), reference) > 1e-6);
}

TEST_CASE("the average is of order 2S for odd S and 2S - 2 for even S, in every gauge, from both sides") {
  for (const char* gauge : {"full", "x", "symmetric"})
    for (const char* flux : {"gauss2", "simpson"}) {
      CAPTURE(gauge, flux);
      CHECK(std::abs(order({1, flux, gauge}, 32) - 2) < 0.15);
      CHECK(std::abs(order({2, flux, gauge}, 12) - 2) < 0.15);
      CHECK(std::abs(order({3, flux, gauge}, 10) - 6) < 0.15);
      CHECK(std::abs(order({4, flux, gauge}, 6) - 6) < 0.15);
    }
  CHECK(std::abs(order({3, "midpoint"}, 10) - 6) < 0.15);
  CHECK(std::abs(order({4, "trapezoid"}, 6) - 6) < 0.15);
}

TEST_CASE("the traces alone are of order S or S - 1, no more") {
  const auto minus_error = [](int S, int n) {
    const Numbers of_minus = Body(problem_of("lotka-volterra", 1.0 / n, {S, "gauss2"}), {1, 1}).to(n).traces(),
                  fine = Body(problem_of("lotka-volterra", 1.0 / 40, {5, "gauss2"}), {1, 1}).to(40).q();
    return distance({of_minus[0], of_minus[1]}, fine);
  };
  for (const auto& [S, least, most] : {std::tuple{2, 0.7, 1.3}, {3, 2.7, 3.3}}) {
    const double slope = std::log2(minus_error(S, 16) / minus_error(S, 32));
    CAPTURE(S, slope);
    CHECK(slope > least);
    CHECK(slope < most);
  }
}

TEST_CASE("the one-sided flux in the gauge x is of order 2S - 1, and the nodal one of order 2 floor(S/2)") {
  for (const auto& [S, n] : {std::pair{1, 24}, {2, 24}, {3, 40}, {4, 4}}) {
    const double slope = order({S, "one-sided", "x"}, n);
    CAPTURE(S, slope);
    CHECK(std::abs(slope - (2 * S - 1)) < 0.25);
  }
  for (const auto& [S, n] : {std::pair{2, 16}, {3, 12}, {4, 12}, {5, 12}}) {
    const double slope = order({S, "nodal"}, n);
    CAPTURE(S, slope);
    CHECK(std::abs(slope - 2 * (S / 2)) < 0.15);
  }
}

TEST_CASE("near a saddle the jump grows by 1/(2S - 1) of the rate of the motion, whatever the flux and the step") {
  // H = ½(p² − q²): of the four multipliers of a step two are e^{±h}, the motion's; the others have |z| = e^{±rate h}
  for (int S = 1; S <= 4; ++S)
    for (const char* flux : {"midpoint", "trapezoid"})
      for (const double h : {0.1, 0.2}) {
        const auto c = characteristic(text_problem("p*q_t - 0.5*(p^2 - q^2)", "q, p", h, {S, flux}));
        // z⁴ + c₃z³ + c₂z² + c₃z + 1 = (z² − az + 1)(z² − bz + 1): a + b = −c₃, ab = c₂ − 2
        CHECK(std::abs(c[0] - 1) < 1e-9);
        CHECK(std::abs(c[1] - c[3]) < 1e-9);
        const double half = -c[3] / 2, root = std::sqrt(half * half - (c[2] - 2));
        std::array<double, 2> rates{};
        for (const std::size_t sign : {0, 1}) {
          const double a = std::abs(half + (sign == 0 ? root : -root));
          rates[sign] = std::acosh(a / 2) / h;
        }
        CAPTURE(S, flux, h, rates[0], rates[1]);
        const bool first = std::abs(rates[0] - 1) < std::abs(rates[1] - 1);
        if (S > 1) {
          CHECK(std::abs(rates[first ? 0 : 1] - 1) < 0.01);
          CHECK(std::abs(rates[first ? 1 : 0] * (2 * S - 1) - 1) < 0.1);
        } else {
          CHECK(std::abs(rates[0] - 1) < 0.1);
          CHECK(std::abs(rates[1] - 1) < 0.1);
        }
      }
}

TEST_CASE("an oscillator is stable up to the limits in omega h of its functions, and not beyond") {
  const auto stays = [](int S, double z) {
    try {
      Body body(text_problem("p*q_t - 0.5*(p^2 + q^2)", "q, p", z, {S, "midpoint"}), {1, 0.3}, {0.01, -0.02});
      double most = 0;
      for (int n = 1; n <= 600; ++n) most = std::max(most, std::abs(body.to(n).q()[0]));
      return most < 1e2;
    } catch (const NumericalFailure&) {
      return false;
    }
  };
  for (const auto& [S, z] : {std::pair{1, 1.0}, {2, 4.0}, {3, 2.3}, {4, 4.8}}) {
    CAPTURE(S, z);
    CHECK(stays(S, 0.96 * z));
    CHECK_FALSE(stays(S, 1.06 * z));
  }
}

TEST_CASE("the form of jumps is preserved from row to row") {
  // ω_n = Σ ∂²J/∂q⁻_a∂q⁺_b dq⁻_a ∧ dq⁺_b on first variations V, W along a solution
  for (const Elements& e : {Elements{1, "gauss2"}, Elements{3, "simpson"}, Elements{2, "midpoint", "symmetric"}}) {
    CAPTURE(e.functions, e.flux);
    Body body(problem_of("lotka-volterra", 0.1, e), {1, 1});
    body.to(20);
    const LatticeSystem& system = body.simulation().evolution().system();
    const Window rows = body.simulation().evolution().stepper().window(8);
    std::mt19937_64 random(5);
    Tangent tangent(system, body.simulation().evolution().plan(), 8, 0);
    const std::vector<Window> variations = tangent.evolve(rows, 2, random);
    const auto jump = std::ranges::find_if(system.families(), [&](const auto& family) {
      return std::ranges::all_of(family->values(), [&](const VertexValue& value) {
        return system.component(value.component).role == Role::trace;
      });
    });
    REQUIRE(jump != system.families().end());
    const auto form = [&](std::int64_t row) {
      const StencilFamily& J = **jump;
      const std::size_t n = J.size();
      Numbers y, second(n * n);
      for (const VertexValue& value : J.values()) y.push_back(rows(row, 0, value.component));
      J.jacobian({0.1, 1, 0, 0}, y, second);
      double sum = 0, size = 0;
      for (std::size_t a = 0; a < n / 2; ++a)
        for (std::size_t b = n / 2; b < n; ++b) {
          const auto at = [&](const Window& V, std::size_t m) { return V(row, 0, J.values()[m].component); };
          const Window &V = variations[0], &W = variations[1];
          const double one = second[a * n + b] * at(V, a) * at(W, b), two = second[a * n + b] * at(W, a) * at(V, b);
          sum += one - two, size += std::abs(one) + std::abs(two);
        }
      return std::pair{sum, size};
    };
    const auto [first, scale] = form(rows.first_row + 2);
    CHECK(std::abs(first) > 1e-6 * scale);
    for (std::int64_t row = rows.first_row + 3; row < rows.last_row(); ++row) {
      const auto [now, size] = form(row);
      CHECK(std::abs(now - first) < 1e-12 * (size + scale));
    }
  }
}

TEST_CASE("the form formula holds with inner nodes, traces and multipliers, and a broken variation is found") {
  std::vector<RegionRequest> regions;
  for (const RegionKind kind : region_kinds()) regions.push_back({to_string(kind), kind});
  for (const Elements& e : {Elements{3, "gauss2"}, Elements{2, "one-sided", "x"}, Elements{2, "nodal"}}) {
    CAPTURE(e.functions, e.flux);
    const Simulation simulation(problem_of("lotka-volterra", 0.1, e));
    const LatticeSystem& system = simulation.evolution().system();
    const int rows = FormCheck::rows_wanted(system, simulation.evolution().plan(), regions);
    std::mt19937_64 random(3);
    const auto values = rows_around_one(system, rows, random);
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

TEST_CASE("a gauge on the jumps alone is wrong by O(1), and the check of fluxes finds it in every flux") {
  for (const char* flux : {"midpoint", "trapezoid", "gauss2", "simpson", "nodal", "one-sided"}) {
    CAPTURE(flux);
    const Elements right{3, flux, "x"}, wrong{3, flux, "x", 0.1};
    for (const Elements& e : {right, wrong}) {
      const Simulation simulation(problem_of("lotka-volterra", 0.1, e));
      const auto checks = check_fluxes(simulation.evolution().system(), Numbers{0.8, 1.3});
      REQUIRE(checks.size() == 1);
      CHECK((checks[0].value > checks[0].tolerance) == (e.nu != 0));
    }
  }
  double least = std::numeric_limits<double>::infinity();
  for (const int n : {16, 32, 64}) {
    try {
      least = std::min(least, error({3, "gauss2", "full", 0.1}, n));
    } catch (const NumericalFailure&) {
    }
  }
  CHECK(least > 1e-3);
}

TEST_CASE("a change of gauge in the density changes cells and jumps alike") {
  // d/dt(q₁q₂) is a total derivative; with the midpoint rule a jump of it is Q₂[q₁] + Q₁[q₂] = [q₁q₂]
  const Numbers plain =
                    Body(text_problem("log(b)/a*a_t - a - b + log(a) + 2*log(b)", "a, b", 0.1, {3, "midpoint"}), {1, 1})
                        .to(10)
                        .q(),
                other = Body(text_problem("log(b)/a*a_t - a - b + log(a) + 2*log(b) + b*a_t + a*b_t", "a, b", 0.1,
                                          {3, "midpoint"}),
                             {1, 1})
                            .to(10)
                            .q();
  CHECK(distance(plain, other) < 1e-13);
  CHECK(distance(plain, Body(problem_of("lotka-volterra", 0.1, {3, "midpoint", "x"}), {1, 1}).to(10).q()) < 1e-14);
}

TEST_CASE("vortices keep their angular momentum, and a guiding centre its toroidal momentum, to rounding") {
  for (const auto& [theory, q, steps] : {std::tuple{"point-vortices", Numbers{1, 0, -0.5, 0.8, -0.3, -0.9}, 200},
                                         std::tuple{"two-vortices", Numbers{0.5, 0, -0.4, 0.3}, 200},
                                         std::tuple{"guiding-centre", Numbers{2.5, 0, 0, 0.4}, 100}}) {
    CAPTURE(theory);
    Body body(problem_of(theory, 0.1, {3, "gauss2"}), q);
    REQUIRE(body.simulation().conserved_names().size() == 1);
    const double energy = body.simulation().monitors().energy;
    const double first = body.to(1).simulation().monitors().conserved[0];
    double drift = 0;
    for (int n = 2; n <= steps; ++n)
      drift = std::max(drift, std::abs(body.to(n).simulation().monitors().conserved[0] - first));
    CHECK(std::abs(first) > 1e-3);
    CHECK(drift < 1e-12 * std::max(1.0, std::abs(first)));
    CHECK(std::abs(body.simulation().monitors().energy - energy) < 1e-5 * std::abs(energy));
  }
}

TEST_CASE("a charged particle drifts along H, and its jump is a monitor") {
  Body body(problem_of("charged-particle", 0.1, {3, "gauss2"}), {1, 0.5});
  const double energy = body.simulation().monitors().energy;
  CHECK(std::abs(energy - (std::cos(1) + std::sin(0.5))) < 1e-14);
  body.to(100);
  const auto monitors = body.simulation().monitors();
  CHECK(std::abs(monitors.energy - energy) < 1e-6);
  const Numbers traces = body.traces();
  CHECK(body.simulation().monitor_names() == std::vector<std::string>{"jump"});
  CHECK(std::abs(monitors.of_method[0] - std::max(std::abs(traces[2] - traces[0]), std::abs(traces[3] - traces[1]))) <
        1e-14);
}

TEST_CASE("what the method cannot be built for is refused with the key, the reason and a remedy") {
  Problem circle = problem_of("lotka-volterra", 0.1, {3, "gauss2"});
  circle.lattice = Lattice::circle(31, 20);
  circle.parameters["scheme.space"] = "linear";
  CHECK(contains(refusal(circle), "use lumped or pairs"));
  circle.parameters["scheme.space"] = "lumped", circle.lattice = Lattice::interval(31, 20, Wall::natural);
  CHECK(contains(refusal(circle), "boundary.left = natural"));
  CHECK(contains(refusal(problem_of("pendulum", 0.1, {3, "gauss2"})), "not linear in phi_t; use scheme.method = cgvi"));
  CHECK(contains(refusal(text_problem("p*q_t - 0.5*p^2*q_t^2", "q, p", 0.1, {3, "gauss2"})), "not linear in q_t"));
  CHECK(contains(refusal(text_problem("p*q_t - r^2*q_t", "q, p, r", 0.1, {3, "gauss2"})), "even number"));
  CHECK(contains(refusal(problem_of("lotka-volterra", 0.1, {3, "one-sided", "full"})), "scheme.flux"));
  CHECK(
      contains(refusal(problem_of("lotka-volterra", 0.1, {1, "gauss2", "full", 0, "bernstein"})), "scheme.functions"));
  CHECK(refusal(problem_of("lotka-volterra", 0.1, {3, "one-sided", "x"})) == "accepted");
  Problem second = problem_of("lotka-volterra", 0.1, {3, "gauss2"});
  second.method = "cgvi", second.parameters = {};
  CHECK(contains(refusal(second), "use scheme.method = dgvi"));
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/verify/stress_balance.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// A run that is repeated at h/2 and k/2.
struct Run {
  Problem problem;
  StateRequest request;
  int cells;
  double until;
};

Run run_of(const std::string& theory, const std::string& state, Lattice lattice, double until) {
  Run run;
  run.problem.theory = run.request.theory = theory;
  run.problem.lattice = lattice;
  run.problem.time_step = lattice.space() == Space::point ? 0.05 : 0.5 * lattice.space_step();
  run.request.name = state;
  run.cells = lattice.cells(), run.until = until;
  return run;
}

Run breather(Lattice lattice) {
  Run run = run_of("sine-gordon", "breather", lattice, 6);
  run.request.values["initial.speed"] = 0.3;
  return run;
}

/// Half as large steps in time and space.
Run finer(Run run) {
  Lattice& lattice = run.problem.lattice;
  if (lattice.space() == Space::circle) lattice = Lattice::circle(2 * run.cells, lattice.length());
  if (lattice.space() == Space::interval)
    lattice = Lattice::interval(2 * run.cells + 1, lattice.length(), lattice.left(), lattice.right());
  run.cells *= 2, run.problem.time_step /= 2;
  return run;
}

/// The density as if it did not depend on where it is: forgets ∂ℓ/∂t and ∂ℓ/∂x.
class Unplaced final : public BatchDensity {
 public:
  explicit Unplaced(const BatchDensity& density) : BatchDensity(density), density_(density) { placed_ = false; }
  void value(const JetBatch& jets, double* l) const override { density_.value(jets, l); }
  void gradient(const JetBatch& jets, double* const* g, double* l) const override { density_.gradient(jets, g, l); }
  void hessian(const JetBatch& jets, double* const* H) const override { density_.hessian(jets, H); }
  void slope(const JetBatch& jets, double* const* g) const override { density_.slope(jets, g); }
  void curvature(const JetBatch& jets, double* const* d) const override { density_.curvature(jets, d); }
  void place_gradient(const JetBatch& jets, double* l_t, double* l_x) const override {
    std::fill_n(l_t, jets.count, 0.0), std::fill_n(l_x, jets.count, 0.0);
  }

 private:
  const BatchDensity& density_;
};

std::vector<Measured> balances(Run run, bool with_source = true) {
  Problem& p = run.problem;
  const auto state = make_state(run.request, p.lattice);
  if (p.lattice.is_circle()) p.winding = state->winding();
  Simulation simulation(p);
  std::vector<double> row(p.lattice.sites() * state->components()), rate(row.size());
  state->values(0, p.lattice, row), state->velocities(0, p.lattice, rate);
  simulation.start_centred(row, rate);

  const FieldTheory unplaced(std::make_shared<Unplaced>(simulation.theory().density()));
  StressBalance balance(with_source ? simulation.theory() : unplaced, p.lattice, p.time_step,
                        2 * std::numbers::pi * p.winding);
  simulation.copy_row(1, row);
  balance.add(0, row);
  const auto steps = std::lround(run.until / p.time_step);
  for (;; simulation.step()) {
    simulation.copy_row(0, row);
    balance.add(simulation.newest(), row);
    if (simulation.newest() == steps) return balance.results();
  }
}

std::vector<Measured> orders(const Run& run, bool with_source = true) {
  return with_orders(balances(run, with_source), balances(finer(run), with_source));
}

const Measured& named(const std::vector<Measured>& list, const std::string& name) {
  const auto found = std::ranges::find(list, name, &Measured::name);
  REQUIRE(found != list.end());
  return *found;
}

void vanish_to_second_order(const std::vector<Measured>& list) {
  for (const Measured& m : list) {
    CAPTURE(m.name, m.region, m.value, m.normaliser, m.order);
    CHECK(m.value > 0);
    CHECK(m.count > 0);
    CHECK(m.order > 1.9);
    CHECK(m.order < 2.1);
  }
}

constexpr Wall fixed = Wall::fixed, natural = Wall::natural;

}  // namespace

TEST_CASE("the balance laws of a breather hold to second order on a circle, locally and in total") {
  const auto list = orders(breather(Lattice::circle(800, 40)));
  REQUIRE(list.size() == 4);
  vanish_to_second_order(list);
}

TEST_CASE("the balance laws hold to second order between walls, through which energy and momentum flow") {
  vanish_to_second_order(orders(breather(Lattice::interval(801, 40, fixed, natural))));
  Run half = run_of("sine-gordon", "breather", Lattice::interval(401, 20, natural, fixed), 6);
  half.request.values["initial.position"] = 0,
  half.request.values["initial.frequency"] = 0.6;  // even about the wall, where it beats
  vanish_to_second_order(orders(half));
}

TEST_CASE("the balance laws know the turn of a kink around its circle") {
  Run run = run_of("sine-gordon", "kink", Lattice::circle(800, 40), 6);
  run.request.values["initial.speed"] = 0.5;
  run.request.values["initial.position"] = 38;  // crosses the seam
  const auto list = orders(run);
  for (const char* name : {"energy balance, local", "momentum balance, local"}) {
    CAPTURE(name, named(list, name).order, named(list, name).value);
    CHECK(named(list, name).order > 1.9);
    CHECK(named(list, name).order < 2.1);
  }
}

TEST_CASE("several fields and a constraint: the balance laws of the wave map hold to second order") {
  const Lattice circle = Lattice::circle(128, 2 * std::numbers::pi);
  Run run = run_of("wave-map", "great-circle", circle, 1.5);
  run.problem.stencil = "rectangle";
  const auto state = make_state(run.request, circle);
  // Its second row is known, and no centred start is.
  const auto of = [&](Run r) {
    Simulation simulation(r.problem);
    const std::size_t N = r.problem.lattice.sites();
    std::vector<double> u(3 * N);
    std::vector<std::vector<double>> rows(2, std::vector<double>(4 * N));
    for (std::size_t n = 0; n < 2; ++n) {
      state->values(static_cast<double>(n) * r.problem.time_step, r.problem.lattice, u);
      for (std::size_t at = 0; at < u.size(); ++at) rows[n][at / 3 * 4 + at % 3] = u[at];
    }
    simulation.start(rows);
    StressBalance balance(simulation.theory(), r.problem.lattice, r.problem.time_step, 0);
    simulation.copy_row(1, u);
    balance.add(0, u);
    for (;; simulation.step()) {
      simulation.copy_row(0, u);
      balance.add(simulation.newest(), u);
      if (static_cast<double>(simulation.newest()) * r.problem.time_step >= r.until) return balance.results();
    }
  };
  const auto list = with_orders(of(run), of(finer(run)));
  REQUIRE(list.size() == 4);
  for (const Measured& m : list) {
    CAPTURE(m.name, m.region, m.value, m.normaliser, m.order);
    CHECK(m.order > 1.9);
    CHECK(m.order < 2.1);
  }
}

TEST_CASE("an impurity takes up momentum: with what it takes the balance is of second order, without it of none") {
  Run run = run_of("sine-gordon-impurity", "kink", Lattice::interval(801, 40), 8);
  run.problem.parameters["theory.strength"] = 0.5, run.problem.parameters["theory.position"] = 20;
  run.request.values["initial.position"] = 17, run.request.values["initial.speed"] = 0.5;
  vanish_to_second_order(orders(run));
  const auto forgetful = orders(run, false);
  for (const char* name : {"momentum balance, local", "momentum balance, total"}) {
    CAPTURE(name, named(forgetful, name).value, named(forgetful, name).order);
    CHECK(std::abs(named(forgetful, name).order) < 0.1);
  }
  // the place matters, the time does not
  CHECK(named(forgetful, "energy balance, local").value == named(balances(run), "energy balance, local").value);
}

TEST_CASE("friction takes energy away: the balances of a damped run do not vanish with h") {
  Run run = breather(Lattice::circle(400, 40));
  run.problem.method = "damped";
  const auto list = orders(run);
  REQUIRE(list.size() == 4);
  for (const Measured& m : list) {
    CAPTURE(m.name, m.value, m.normaliser, m.order);
    CHECK(std::abs(m.order) < 0.5);
  }
}

TEST_CASE("in mechanics the balance of energy is of second order, and there is no momentum") {
  for (const char* stencil : {"midpoint", "trapezoidal"}) {
    Run run = run_of("pendulum", "pendulum-swing", Lattice::point(), 20);
    run.problem.stencil = stencil;
    const auto list = orders(run);
    REQUIRE(list.size() == 2);
    vanish_to_second_order(list);
  }
}

TEST_CASE("the defect at a vertex is the one written by hand, and it is found where it is") {
  const int N = 6;
  const double h = 0.1, k = 0.5, monodromy = 2 * std::numbers::pi;
  const Lattice lattice = Lattice::circle(N, N * k);
  Problem p;
  p.lattice = lattice, p.time_step = h, p.winding = 1;
  const Simulation simulation(p);
  StressBalance balance(simulation.theory(), lattice, h, monodromy);
  const auto y = [&](int j, int i) {
    const int home = lattice.wrapped(i);
    return std::sin(3.7 * j * j + 1.3 * home * home) + monodromy * home / N + monodromy * ((i - home) / N);
  };
  for (int j = 0; j < 4; ++j) {
    std::vector<double> row;
    for (int i = 0; i < N; ++i) row.push_back(y(j, i));
    balance.add(j, row);
  }
  struct Terms {
    double energy, flux, momentum, pressure;
  };
  const auto cell = [&](int j, int i) -> Terms {
    const double a = y(j, i), b = y(j, i + 1), c = y(j + 1, i), d = y(j + 1, i + 1);
    const double by_t = (c + d - a - b) / (2 * h), by_x = (b + d - a - c) / (2 * k);
    const double V = 1 - std::cos((a + b + c + d) / 4), kinetic = 0.5 * (by_t * by_t + by_x * by_x);
    return {kinetic + V, -by_t * by_x, -by_t * by_x, kinetic - V};
  };
  double energy = 0, momentum = 0;
  for (int j = 1; j <= 2; ++j)
    for (int i = 0; i < N; ++i) {
      const Terms a = cell(j - 1, i - 1), b = cell(j - 1, i), c = cell(j, i - 1), d = cell(j, i);
      energy = std::max(energy, std::abs((c.energy + d.energy - a.energy - b.energy) / (2 * h) +
                                         (b.flux + d.flux - a.flux - c.flux) / (2 * k)));
      momentum = std::max(momentum, std::abs((c.momentum + d.momentum - a.momentum - b.momentum) / (2 * h) +
                                             (b.pressure + d.pressure - a.pressure - c.pressure) / (2 * k)));
    }
  double total = 0, first = 0;
  for (int j = 0; j < 3; ++j) {
    double E = 0;
    for (int i = 0; i < N; ++i) E += k * cell(j, i).energy;
    if (j == 0) first = E;
    total = std::max(total, std::abs(E - first));
  }
  const auto list = balance.results();
  const auto value = [&](const char* name) { return named(list, name).value * named(list, name).normaliser; };
  CHECK(value("energy balance, local") == Approx(energy));
  CHECK(value("momentum balance, local") == Approx(momentum));
  CHECK(value("energy balance, total") == Approx(total));
  CHECK(named(list, "energy balance, local").count == 2 * N);
  CHECK(named(list, "energy balance, total").count == 2);
  CHECK(named(list, "energy balance, local").value < 1);
  CHECK(named(list, "energy balance, local").region.find("site ") != std::string::npos);
}

TEST_CASE("the total balance is the sum of the local ones: what two rows miss together, at one vertex alone") {
  // Three sites between walls have one vertex that is not a wall.
  const double h = 0.1;
  const Lattice lattice = Lattice::interval(3, 1, fixed, fixed);
  Problem p;
  p.lattice = lattice, p.time_step = h;
  const Simulation simulation(p);
  StressBalance balance(simulation.theory(), lattice, h, 0);
  balance.add(0, std::vector<double>{0.1, 0.3, 0.7});
  balance.add(1, std::vector<double>{0.2, 0.5, 0.4});
  balance.add(2, std::vector<double>{0.9, 0.2, 0.3});
  const auto list = balance.results();
  for (const std::string law : {"energy", "momentum"}) {
    const Measured &local = named(list, law + " balance, local"), &total = named(list, law + " balance, total");
    CHECK(total.value * total.normaliser ==
          Approx(h * lattice.space_step() * local.value * local.normaliser).epsilon(1e-12));
  }
}

TEST_CASE("a field at rest carries no momentum: the rounding that is left of it is measured by its energy") {
  Problem p;
  p.lattice = Lattice::circle(64, 2 * std::numbers::pi), p.time_step = 0.05;
  const Simulation simulation(p);
  StressBalance balance(simulation.theory(), p.lattice, p.time_step, 0);
  for (int j = 0; j < 4; ++j) {
    std::vector<double> row;
    for (int i = 0; i < 64; ++i) row.push_back(std::sin(p.lattice.position(i)) + (i == 20 ? 2e-16 * j : 0.0));
    balance.add(j, row);
  }
  const Measured momentum = named(balance.results(), "momentum balance, total");
  CHECK(momentum.normaliser > 1);
  CHECK(momentum.value < 1e-14);
  CHECK_FALSE(momentum.remark.empty());
}

TEST_CASE("what is not a number is found, and round-off has no order") {
  Problem p;
  p.lattice = Lattice::circle(4, 1), p.time_step = 0.1;
  const Simulation simulation(p);
  StressBalance balance(simulation.theory(), p.lattice, 0.1, 0);
  for (int j = 0; j < 3; ++j) {
    std::vector<double> row{0, 0.1, 0.2, 0.1};
    if (j == 1) row[2] = std::numeric_limits<double>::quiet_NaN();
    balance.add(j, row);
  }
  CHECK(std::isnan(named(balance.results(), "energy balance, local").value));
  CHECK(std::isnan(named(balance.results(), "momentum balance, total").value));

  StressBalance vacuum(simulation.theory(), p.lattice, 0.1, 0);
  for (int j = 0; j < 3; ++j) vacuum.add(j, std::vector<double>(4));
  for (const Measured& m : with_orders(vacuum.results(), vacuum.results())) {
    CHECK(m.value == 0);
    CHECK(std::isnan(m.order));
  }
  CHECK_THROWS_AS(vacuum.add(7, std::vector<double>(4)), std::logic_error);
  CHECK_THROWS_AS(vacuum.add(3, std::vector<double>(3)), std::logic_error);
}

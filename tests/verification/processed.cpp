// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <random>
#include <tuple>

#include "jets/force_squared.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "jets/tables/suited_pairs.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/pair_parts.hpp"
#include "schemes/stability/splitting_limit.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/coupled_sine_gordon.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

Problem problem_of(const std::string& kernel, int space_order, int sites, int steps, double until) {
  Problem p;
  p.method = "processed", p.parameters["scheme.kernel"] = kernel, p.parameters["lattice.space_order"] = space_order;
  p.lattice = Lattice::circle(sites, 80), p.time_step = until / steps;
  return p;
}

/// The parts of a scheme as an evolution of its own, with its processor or without.
struct Kernel {
  Problem problem;
  std::unique_ptr<FieldTheory> theory;
  Evolution evolution;
  std::size_t C;

  Kernel(const Problem& p, bool processed)
      : problem(completed(p)),
        theory(find_theory(p.theory).make(problem.parameters)),
        evolution([&] {
          SchemeParts parts = find_method(p.method).build(*theory, problem);
          StepOptions options;
          if (processed) options.processor = parts.processor;
          return Evolution(p.lattice, parts.families, p.time_step, options, parts.components);
        }()),
        C(delf::at(evolution.system().components())) {}

  void start(const Row& phi, const Row& rate) {
    Row row(phi.size() * C, 0.0), momenta(row);
    for (std::size_t i = 0; i < phi.size(); ++i)
      row[i * C] = phi[i], momenta[i * C] = rate[i] * problem.lattice.space_step();
    evolution.stepper().start_legendre(row, momenta);
  }
  void run(int steps) {
    while (evolution.stepper().newest() < steps) evolution.stepper().step(true);
  }
  Row fields() const {
    const Row row = evolution.stepper().row(0);
    Row phi(row.size() / C);
    for (std::size_t i = 0; i < phi.size(); ++i) phi[i] = row[i * C];
    return phi;
  }
};

struct Fields {
  Row phi, rate;
};
/// A moving breather on a circle of length 80, its tails below rounding there.
Fields breather(double t, const Lattice& lattice) {
  StateRequest request;
  request.name = "breather", request.theory = "sine-gordon";
  request.values["initial.frequency"] = 0.5, request.values["initial.speed"] = 0.3;
  const auto state = make_state(request, lattice);
  return {values(*state, t, lattice), t == 0 ? velocities(*state, 0, lattice) : Row{}};
}

constexpr double until = 4;

Row last_row(const std::string& kernel, int sites, int steps, bool processed) {
  Problem p = problem_of(kernel, 12, sites, steps, until);
  p.parameters["lattice.gradient_order"] = 12;  // another force would leave an error of its own in h²
  const Fields first = breather(0, p.lattice);
  Kernel scheme(p, processed);
  scheme.start(first.phi, first.rate);
  scheme.run(steps);
  if (!processed) return scheme.fields();
  Row phi, rate;
  scheme.evolution.stepper().observe(0, phi, &rate);
  return phi;
}

Row nearly_exact_in_time(int sites) {
  Problem p;
  p.method = "composition", p.parameters["scheme.order"] = 8, p.parameters["lattice.space_order"] = 12;
  p.lattice = Lattice::circle(sites, 80), p.time_step = until / 320;
  const Fields first = breather(0, p.lattice);
  Kernel scheme(p, false);
  scheme.start(first.phi, first.rate);
  scheme.run(320);
  return scheme.fields();
}

}  // namespace

TEST_CASE("processed kernels are of effective order 4 and 6, and of 2 without their processor") {
  const int sites = 320;
  const Row exact = nearly_exact_in_time(sites);
  struct Expected {
    const char* kernel;
    bool processed;
    int steps;
    double order;
  };
  for (const auto& [kernel, processed, steps, order] :
       {Expected{"ti4", true, 40, 4}, {"b6", true, 20, 6}, {"ti4", false, 40, 2}, {"b6", false, 40, 2}}) {
    const double coarse = distance(last_row(kernel, sites, steps, processed), exact),
                 fine = distance(last_row(kernel, sites, 2 * steps, processed), exact);
    const double found = testing::order(coarse, fine, 2);
    CAPTURE(kernel, processed, coarse, fine, found);
    CHECK(found > order - 0.25);
    CHECK(found < order + 0.25);
  }
}

TEST_CASE("kernels satisfy the form formula on their own rows, force gradients, walls and all") {
  std::mt19937_64 random(72);
  constexpr double k = 0.6, h = 0.3;
  const Lattice lines[] = {Lattice::circle(16, 16 * k), Lattice::interval(16, 15 * k),
                           Lattice::interval(16, 15 * k, Wall::natural, Wall::fixed)};
  const auto families = [&](const char* kernel, auto density, int p, const Lattice& lattice) {
    const Splitting splitting = processed_splitting(kernel);
    FamilyList list{jet_family(pair_element(splitting, p), density)};
    for (const StencilTable& wall : at_both_walls(pair_space(pair_weights(p)), lattice)) {
      StencilTable term = product(splitting_element(splitting), wall);
      term.pattern.placement = wall.pattern.placement;
      list.push_back(jet_family(std::move(term), density));
    }
    if (splitting.gradient == 0) return list;
    const auto squares = std::make_shared<ForceSquared>(std::make_shared<BatchOf<decltype(density)>>(density),
                                                        splitting.gradient * h * h);
    const StencilTable force = force_table(p, splitting.offset);
    list.push_back(std::make_shared<JetFamily>(force, squares));
    for (StencilTable& wall : at_both_walls(force, lattice))
      list.push_back(std::make_shared<JetFamily>(std::move(wall), squares));
    return list;
  };
  for (const Lattice& lattice : lines)
    for (int trial = 0; trial < 6; ++trial) {
      const int S = trial % 3 == 2 ? 6 : 1;
      const FamilyList list = trial % 3 == 0   ? families("ti4", SineGordon{}, 2, lattice)
                              : trial % 3 == 1 ? families("ti4", PhiFour{}, 1, lattice)
                                               : families("b6", SineGordon{}, 2, lattice);
      Patch patch(lattice, list, h, random_centres(random, lattice.is_circle() ? 12 : 0, S));
      REQUIRE(patch.U().regular());
      REQUIRE(!patch.on.equations().empty());
      patch.y = random_values(random, patch.on.nodes());
      auto pair = patch.variations(random);
      CHECK(patch.form_formula(pair).relative() < 1e-13);
      const auto node = patch.on.coupling_node(patch.y);
      REQUIRE(node);
      pair.V[*node] += 0.01;  // V is no first variation any more
      CHECK(patch.form_formula(pair).relative() > 1e-8);
    }
}

namespace {

/// Rows of a scheme that start from sin and cos on an interval of 24 cells, or on a circle of the images of two intervals.
struct BetweenWalls {
  Problem problem;
  Simulation simulation;
  std::size_t C;

  BetweenWalls(const std::string& method, const std::string& kernel, const Lattice& lattice, bool odd)
      : problem([&] {
          Problem p;
          p.method = method, p.lattice = lattice, p.time_step = 0.2;
          p.parameters["lattice.space_order"] = 8;
          if (method == "processed") p.parameters["scheme.kernel"] = kernel;
          return p;
        }()),
        simulation(problem),
        C(simulation.components().size()) {
    const std::size_t sites = lattice.sites();
    Row row(sites * C), rate(sites * C);
    for (std::size_t i = 0; i < sites; ++i)
      for (std::size_t c = 0; c < C; ++c) {
        const double x = M_PI * static_cast<double>(i) / 24;
        row[i * C + c] =
            odd ? 1.5 * std::sin(x) + 0.4 * std::sin(2 * x) : 0.3 + 1.5 * std::cos(x) - 0.2 * std::cos(2 * x);
        rate[i * C + c] = odd ? 0.5 * std::sin(2 * x) : 0.2 + 0.5 * std::cos(x);
      }
    simulation.start_legendre(row, rate);
    while (simulation.newest() < 60) simulation.step();
  }
  Row fields() const {
    Row phi(delf::at(problem.lattice.sites()));
    simulation.observe(0, phi);
    return phi;
  }
};

}  // namespace

TEST_CASE("between walls wide pairs have the rows of a circle of mirror images, and solve the generated equations") {
  for (const Wall wall : {Wall::fixed, Wall::natural})
    for (const auto& [method, kernel] : {std::pair{"processed", "ti4"}, {"processed", "b6"}, {"composition", ""}}) {
      const bool odd = wall == Wall::fixed;
      const BetweenWalls interval(method, kernel, Lattice::interval(25, 12, wall, wall), odd),
          circle(method, kernel, Lattice::circle(48, 24), odd);
      const Row inside = interval.fields(), images = circle.fields();
      double furthest = 0;
      for (std::size_t i = 0; i < 25; ++i) furthest = std::max(furthest, std::abs(inside[i] - images[i]));
      CAPTURE(method, kernel, odd);
      CHECK(furthest < 1e-13);
      const Evolution& evolution = interval.simulation.evolution();
      CHECK(evolution.stepper().residual() < 1e-14);
      std::vector<LatticeSystem::Value> values;
      const Window window = evolution.stepper().window(3);
      evolution.system().equations(window, window.last_row() - 1, values);
      double worst = 0, size = 0;
      for (std::size_t at = 0; at < values.size(); ++at) {
        if (interval.problem.lattice.is_fixed(static_cast<int>(at / interval.C))) continue;  // no equation
        worst = std::max(worst, std::abs(values[at].sum)), size = std::max(size, values[at].absolute);
      }
      CHECK(worst < 1e-14 * size);
      if (!odd) continue;
      // Other walls make other rows.
      const BetweenWalls mixed(method, kernel, Lattice::interval(25, 12, wall, Wall::natural), odd);
      CHECK(distance(mixed.fields(), inside) > 1e-2);
    }
}

TEST_CASE("wide pairs refuse a wall that the density has no mirror image about") {
  for (const auto& [theory, wall, fits] : {std::tuple{"phi4", 1.0, false},
                                           {"phi4", 0.0, true},
                                           {"sine-gordon", M_PI, true},
                                           {"sine-gordon", 1.0, false}}) {
    Problem p;
    p.theory = theory, p.method = "processed", p.parameters["scheme.kernel"] = std::string("ti4");
    p.lattice = Lattice::interval(25, 12), p.time_step = 0.2;
    Simulation simulation(p);
    const Row row(25, wall), rate(25, 0.0);
    CAPTURE(theory, wall);
    if (fits) CHECK_NOTHROW(simulation.start_legendre(row, rate));
    else CHECK_THROWS_WITH(simulation.start_legendre(row, rate), Catch::Contains("boundary.left"));
  }
}

TEST_CASE("a kernel returns over its own rows, and its rows solve the generated equations") {
  for (const char* theory :
       {"sine-gordon", "phi4", "klein-gordon", "wave", "coupled-sine-gordon", "sine-gordon-impurity"})
    for (const char* kernel : {"ti4", "b6"}) {
      Problem p = problem_of(kernel, 8, 60, 1, 0.1);
      p.theory = theory, p.lattice = Lattice::circle(60, 24), p.time_step = 0.2;
      p.parameters["theory.position"] = 12, p.parameters["theory.width"] = 0.3;  // far from the seam
      Kernel scheme(p, false);
      const std::size_t d = scheme.evolution.system().fields();
      Row row(60 * scheme.C, 0.0), momenta(row);
      for (std::size_t i = 0; i < 60; ++i)
        for (std::size_t a = 0; a < d; ++a) {
          const double x = 2 * M_PI * (static_cast<double>(i) + 0.3 * static_cast<double>(a)) / 60;
          row[i * scheme.C + a] = std::sin(x) + 0.4 * std::cos(2 * x);
          momenta[i * scheme.C + a] = (0.5 * std::cos(x) - 0.2) * p.lattice.space_step();
        }
      Stepper& stepper = scheme.evolution.stepper();
      stepper.start_legendre(row, momenta);
      scheme.run(12);
      CAPTURE(theory, kernel);
      CHECK(stepper.residual() < 1e-14);
      // one stencil at a time, by derivatives
      const Window window = stepper.window(3);
      std::vector<LatticeSystem::Value> values;
      scheme.evolution.system().equations(window, window.last_row() - 1, values);
      double worst = 0, size = 0;
      for (const auto& v : values) worst = std::max(worst, std::abs(v.sum)), size = std::max(size, v.absolute);
      CHECK(worst < 1e-14 * size);
      if (std::string(theory) == "sine-gordon-impurity") continue;
      if (std::string(kernel) != "ti4") continue;  // whose rows are its whole state
      Kernel back(p, false);
      back.evolution.stepper().start({stepper.row(0), stepper.row(1)});
      for (int n = 0; n < 11; ++n) back.evolution.stepper().step();
      CHECK(distance(back.evolution.stepper().row(0), row) < 1e-13);
    }
}

TEST_CASE("the processor is undone at any row that is held, with the bits of other runs") {
  for (const char* kernel : {"ti4", "b6"}) {
    const Problem p = problem_of(kernel, 8, 96, 40, 20);
    const Fields first = breather(0, p.lattice);
    Kernel scheme(p, true), other(p, true);
    scheme.start(first.phi, first.rate), other.start(first.phi, first.rate);
    Row phi, rate, before, before_rate, again;
    scheme.evolution.stepper().observe(1, phi, &rate);
    CAPTURE(kernel);
    // at the start, and what was done is undone
    CHECK(distance(phi, first.phi) < 1e-13);
    CHECK(distance(rate, first.rate) < 1e-12);
    scheme.run(40);
    scheme.evolution.stepper().observe(0, phi, &rate);
    while (other.evolution.stepper().newest() < 40) other.evolution.stepper().step(false);
    other.evolution.stepper().observe(0, again, &before_rate);
    CHECK(phi == again);
    // a row that was observed before it became the row before
    scheme.evolution.stepper().step(true);
    scheme.evolution.stepper().observe(1, before, &before_rate);
    CHECK(distance(before, phi) < 1e-13);
    CHECK(distance(scheme.fields(), phi) > 1e-3);  // the kernel's own row is another one
  }
}

TEST_CASE("limits of kernels are those of theory, and runs agree to one percent") {
  CHECK(frequency_limit(processed_splitting("ti4")) == Approx(std::sqrt(12)).epsilon(1e-3));
  CHECK(frequency_limit(processed_splitting("b6")) == Approx(3.129).epsilon(1e-3));
  struct Limit {
    const char* kernel;
    int p;
    double courant;
  };
  for (const auto& [kernel, p, courant] :
       {Limit{"ti4", 4, 1.359}, {"ti4", 6, 1.303}, {"b6", 6, 1.177}, {"b6", 8, 1.148}, {"b6", 10, 1.130}}) {
    CAPTURE(kernel, p);
    CHECK(courant_limit(processed_splitting(kernel), pair_weights(p), pair_weights(p)) ==
          Approx(courant).epsilon(1e-3));
    for (const double factor : {0.995, 1.005}) {  // b6 is stable again from 1.011 on
      Problem problem = problem_of(kernel, 2 * p, 64, 1, 1);
      problem.theory = "wave", problem.lattice = Lattice::circle(64, 64);
      problem.time_step = factor * courant;
      problem.parameters["lattice.gradient_order"] = 2 * p;
      Kernel scheme(problem, true);
      std::mt19937_64 random(5);
      Row phi = random_values(random, 64), rate = random_values(random, 64);
      scheme.start(phi, rate);
      double mean = 0;
      for (const double r : rate) mean += r / 64;
      constexpr int steps = 1500;
      double largest = 0;
      try {
        while (scheme.evolution.stepper().newest() < steps) scheme.evolution.stepper().step(false);
        for (const double y : scheme.fields())
          largest = std::max(largest, std::abs(y - steps * problem.time_step * mean));
      } catch (const NotFinite&) {
        largest = 1e150;
      }
      CAPTURE(factor, largest);
      CHECK((largest < 1e4) == (factor < 1));
    }
  }
}

TEST_CASE("suited pairs err less than those of maximal order where the field has waves") {
  for (const int p : {2, 4, 8, 10})
    for (const double decay : {3.0, 8.0}) {
      const std::vector<double> suited = suited_pairs(p, decay), maximal = pair_weights(p);
      double sum = 0;
      for (const double w : suited) sum += w;
      CAPTURE(p, decay);
      CHECK(sum == Approx(1).epsilon(1e-14));
      CHECK(weighted_defect(suited, decay) < 0.9 * weighted_defect(maximal, decay));
      // It is a minimum: no weight can be changed and leave a smaller maximum.
      for (std::size_t m = 1; m < suited.size(); ++m)
        for (const double change : {1e-3, -1e-3}) {
          std::vector<double> other = suited;
          other[m] += change * suited[m], other[0] -= change * suited[m];
          CHECK(weighted_defect(other, decay) > weighted_defect(suited, decay));
        }
    }
}

// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <random>

#include "jets/tables/pair_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A moving breather on a circle of length 80, its tails below rounding there, at T = 4.
Row breather(int order, int space_order, int sites, int steps, double* error = nullptr) {
  constexpr double until = 4;
  Problem p;
  p.method = "composition", p.parameters["scheme.order"] = order, p.parameters["lattice.space_order"] = space_order;
  p.lattice = Lattice::circle(sites, 80), p.time_step = until / steps;
  StateRequest request;
  request.name = "breather", request.theory = p.theory, request.values["initial.frequency"] = 0.5,
  request.values["initial.speed"] = 0.3;
  const auto state = make_state(request, p.lattice);
  Simulation simulation(p);
  const auto C = simulation.components().size();
  std::vector<double> row(at(sites) * C), rate(row.size());
  const Row phi = values(*state, 0, p.lattice), phi_t = velocities(*state, 0, p.lattice);
  for (std::size_t i = 0; i < phi.size(); ++i) row[i * C] = phi[i], rate[i * C] = phi_t[i];
  simulation.start_legendre(row, rate);
  while (simulation.newest() < steps) simulation.step(false);
  const Row last = newest(simulation, p.lattice);
  if (error) *error = distance(last, values(*state, until, p.lattice));
  return last;
}
double breather_error(int order, int space_order, int sites, int steps) {
  double error = 0;
  breather(order, space_order, sites, steps, &error);
  return error;
}

constexpr double k = 0.6, h = 0.3;

FamilyList pairs(int order, int p) { return {jet_family(pair_element(splitting_of_order(order), p), SineGordon{})}; }

}  // namespace

TEST_CASE("time is of the order of the composition, on a nonlinear problem") {
  // Against small steps over the same lattice: what space leaves is the same in both.
  const Row exact = breather(8, 12, 320, 640);
  for (const auto& [order, steps] : {std::pair{2, 100}, {4, 20}, {6, 14}, {8, 20}}) {
    const double coarse = distance(breather(order, 12, 320, steps), exact),
                 fine = distance(breather(order, 12, 320, 2 * steps), exact);
    const double found = testing::order(coarse, fine, 2);
    CAPTURE(order, coarse, fine, found);
    CHECK(found > order - 0.5);
    CHECK(found < order + 0.6);
  }
}

TEST_CASE("space is of twice the order of the widest pair, on a nonlinear problem") {
  for (int p = 1; p <= 6; ++p) {  // beyond, errors are lost in rounding
    const double found = testing::order(breather_error(8, 2 * p, 640, 200), breather_error(8, 2 * p, 800, 200), 1.25);
    CAPTURE(p, found);
    // The higher the order, the later it is reached.
    CHECK(found > 2 * p - 0.05 - 0.2 * p);
    CHECK(found < 2 * p + 0.1);
  }
}

TEST_CASE("time and space together are of order 2p, with h as k to the power p, p over 2, p over 3") {
  // An order q in time with h as k^(2p/q), so large that time has its share of the error.
  struct Pairing {
    int order, p, steps;
  };
  for (const auto& [order, p, steps] : {Pairing{2, 2, 120}, {2, 3, 400}, {4, 4, 22}, {4, 6, 40}, {6, 6, 15}}) {
    constexpr double finer = 4. / 3;
    const double coarse = breather_error(order, 2 * p, 480, steps);
    const auto found = [&, order = order, p = p, steps = steps](double power) {
      const int more = static_cast<int>(std::lround(std::pow(finer, power) * steps));
      return testing::order(coarse, breather_error(order, 2 * p, 640, more), finer);
    };
    const double together = found(2. * p / order);
    CAPTURE(order, p, together);
    // The higher the order, the later it is reached.
    CHECK(together > 2 * p - 0.05 - 0.17 * p);
    CHECK(together < 2 * p + 0.1);
    // With h as a lower power of k it is not.
    CHECK(found(2. * p / order - 0.6) < together - 0.2);
  }
}

TEST_CASE("compositions satisfy the form formula on random unions of steps, sub-steps and all") {
  std::mt19937_64 random(71);
  for (const auto& [order, p] : {std::array{2, 1}, {4, 1}, {4, 2}, {6, 3}}) {
    const FamilyList families = pairs(order, p);
    const int S = static_cast<int>(splitting_of_order(order).drifts.size());
    for (int trial = 0; trial < 3; ++trial) {
      Patch patch(Lattice::circle(14, 14 * k), families, h, random_centres(random, 11, S));
      REQUIRE(patch.U().regular());
      REQUIRE(!patch.on.equations().empty());
      patch.y = random_values(random, patch.on.nodes());
      auto pair = patch.variations(random);
      CAPTURE(order, p, patch.on.equations().size());
      CHECK(patch.form_formula(pair).relative() < 1e-13);
      // V is no first variation any more
      const auto node = patch.on.coupling_node(patch.y);
      REQUIRE(node);
      pair.V[*node] += 0.01;
      CHECK(patch.form_formula(pair).relative() > 1e-8);
    }
  }
}

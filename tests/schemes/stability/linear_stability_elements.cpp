// SPDX-License-Identifier: MIT
#include <cmath>
#include <string>
#include <vector>

#include "schemes/stability/linear_stability.hpp"
#include "schemes/stability/stable_set.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

LatticeSystem element(int degree_time, int degree_space, const char* quadrature, double k, double h, double mass) {
  Problem p;
  p.theory = "klein-gordon", p.method = "spacetime", p.parameters["scheme.quadrature"] = quadrature;
  p.parameters["scheme.degree_time"] = degree_time, p.parameters["scheme.degree_space"] = degree_space;
  p.lattice = Lattice::circle(4, 4 * k), p.time_step = h, p.parameters["theory.mass"] = mass;
  return Simulation(p).evolution().system();
}

/// The Galerkin integrator in time alone, z = ωh: sites so far apart that neighbours do not matter.
std::vector<StableInterval> in_time(int degree, const char* quadrature, double most, int samples) {
  return stable_set([&](double z) { return element(degree, 1, quadrature, 1e7, 1, z); }, 0, most,
                    {samples, 1e-8, 0, 3});
}

/// The massless field's Courant numbers: h over an element.
double first_limit(int degree_time, int degree_space, double most) {
  const auto set = stable_courants([&](double r) { return element(degree_time, degree_space, "lobatto", 1, r, 0); },
                                   most, {5, 1e-8, 0, 101});
  return set.empty() || set[0].from != 0 ? 0 : set[0].to;
}

/// ω_max times the element of Lobatto degree p, the largest root of its stiffness over its lumped mass.
constexpr double edge_1 = 2;
const double edge_2 = std::sqrt(24.);

}  // namespace

TEST_CASE("Galerkin in time: Gauss is always stable") {
  for (const int degree : {1, 2, 3}) {
    const auto set = in_time(degree, "gauss", 12, 120);
    CAPTURE(degree);
    REQUIRE(set.size() == 1);
    CHECK(set[0].from == 0);
    CHECK(set[0].to == 12);
  }
}

TEST_CASE(
    "Galerkin in time: Lobatto of 2, 3 and 4 nodes is stable below 2, the root of 8, 3.113, and again in windows") {
  const auto two = in_time(1, "lobatto", 6, 60);
  REQUIRE(two.size() == 1);
  CHECK(std::abs(two[0].to - 2) < 1e-6);

  const auto three = in_time(2, "lobatto", 6, 60);
  REQUIRE(three.size() == 2);
  CHECK(std::abs(three[0].to - std::sqrt(8.)) < 1e-6);
  CHECK(std::abs(three[1].from - std::sqrt(12.)) < 1e-6);
  CHECK(std::abs(three[1].to - std::sqrt(24.)) < 1e-6);
  CHECK_FALSE(linear_stability(element(2, 1, "lobatto", 1e7, 1, 3)).stable);

  const auto four = in_time(3, "lobatto", 5, 200);
  REQUIRE(four.size() == 2);
  CHECK(four[0].to == Approx(3.113).margin(5e-4));
  CHECK(std::abs(four[1].from - std::sqrt(10.)) < 1e-6);
}

TEST_CASE("elements: Lobatto in time is stable while dt omega_max is below its limit") {
  const double four_nodes = in_time(3, "lobatto", 3.15, 9)[0].to;
  for (const auto& [degree, edge] : {std::pair{1, edge_1}, {2, edge_2}}) {
    CAPTURE(degree);
    CHECK(std::abs(first_limit(1, degree, 3 / edge) - 2 / edge) < 1e-6);
    CHECK(std::abs(first_limit(2, degree, 3 / edge) - std::sqrt(8.) / edge) < 1e-6);
    CHECK(std::abs(first_limit(3, degree, 3.15 / edge) - four_nodes / edge) < 1e-6);
  }
  // Of higher degree the edges are known to three or four digits.
  for (const auto& [degree, edge] : {std::pair{3, 8.62}, {4, 13.54}, {6, 27.38}}) {
    CAPTURE(degree);
    CHECK(2 / first_limit(1, degree, 2.5 / edge) == Approx(edge).margin(6e-3));
  }
  CHECK(std::sqrt(8.) / first_limit(2, 3, 3.2 / 8.62) == Approx(8.62).margin(6e-3));
}

TEST_CASE("elements: Gauss in time is stable at any step tried, where nodes between the rows resonate too") {
  for (const double r : {0.1, 0.5, 1.5, 1.9, 2.3, 4.0})
    for (const int degree_time : {1, 2, 3}) {
      CAPTURE(r, degree_time);
      CHECK(linear_stability(element(degree_time, 1, "gauss", 1, r, 0.4), 0, 101).stable);
      CHECK(linear_stability(element(degree_time, 2, "gauss", 1, r, 0.4), 0, 101).stable);
    }
}

namespace {

/// The first limit in h/k of Lobatto's rule of S points in time over a space.
double first_limit_on(const char* space, int of_space, int S, double most) {
  const auto system = [&](double r) {
    Problem p;
    p.theory = "klein-gordon", p.method = "cgvi", p.lattice = Lattice::circle(8, 8), p.time_step = r;
    p.parameters["theory.mass"] = 0.0;
    p.parameters["scheme.functions"] = p.parameters["scheme.points"] = S;
    p.parameters["scheme.quadrature"] = "lobatto", p.parameters["scheme.space"] = space;
    if (of_space > 0) p.parameters["lattice.space_order"] = of_space;
    return Simulation(p).evolution().system();
  };
  const auto set = stable_courants(system, most, {5, 1e-8, 0, 101});
  return set.empty() || set[0].from != 0 ? 0 : set[0].to;
}

}  // namespace

TEST_CASE("elements in time on every space: Lobatto is stable while dt omega_max is below its limit") {
  struct Space {
    const char* name;
    int order;
    double edge;  // k ω_max, at θ = π
  };
  // lumped 2; consistent √12, of 4 over the mass ⅓; pairs of order 4: ω² = (4/3)·4 − (1/3)·0
  for (const Space& space :
       {Space{"lumped", 0, 2}, Space{"linear", 0, std::sqrt(12.)}, Space{"pairs", 4, std::sqrt(16. / 3)}})
    for (const auto& [S, z] : {std::pair{2, 2.}, {3, std::sqrt(8.)}, {4, 3.113}}) {
      const double found = first_limit_on(space.name, space.order, S, 1.05 * z / space.edge);
      CAPTURE(space.name, S, found);
      CHECK(found * space.edge == Approx(z).margin(S == 4 ? 1e-3 : 1e-6));
    }
}

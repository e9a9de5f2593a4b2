// SPDX-License-Identifier: MIT
#include "jets/tables/spacetime_element.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "jets/tables/rectangle_jet.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/r_adaptive.hpp"
#include "schemes/families/vertex_constraint.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/wave_map.hpp"
#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

// ---- the kink train: L = 3.9159…, v = 0.3, ε = 0.1, to T = 1.6

constexpr double length = 3.915909403018417, until = 1.6;

enum class ElementStart { legendre, exact };

struct Result {
  double vertices = 0, all = 0;  ///< largest error at t = T: at the vertices; also at the nodes between them
  std::vector<double> row;       ///< φ(T) at the vertices
};

Result run_elements(int cells, const std::string& quadrature, int degree_time, int degree_space,
                    ElementStart how = ElementStart::legendre) {
  Problem p;
  p.method = "spacetime", p.parameters["scheme.quadrature"] = quadrature,
  p.parameters["scheme.degree_time"] = degree_time, p.parameters["scheme.degree_space"] = degree_space;
  p.lattice = Lattice::circle(cells, length), p.time_step = until / (2 * cells);
  StateRequest request;
  request.name = "kink-train", request.theory = p.theory, request.values["initial.epsilon"] = 0.1,
  request.values["initial.speed"] = 0.3;
  request.values["initial.position"] = 0;
  const auto state = make_state(request, p.lattice);
  p.winding = state->winding();
  Simulation simulation(p);

  const std::size_t N = cells;
  const auto& components = simulation.components();
  const std::size_t C = components.size();
  const auto lattice_of = [&](const Component& c) { return p.lattice.shifted(c.at.space * p.lattice.space_step()); };
  const auto row_of = [&](int row, bool velocity) {
    std::vector<double> out(N * C), column(N);
    for (std::size_t c = 0; c < C; ++c) {
      const double t = (row + components[c].at.time) * p.time_step;
      if (velocity) column = velocities(*state, t, lattice_of(components[c]));
      else column = values(*state, t, lattice_of(components[c]));
      for (std::size_t i = 0; i < N; ++i) out[i * C + c] = column[i];
    }
    return out;
  };
  if (how == ElementStart::legendre) {
    simulation.start_legendre(row_of(0, false), row_of(0, true));
  } else {
    std::vector<std::vector<double>> rows;
    for (int j = 0; j < simulation.starting_rows(); ++j) rows.push_back(row_of(j, false));
    simulation.start(rows);
  }
  while (simulation.newest() < 2 * cells) simulation.step();

  Result result;
  result.row = newest(simulation, p.lattice);
  result.all = result.vertices = distance(result.row, values(*state, until, p.lattice));
  const std::size_t inner = simulation.count(Role::inner);
  std::vector<double> between(N * inner);
  simulation.copy_row(0, between, Role::inner);
  std::size_t n = 0;
  for (const Component& c : components) {
    if (c.role != Role::inner) continue;
    if (c.at.time == 0) {
      const Row exact = values(*state, until, lattice_of(c));
      for (std::size_t i = 0; i < N; ++i)
        result.all = std::max(result.all, std::abs(between[i * inner + n] - exact[i]));
    }
    ++n;
  }
  return result;
}

struct Reference {
  std::string quadrature;
  int cells;
  double vertices, all;
  std::array<double, 4> first;
};
const std::vector<Reference> references{{"lobatto",
                                         8,
                                         4.351679355059e-04,
                                         6.739385750310e-04,
                                         {2.067595969834, 3.163565504091, 4.254493439768, 5.130652628272}},
                                        {"lobatto",
                                         16,
                                         3.089083722463e-05,
                                         3.313516513170e-05,
                                         {2.067340791714, 2.599047063473, 3.163726239764, 3.726987030914}},
                                        {"gauss",
                                         8,
                                         4.341271494033e-04,
                                         6.723338674464e-04,
                                         {2.067595801300, 3.163569728300, 4.254494480554, 5.130649587698}},
                                        {"gauss",
                                         16,
                                         3.073906260420e-05,
                                         3.289008619145e-05,
                                         {2.067340838701, 2.599046911698, 3.163726167805, 3.726987282751}}};

double worst_difference(const Result& result, const Reference& reference) {
  double worst = 0;
  for (std::size_t i = 0; i < 4; ++i) worst = std::max(worst, std::abs(result.row[i] - reference.first[i]));
  return worst;
}

// ---- the form formula

constexpr double round_off = 1e-13, k = 0.6, h = 0.3;

const std::vector<std::array<int, 2>> degrees{{2, 2}, {1, 2}, {2, 3}};

FamilyList element_families(int degree_time, int degree_space, TimeQuadrature quadrature) {
  return {jet_family(spacetime_element(degree_time, degree_space, quadrature), SineGordon{})};
}
FamilyList wave_map_families() {
  return {jet_family(stencil_table(rectangle.table), WaveMap{}),
          std::make_shared<LagrangianFamily<VertexConstraint<WaveMap>>>(VertexConstraint<WaveMap>{})};
}
FamilyList r_adaptive_families() {
  return {std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
          std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{1.5})};
}

Patch filled(std::mt19937_64& random, Patch patch) {
  REQUIRE(patch.U().regular());
  REQUIRE(!patch.on.equations().empty());
  patch.y = random_values(random, patch.on.nodes());
  return patch;
}
Patch circle_patch(std::mt19937_64& random, const FamilyList& families, int nodes = 1) {
  return filled(random, Patch(Lattice::circle(12, 12 * k), families, h, random_centres(random, 9, nodes)));
}
Patch r_adaptive_patch(std::mt19937_64& random) {
  Patch patch =
      filled(random, Patch(Lattice::interval(12, 11 * k), r_adaptive_families(), h, random_centres(random, 3)));
  std::uniform_real_distribution<double> shift(-0.3 * k, 0.3 * k);
  for (std::size_t n = 0; n < patch.y.size(); ++n) {
    const Node node = patch.on.node(n);
    if (node.component == 1) patch.y[n] = k * node.site.space + shift(random);  // X ascends
  }
  return patch;
}

/// One of the equations is that of this component.
bool has_equation_of(const Patch& patch, int component) {
  return std::ranges::any_of(patch.on.equations(),
                             [&](std::size_t n) { return patch.on.node(n).component == component; });
}

double form_defect(std::mt19937_64& random, const Patch& patch) {
  return patch.form_formula(patch.variations(random)).relative();
}
/// With V wrong at one node of ∂U, which breaks the linearised equations.
double broken_defect(std::mt19937_64& random, const Patch& patch) {
  auto pair = patch.variations(random);
  const auto node = patch.on.coupling_node(patch.y);
  REQUIRE(node);
  pair.V[*node] += 0.01;
  return patch.form_formula(pair).relative();
}

}  // namespace

TEST_CASE("spacetime elements of degree 2, 2 agree with the reference runs of the kink train") {
  for (const Reference& reference : references) {
    const Result result = run_elements(reference.cells, reference.quadrature, 2, 2);
    CAPTURE(reference.quadrature, reference.cells, worst_difference(result, reference));
    CHECK(std::abs(result.vertices / reference.vertices - 1) < 1e-3);
    CHECK(std::abs(result.all / reference.all - 1) < 1e-3);
    CHECK(std::abs(result.vertices - reference.vertices) < 1e-10);
    CHECK(std::abs(result.all - reference.all) < 1e-10);
    CHECK(worst_difference(result, reference) < 1e-10);
  }
}

TEST_CASE("the reference runs tell the two quadratures and the two starts apart") {
  for (const Reference& reference : references) {
    const std::string other = reference.quadrature == "gauss" ? "lobatto" : "gauss";
    const Result swapped = run_elements(reference.cells, other, 2, 2);
    CAPTURE(reference.quadrature, reference.cells, swapped.vertices / reference.vertices,
            worst_difference(swapped, reference));
    CHECK(std::abs(swapped.vertices / reference.vertices - 1) > 1e-3);
    CHECK(worst_difference(swapped, reference) > 1e-8);
    const Result exact = run_elements(reference.cells, reference.quadrature, 2, 2, ElementStart::exact);
    CAPTURE(exact.vertices, exact.all);
    CHECK(worst_difference(exact, reference) > 1e-8);
  }
}

TEST_CASE("the order of spacetime elements is that of their degree") {
  for (const std::string quadrature : {"lobatto", "gauss"}) {
    const auto orders = [&](int degree_time, int degree_space, double Result::*error, ElementStart how) {
      std::array<double, 3> errors;
      for (std::size_t n = 0; n < 3; ++n)
        errors[n] = run_elements(8 << n, quadrature, degree_time, degree_space, how).*error;
      return std::array{order(errors[0], errors[1], 2), order(errors[1], errors[2], 2)};
    };
    const auto legendre = ElementStart::legendre;
    CAPTURE(quadrature);
    for (const double p : orders(2, 2, &Result::vertices, legendre)) CHECK((p > 3.8 && p < 4.3));
    for (const double p : orders(1, 1, &Result::vertices, legendre)) CHECK((p > 1.95 && p < 2.1));
    // 2 in time; its error is not yet the largest on these meshes, that of order 4 in space is
    for (const double p : orders(1, 2, &Result::all, legendre)) CHECK((p > 2.2 && p < 4.3));
    // so here too: 4 in time, 5 in space
    for (const double p : orders(2, 3, &Result::all, legendre)) CHECK((p > 4.7 && p < 5.1));
    // rows that are exact, inner nodes too, are not the element's own
    CHECK(orders(2, 2, &Result::vertices, ElementStart::exact)[1] < 3.6);
  }
}

TEST_CASE("elements satisfy the multisymplectic form formula on random unions of elements") {
  std::mt19937_64 random(31);
  for (const auto& [degree_time, degree_space] : degrees)
    for (const TimeQuadrature quadrature : {TimeQuadrature::lobatto, TimeQuadrature::gauss}) {
      const auto families = element_families(degree_time, degree_space, quadrature);
      for (int trial = 0; trial < 8; ++trial) {
        const Patch patch = circle_patch(random, families, degree_time * degree_space);
        CAPTURE(degree_time, degree_space, patch.U().sites().size(), patch.on.equations().size());
        CHECK(form_defect(random, patch) < round_off);
        CHECK(broken_defect(random, patch) > 1e-6);
      }
    }
}

TEST_CASE("elements satisfy the multisymplectic form formula on a slab of the circle") {
  std::mt19937_64 random(37);
  const Lattice lattice = Lattice::circle(8, 8 * k);
  for (const auto& [degree_time, degree_space] : degrees)
    for (const TimeQuadrature quadrature : {TimeQuadrature::lobatto, TimeQuadrature::gauss}) {
      const auto families = element_families(degree_time, degree_space, quadrature);
      std::vector<Site> middle;  // two rows of elements meet there
      for (int i = 0; i < lattice.sites(); ++i) middle.push_back({1, i});
      const Patch patch = filled(random, Patch(lattice, families, h, middle));
      CAPTURE(degree_time, degree_space, patch.U().sites().size(), patch.on.equations().size());
      // all nodes but those at the times 0 and 2
      CHECK(patch.on.equations().size() == at(lattice.sites() * degree_space * (2 * degree_time - 1)));
      CHECK(patch.U().sites().size() == at(lattice.sites() * degree_space * (2 * degree_time + 1)));
      CHECK(form_defect(random, patch) < round_off);
      CHECK(broken_defect(random, patch) > 1e-6);
    }
}

TEST_CASE("the moving mesh with its arclength multiplier satisfies the multisymplectic form formula") {
  std::mt19937_64 random(41);
  for (int trial = 0; trial < 20; ++trial) {
    const Patch patch = r_adaptive_patch(random);
    CAPTURE(trial, patch.U().sites().size(), patch.on.equations().size());
    CHECK(has_equation_of(patch, 2));
    CHECK(form_defect(random, patch) < round_off);
    CHECK(broken_defect(random, patch) > 1e-6);
  }
}

TEST_CASE("the wave map with its multiplier satisfies the multisymplectic form formula") {
  std::mt19937_64 random(43);
  for (int trial = 0; trial < 20; ++trial) {
    const Patch patch = circle_patch(random, wave_map_families());
    CAPTURE(trial, patch.U().sites().size(), patch.on.equations().size());
    CHECK(has_equation_of(patch, 3));
    CHECK(form_defect(random, patch) < round_off);
    CHECK(broken_defect(random, patch) > 1e-6);
  }
}

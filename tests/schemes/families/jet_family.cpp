// SPDX-License-Identifier: MIT
#include "schemes/families/jet_family.hpp"

#include <cmath>
#include <string>

#include "jets/discrete_lagrangian.hpp"
#include "jets/tables/named_tables.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/spacetime_element.hpp"
#include "schemes/scheme.hpp"
#include "schemes/theories/coupled_sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/schemes/families/family_batch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3, t = 1.4;
constexpr Cell cell{h, k, t, 0};

/// Of a family from what its discrete Lagrangian gives by dual numbers, stencil by stencil: relative to the largest.
struct Defects {
  double lagrangian = 0, residual = 0, jacobian = 0;
};
template <class Map, class D>
Defects against_duals(Map map, const D& density, int count) {
  const auto exact = discrete_lagrangian(map, density);
  constexpr std::size_t n = decltype(exact)::size;
  const auto family = jet_family(stencil_table(map.table), density);
  Random random(61);
  const FamilyBatch stencils(*family, cell, count, random);
  const auto L = stencils.rows(1, [&](double* out) { CHECK(family->lagrangian(stencils.batch(), out)); });
  const auto r = stencils.residuals();
  std::vector<int> all(n);
  std::iota(all.begin(), all.end(), 0);
  const auto J = stencils.jacobians(all, all);
  Defects worst, largest;
  const auto compare = [](double a, double b, double& off, double& size) {
    if (!(std::abs(a - b) <= off)) off = std::abs(a - b);
    size = std::max(size, std::abs(b));
  };
  for (int s = 0; s < count; ++s) {
    const std::size_t at = s;
    std::array<double, n> y;
    std::ranges::copy(stencils.y(s), y.begin());
    const auto gradient = exact.gradient(y, stencils.cell(s));
    const auto hessian = exact.hessian(y, stencils.cell(s));
    compare(L[0][at], exact(y, stencils.cell(s)), worst.lagrangian, largest.lagrangian);
    for (std::size_t i = 0; i < n; ++i) compare(r[i][at], gradient[i], worst.residual, largest.residual);
    for (std::size_t e = 0; e < n * n; ++e) compare(J[e][at], hessian[e], worst.jacobian, largest.jacobian);
  }
  return {worst.lagrangian / largest.lagrangian, worst.residual / largest.residual, worst.jacobian / largest.jacobian};
}

double split_defect(const StencilFamily& family, double factor = 1) {
  Random random(62);
  return FamilyBatch(family, cell, 3 * lanes, random).split_defect(factor);
}
double split_jacobian_defect(const StencilFamily& family) {
  Random random(63);
  return FamilyBatch(family, cell, 3 * lanes, random).split_jacobian_defect();
}

/// −√(1 − φ_t² + φ_x²), here with jets below 1
struct BornInfeld {
  auto operator()(const auto& j) const {
    return -sqrt(1.0 - 0.001 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x)) - cos(j.phi);
  }
};
/// Terms of the first degree in the derivatives, and a force: r(0) ≠ 0.
struct Pushed {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + 0.3 * j.phi_t * j.phi - 0.7 * j.phi_x + 2.0 * j.phi;
  }
};
struct Pair {
  static constexpr int components = 2;
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    return j.phi_t[0] * j.phi_t[1] - 0.5 * j.phi_x[0] * j.phi_x[0] + sin(j.x + j.t) * cos(j.phi[0] - 2.0 * j.phi[1]);
  }
};
/// A beam: ½φ_t² − ½φ_xx² − ¼φ⁴, and a term that couples φ_tt and φ_tx.
struct Beam {
  static constexpr int jet_order = 2;
  double mixed = 0;
  auto operator()(const auto& j) const {
    const auto square = j.phi * j.phi;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_xx * j.phi_xx) - 0.25 * (square * square) + mixed * (j.phi_tt * j.phi_tx);
  }
};
/// Eighteen numbers: six bodies in space, each attracted by the next.
struct Bodies {
  static constexpr int components = 18;
  auto operator()(const auto& j) const {
    auto sum = 0.5 * (j.phi_t[0] * j.phi_t[0]);
    for (std::size_t a = 1; a < 18; ++a) sum += (0.5 + 0.1 * static_cast<double>(a)) * (j.phi_t[a] * j.phi_t[a]);
    for (std::size_t b = 0; b < 6; ++b) {
      auto square = 0.1 + 0.0 * j.phi[0];
      for (std::size_t i = 0; i < 3; ++i) {
        const auto apart = j.phi[3 * b + i] - j.phi[(3 * b + 3 + i) % 18];
        square += apart * apart;
      }
      sum += 1.0 / sqrt(square);
    }
    return sum;
  }
};

/// The nine sites around one, with all second derivatives in the middle.
StencilTable second_order_table() {
  StencilTable table{.pattern = StencilPattern(shapes::nine_tuple), .points = {}};
  TablePoint point;
  // Vertices row by row, from below and from the left.
  point.set(JetSlot::phi, {0, 0, 0, 0, 1, 0, 0, 0, 0});
  point.set(JetSlot::phi_t, {0, -.5, 0, 0, 0, 0, 0, .5, 0});
  point.set(JetSlot::phi_x, {0, 0, 0, -.5, 0, .5, 0, 0, 0});
  point.set(JetSlot::phi_tt, {0, 1, 0, 0, -2, 0, 0, 1, 0});
  point.set(JetSlot::phi_tx, {.25, 0, -.25, 0, 0, 0, -.25, 0, .25});
  point.set(JetSlot::phi_xx, {0, 0, 0, 1, -2, 1, 0, 0, 0});
  table.points.push_back(point);
  return table;
}

/// The largest differences of residual and Jacobian to central differences of L and r, relative to the largest.
Defects against_differences(const StencilFamily& family, int count, double e = 1e-3) {
  Random random(64);
  const FamilyBatch stencils(family, cell, lanes, random, 0.5);
  const std::size_t n = family.size();
  Defects worst, largest;
  for (int s = 0; s < count; ++s) {
    std::vector<double> y = stencils.y(s), r(n), J(n * n), moved(n);
    const Cell at = stencils.cell(s);
    family.residual(at, y, r);
    family.jacobian(at, y, J);
    for (std::size_t j = 0; j < n; ++j) {
      double slope = 0;
      std::vector<double> by_y(n, 0.0);
      for (const auto& [step, weight] : {std::pair{1, 8.0}, {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
        std::vector<double> to = y;
        to[j] += step * e;
        slope += weight / (12 * e) * *family.lagrangian(at, to);
        family.residual(at, to, moved);
        for (std::size_t i = 0; i < n; ++i) by_y[i] += weight / (12 * e) * moved[i];
      }
      worst.residual = std::max(worst.residual, std::abs(r[j] - slope));
      largest.residual = std::max(largest.residual, std::abs(r[j]));
      for (std::size_t i = 0; i < n; ++i) {
        worst.jacobian = std::max(worst.jacobian, std::abs(J[i * n + j] - by_y[i]));
        largest.jacobian = std::max(largest.jacobian, std::abs(J[i * n + j]));
      }
    }
  }
  return {0, worst.residual / largest.residual, worst.jacobian / largest.jacobian};
}

}  // namespace

TEST_CASE("L, residual and Jacobian of a batch are those of the discrete Lagrangian, for every theory and table") {
  for_each_theory([](const auto& theory) {
    for_each_map([&](auto map) {
      const Defects worst = against_duals(map, theory, 2 * lanes);
      CHECK(worst.lagrangian < 3e-15);
      CHECK(worst.residual < 3e-15);
      CHECK(worst.jacobian < 3e-15);
    });
  });
}

TEST_CASE("so they are in large batches, for densities nonlinear in derivatives, with forces, of two components") {
  const auto agree = [](const Defects& worst) {
    CHECK(worst.lagrangian < 3e-15);
    CHECK(worst.residual < 3e-15);
    CHECK(worst.jacobian < 3e-15);
  };
  for (int count : {lanes, 16 * lanes, 17 * lanes, 50 * lanes}) {
    CAPTURE(count);
    agree(against_duals(rectangle, SineGordon{1.3}, count));
    agree(against_duals(hexagon, BornInfeld{}, count));
    agree(against_duals(rectangle, Pushed{}, count));
    agree(against_duals(rectangle_symmetric, Pair{}, count));
    agree(against_duals(triangle, CoupledSineGordon{}, count));
  }
}

TEST_CASE("some equations and unknowns have the entries of the whole Jacobian") {
  Random random(65);
  for (const char* theory : {"sine-gordon", "coupled-sine-gordon"})
    for (const NamedTable& named : named_tables()) {
      const auto family = family_of(problem_of(theory), named.name);
      CAPTURE(theory, named.name);
      const FamilyBatch stencils(*family, cell, 2 * lanes, random);
      const int n = family->size();
      std::vector<int> all(n);
      std::iota(all.begin(), all.end(), 0);
      const std::vector<int> equations{n - 1, 0}, unknowns{n / 2, n - 1, 0};
      const auto whole = stencils.jacobians(all, all), some = stencils.jacobians(equations, unknowns);
      for (std::size_t e = 0; e < equations.size(); ++e)
        for (std::size_t u = 0; u < unknowns.size(); ++u)
          CHECK(some[e * unknowns.size() + u] == whole[equations[e] * n + unknowns[u]]);
    }
}

TEST_CASE("the residual is its constant part and its source terms, for every theory and table") {
  for (const TheoryEntry* entry : theory_entries())
    for (const NamedTable& named : named_tables()) {
      const auto family = family_of(problem_of(entry->name), named.name);
      CAPTURE(entry->name, named.name);
      if (!family->sources()) continue;  // nonlinear in more than φ
      CHECK(split_defect(*family) < 3e-15);
      CHECK(split_jacobian_defect(*family) < 3e-15);
      const auto part = family->constant_part(cell);
      CHECK(part->is_all == family->sources()->groups.empty());
      // of other source terms; those of the planets are small, with G and their masses
      const double found = family->values().size() > 30 ? 1e-11 : 1e-6;
      if (!part->is_all) CHECK(split_defect(*family, 1.001) > found);
    }
}

TEST_CASE("so it is for elements, and for the sub-steps of a composition") {
  for (const StencilTable& table :
       {spacetime_element(2, 2, TimeQuadrature::gauss), spacetime_element(1, 3, TimeQuadrature::lobatto),
        pair_element(splitting_of_order(4), 2)})
    for (const char* theory : {"sine-gordon", "sine-gordon-impurity", "phi4", "complex-klein-gordon"}) {
      const auto family = theory_named(problem_of(theory))->on_table(table);
      CAPTURE(theory, table.points.size());
      CHECK(split_defect(*family) < 1e-14);
      CHECK(split_jacobian_defect(*family) < 1e-14);
    }
}

TEST_CASE("a density of a user is split alike, and one that is nonlinear in a derivative is not") {
  CHECK(split_defect(*jet_family(stencil_table(rectangle.table), Pushed{})) < 3e-15);
  CHECK(split_defect(*jet_family(stencil_table(six_tuple.table), Pair{})) < 3e-15);
  CHECK(split_jacobian_defect(*jet_family(stencil_table(six_tuple.table), Pair{})) < 3e-15);
  CHECK(jet_family(stencil_table(hexagon.table), BornInfeld{})->sources() == nullptr);
  const auto forced = jet_family(stencil_table(rectangle.table), Pushed{})->constant_part(cell);
  CHECK(forced->is_all);
  CHECK(std::ranges::any_of(forced->r0, [](double r) { return r != 0; }));
}

TEST_CASE("source terms are as few as the density allows") {
  const auto groups = [](const std::string& theory, const std::string& stencil) {
    return family_of(problem_of(theory), stencil)->sources()->groups.size();
  };
  CHECK(groups("wave", "hexagon") == 0);
  CHECK(groups("klein-gordon", "hexagon") == 0);
  CHECK(groups("sine-gordon", "hexagon") == 1);  // four points with one φ
  CHECK(groups("sine-gordon", "rectangle") == 1);
  CHECK(groups("sine-gordon", "nine-tuple") == 4);
  CHECK(family_of(problem_of("coupled-sine-gordon"), "nine-tuple")->sources()->outputs() == 8);
  CHECK(family_of(problem_of("sine-gordon"), "rectangle")->sources()->groups[0].latest_time() == 1);
  CHECK(family_of(problem_of("sine-gordon"), "triangle-vertex")->sources()->groups[0].latest_time() == 0);
}

TEST_CASE("a family says whether it has a Lagrangian, and whether it depends on its place") {
  CHECK(family_of(problem_of("sine-gordon"), "hexagon")->is_variational());
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "guo")->is_variational());
  CHECK(family_of(problem_of("sine-gordon-impurity"), "triangle")->is_placed());
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "triangle")->is_placed());
  CHECK_FALSE(family_of(problem_of("sine-gordon-impurity"), "guo"));
  CHECK_FALSE(family_of(problem_of("sine-gordon"), "pentagon"));
}

TEST_CASE("a density of second derivatives has the residual and Jacobian of its Lagrangian, and is split") {
  const StencilTable table = second_order_table();
  REQUIRE(is_consistent(table));
  for (double mixed : {0.0, 0.3}) {
    const auto family = jet_family(table, Beam{mixed});
    const Defects worst = against_differences(*family, 3, 0.05);  // L is a polynomial of degree 4
    CHECK(worst.residual < 1e-12);
    CHECK(worst.jacobian < 1e-12);
    CHECK(split_defect(*family) < 3e-15);
    CHECK(split_jacobian_defect(*family) < 3e-15);
  }
  // By hand, of one site's wave of φ_xx: y = x² is φ_xx = 2, L = hk(−2 − ¼φ⁴) around φ = 0.
  const auto family = jet_family(table, Beam{});
  std::vector<double> y;
  for (const Site& v : table.pattern.vertices) y.push_back(k * k * v.space * v.space);
  CHECK(*family->lagrangian(cell, y) == Approx(-2 * h * k).epsilon(1e-13));
}

TEST_CASE("a beam is stepped: its equation is φ_tt + φ_xxxx + φ³ = 0") {
  // y = a cos ωt cos κx of the linear beam: a small enough for φ³ not to matter.
  const int N = 64;
  const double length = 2 * std::numbers::pi, step = 2e-3, dx = length / N, kappa = 2;
  auto evolution = Scheme{second_order_table(), Beam{}}.on(Lattice::circle(N, length), step);
  Stepper& stepper = evolution.stepper();
  const double by_x = 2 * (1 - std::cos(kappa * dx)) / (dx * dx);
  // The table's φ_t is over two steps: (2 sin(ωh)/2h)² = (second difference)²
  const double omega = std::asin(step * by_x) / step;
  std::vector<Row> rows;
  for (int j = 0; j < stepper.starting_rows(); ++j) {
    rows.emplace_back();
    for (int i = 0; i < N; ++i) rows.back().push_back(1e-6 * std::cos(omega * j * step) * std::cos(kappa * i * dx));
  }
  stepper.start(rows);
  for (int n = 0; n < 50; ++n) stepper.step();
  double worst = 0;
  const Row last = stepper.row(0);
  for (int i = 0; i < N; ++i)
    worst = std::max(worst, std::abs(last[i] - 1e-6 * std::cos(omega * static_cast<double>(stepper.newest()) * step) *
                                                   std::cos(kappa * i * dx)));
  CHECK(worst < 1e-12);
}

TEST_CASE("eighteen components have the residual and Jacobian of their Lagrangian, and are split") {
  const auto midpoint_table = std::ranges::find(named_tables(), "midpoint", &NamedTable::name)->table;
  const auto family = jet_family(midpoint_table, Bodies{});
  CHECK(family->size() == 36);
  const Defects worst = against_differences(*family, 2);
  CHECK(worst.residual < 1e-9);
  CHECK(worst.jacobian < 1e-9);
  CHECK(split_defect(*family) < 3e-15);
  CHECK(split_jacobian_defect(*family) < 3e-15);
}

TEST_CASE("the comparisons can fail: another step") {
  Random random(66);
  const auto family = jet_family(stencil_table(rectangle.table), SineGordon{1.2});
  const auto part = family->constant_part(cell);
  const auto other = family->constant_part({1.1 * h, k, t, 0});
  CHECK(distance(part->J, other->J) > 1e-3);
  const auto symmetric = jet_family(stencil_table(rectangle_symmetric.table), SineGordon{1.2});
  CHECK(distance(part->J, symmetric->constant_part(cell)->J) > 1e-3);
}

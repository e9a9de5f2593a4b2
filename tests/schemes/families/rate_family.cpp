// SPDX-License-Identifier: MIT
#include "schemes/families/rate_family.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/families/equidistribution.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/families/family_batch.hpp"

using namespace delf;
using delf::testing::FamilyBatch;
using delf::testing::Random;

namespace {

constexpr Cell cell{0.7, 1.3, 0.4, -0.2};

Equidistribution constraint(MeshMonitor::Kind kind) { return {1, {.kind = kind, .alpha = 1.7, .beta = 0.3}}; }

/// Differences of the family's own L̇ and residual, and Σ ẏ ∂L/∂y of the Lagrangian's family.
struct Defects {
  double value = 0, residual = 0, jacobian = 0;
};
Defects defects_of(const Equidistribution& L, double factor = 1) {
  const RateFamily<Equidistribution> family(L);
  const LagrangianFamily<Equidistribution> of(L);
  const std::size_t n = family.size(), m = n / 2;
  Random random(3);
  std::vector<double> y(n), r(n), J(n * n), slope(m), above(n), below(n);
  for (double& v : y) v = random(-1, 1);
  // X in order, and cells of some width
  for (std::size_t l = 0; l < 3; ++l) y[l == 2 ? 6 : 2 * l + 1] = 0.8 * static_cast<double>(l) + 0.1 * y[l];
  family.residual(cell, y, r), family.jacobian(cell, y, J);
  of.residual(cell, std::vector<double>(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(m)), slope);
  Defects worst;
  double along = 0;
  for (std::size_t i = 0; i < m; ++i) along += factor * y[m + i] * slope[i];
  worst.value = std::abs(*family.lagrangian(cell, y) - along);
  constexpr double e = 1e-4;
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<double> up = y, down = y;
    up[j] += e, down[j] -= e;
    const double by_L = (*family.lagrangian(cell, up) - *family.lagrangian(cell, down)) / (2 * e);
    worst.residual = std::max(worst.residual, std::abs(factor * r[j] - by_L));
    family.residual(cell, up, above), family.residual(cell, down, below);
    for (std::size_t i = 0; i < n; ++i)
      worst.jacobian = std::max(worst.jacobian, std::abs(factor * J[i * n + j] - (above[i] - below[i]) / (2 * e)));
  }
  return worst;
}

}  // namespace

TEST_CASE("the rate of a constraint along a motion has the derivatives of its own value", "[rate]") {
  for (const auto kind : {MeshMonitor::Kind::arclength, MeshMonitor::Kind::saturated, MeshMonitor::Kind::uniform}) {
    const Defects defects = defects_of(constraint(kind));
    CHECK(defects.value < 1e-13);
    CHECK(defects.residual < 1e-6);
    CHECK(defects.jacobian < 1e-6);
  }
}

TEST_CASE("and the check sees a thousandth of them", "[rate]") {
  const Defects defects = defects_of(constraint(MeshMonitor::Kind::arclength), 1.001);
  CHECK(defects.value > 1e-5);
  CHECK(defects.residual > 1e-4);
  CHECK(defects.jacobian > 1e-4);
}

TEST_CASE("a rate's batches take any equations and unknowns", "[rate]") {
  Random random(5);
  const RateFamily<Equidistribution> family(constraint(MeshMonitor::Kind::saturated));
  const FamilyBatch batch(family, cell, 2 * lanes, random);
  const std::vector<int> equations{4, 9, 11, 0}, unknowns{12, 3, 4, 13, 7};
  const auto r = batch.rows(equations.size(), [&](double* out) { family.residual(batch.batch(), equations, out); });
  const auto one = batch.rows(1, [&](double* out) { family.residual(batch.batch(), std::vector<int>{4}, out); });
  const auto J = batch.jacobians(equations, unknowns);
  for (int s = 0; s < batch.count(); ++s) {
    const std::size_t at = s, n = delf::at(family.size());
    std::vector<double> all(n), every(n * n);
    family.residual(cell, batch.y(s), all), family.jacobian(cell, batch.y(s), every);
    CHECK(one[0][at] == Approx(all[4]));
    for (std::size_t e = 0; e < equations.size(); ++e) {
      const std::size_t equation = equations[e];
      CHECK(r[e][at] == Approx(all[equation]));
      for (std::size_t u = 0; u < unknowns.size(); ++u)
        CHECK(J[e * unknowns.size() + u][at] == Approx(every[equation * n + delf::at(unknowns[u])]));
    }
  }
}

TEST_CASE("what is constant of a constraint's slopes is constant of its rate's", "[rate]") {
  const auto part = RateFamily<Equidistribution>(constraint(MeshMonitor::Kind::uniform)).constant_part(cell);
  REQUIRE(part);
  CHECK(part->is_all);  // −μ (X_r − 2 X_c + X_l)
  const auto arclength = RateFamily<Equidistribution>(constraint(MeshMonitor::Kind::arclength)).constant_part(cell);
  REQUIRE(arclength);
  CHECK_FALSE(arclength->is_all);
  std::vector<double> y(14), J(14 * 14);
  Random random(7);
  for (double& v : y) v = random(-1, 1);
  RateFamily<Equidistribution>(constraint(MeshMonitor::Kind::uniform)).jacobian(cell, y, J);
  for (std::size_t i = 0; i < J.size(); ++i) CHECK(std::abs(J[i] - part->J[i]) < 1e-15);
}

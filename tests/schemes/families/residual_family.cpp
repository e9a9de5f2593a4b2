// SPDX-License-Identifier: MIT
#include "schemes/families/residual_family.hpp"

#include "lattice/index.hpp"
#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/theories/phi4.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/families/family_batch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.2, k = 0.3;
constexpr Cell cell{h, k, 0, 0};
constexpr int N = 19;

template <class D>
ResidualFamily family_for(const DirectResidual& stencil, const D& density) {
  return {stencil, std::make_shared<BatchOf<D>>(density)};
}

/// N(φ) = −¼(φ¹² + φ²²)² − φ¹φ², whose difference quotients are taken one component after the other:
/// Q₁ = (N(a₁, b₂) − N(b₁, b₂))/(a₁ − b₁), Q₂ = (N(a₁, a₂) − N(a₁, b₂))/(a₂ − b₂).
struct Pair {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    const auto r = j.phi[0] * j.phi[0] + j.phi[1] * j.phi[1];
    return 0.5 *
               (j.phi_t[0] * j.phi_t[0] + j.phi_t[1] * j.phi_t[1] - j.phi_x[0] * j.phi_x[0] - j.phi_x[1] * j.phi_x[1]) -
           0.25 * (r * r) - j.phi[0] * j.phi[1];
  }
  /// (u² − v²)/(a − b) for u = a² + c², v = b² + c² is (u + v)(a + b).
  template <class T>
  std::array<T, 2> difference_quotient(const std::array<T, 2>& a, const std::array<T, 2>& b) const {
    const T u = a[0] * a[0] + b[1] * b[1], v = b[0] * b[0] + b[1] * b[1], w = a[0] * a[0] + a[1] * a[1];
    return {-0.25 * ((u + v) * (a[0] + b[0])) - b[1], -0.25 * ((w + u) * (a[1] + b[1])) - a[0]};
  }
};

struct NoQuotient {
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) + cosm1(j.phi); }
};

/// (5.14), (5.15) and leapfrog with friction by hand, E of component a at the vertex of the centre.
double by_hand(const DirectResidual& stencil, int d, int a, const std::vector<double>& y, const auto& quotient) {
  double E = 0;
  for (int l = 0; l < stencil.pattern.size(); ++l) {
    const std::size_t at = l;
    E += (stencil.by_xx[at] / (k * k) - stencil.by_tt[at] / (h * h)) * y[l * d + a];
    if (!stencil.by_t.empty()) E += stencil.by_t[at] / h * y[l * d + a];
  }
  for (const auto& q : stencil.quotients) {
    const auto values = [&](int l) { return std::span(y).subspan(delf::at(l * d), delf::at(d)); };
    E += q.weight * quotient(values(q.above), values(q.below));
  }
  return h * k * E;
}

/// The largest difference between E of (5.14) at the rows of four, and its constant part with what stencils centred there
/// and a row below share; `of_below` times the latter.
template <class D>
double shared_defect(const D& density, double of_below) {
  constexpr int d = components_of<D>();
  const DirectResidual stencil = vu_quoc_li();
  const ResidualFamily family = family_for(stencil, density);
  const Lattice ring = Lattice::circle(N, N * k);
  Random random(7);
  std::vector<Row> y;
  for (int r = 0; r < 4; ++r) y.push_back(random_row(random, N * d, 2));
  const SourceTerms& terms = *family.sources();
  REQUIRE(terms.groups.size() == 1);
  // Q of the stencil that is centred at site i of row r.
  const auto sources = [&](int r, int i) {
    std::vector<Pack> in(2 * d), out(delf::at(d));
    std::vector<const double*> from;
    std::vector<double*> to;
    for (std::size_t j = 0; j < in.size(); ++j) {
      double m = 0;
      for (const auto& part : terms.groups[0].inputs[j])
        m += part.weight * y[r + part.vertex.time][delf::at(ring.wrapped(i + part.vertex.space) * d + part.component)];
      in[j] = Pack(m);
      from.push_back(reinterpret_cast<double*>(&in[j]));
    }
    for (Pack& o : out) to.push_back(reinterpret_cast<double*>(&o));
    family.evaluate_sources(0, {lanes, from.data()}, to.data());
    std::vector<double> q;
    for (const Pack& o : out) q.push_back(o[0]);
    return q;
  };
  const auto part = family.constant_part(cell);
  double worst = 0;
  const int size = family.size();
  for (int i = 0; i < N; ++i) {
    std::vector<double> values, r(delf::at(size));
    for (const Site& v : stencil.pattern.vertices)
      for (int a = 0; a < d; ++a) values.push_back(y[2 + v.time][ring.wrapped(i + v.space) * d + a]);
    family.residual(cell, values, r);
    const auto here = sources(2, i), below = sources(1, i);
    for (int a = 0; a < d; ++a) {
      const int row = stencil.centre * d + a;
      double sum = part->r0[row];
      for (int l = 0; l < size; ++l) sum += part->J[row * size + l] * values[l];
      for (int c = 0; c < d; ++c)
        sum += h * k * (terms.weight(c, 4 * d + a) * here[c] + of_below * terms.weight(c, 7 * d + a) * below[c]);
      worst = std::max(worst, std::abs(sum - r[row]));
    }
  }
  return worst;
}

}  // namespace

TEST_CASE("comparators are their printed equations times hk, at the centre alone") {
  const double m2 = 1.69;
  const auto quotient = [&](std::span<const double> a, std::span<const double> b) {
    if (a[0] == b[0]) return -m2 * std::sin(a[0]);
    return m2 * (std::cos(a[0]) - std::cos(b[0])) / (a[0] - b[0]);
  };
  Random random(8);
  for (const DirectResidual& stencil : {vu_quoc_li(), guo(), damped_leapfrog(0.3)}) {
    const ResidualFamily family = family_for(stencil, SineGordon{1.3});
    const FamilyBatch stencils(family, cell, 3 * lanes, random);
    const auto r = stencils.residuals();
    for (int s = 0; s < stencils.count(); ++s)
      for (int i = 0; i < family.size(); ++i) {
        const double expected = i == stencil.centre ? by_hand(stencil, 1, 0, stencils.y(s), quotient) : 0;
        CHECK(std::abs(r[i][s] - expected) < 1e-14);
      }
  }
}

TEST_CASE("the residual is its constant part and its source terms where these are not shared, and its Jacobian too") {
  Random random(9);
  for (const DirectResidual& stencil : {guo(), damped_leapfrog(0.3)}) {
    const auto check = [&](const ResidualFamily& family) {
      const FamilyBatch stencils(family, cell, 3 * lanes, random);
      CHECK(stencils.split_defect() < 3e-15);
      CHECK(stencils.split_jacobian_defect() < 3e-15);
      CHECK(stencils.split_defect(1.001) > 1e-7);
    };
    check(family_for(stencil, SineGordon{1.3}));
    check(family_for(stencil, PhiFour{}));
    check(family_for(stencil, Pair{}));
  }
}

TEST_CASE("(5.14) is its linear part and the halves of one quotient that two rows share") {
  CHECK(shared_defect(SineGordon{1.3}, 1) < 2e-15);
  CHECK(shared_defect(PhiFour{}, 1) < 2e-15);
  CHECK(shared_defect(Pair{}, 1) < 4e-15);
  for (double of_below : {0.0, -1.0, 0.99}) CHECK(shared_defect(SineGordon{1.3}, of_below) > 1e-5);
}

TEST_CASE("no vertex but these two has a share of it") {
  const ResidualFamily family = family_for(vu_quoc_li(), SineGordon{1});
  for (int l = 0; l < 9; ++l) CHECK(family.sources()->weight(0, l) == (l == 4 || l == 7 ? 0.5 : 0));
  CHECK(family.sources()->groups[0].latest_time() == 1);
}

TEST_CASE("the Jacobian is the derivative of the residual, with two components that a quotient couples too") {
  Random random(10);
  for (const DirectResidual& stencil : {vu_quoc_li(), guo(), damped_leapfrog()}) {
    const ResidualFamily family = family_for(stencil, Pair{});
    const std::size_t n = family.size();
    std::vector<double> y(n), J(n * n), r(n);
    for (double& value : y) value = random(-1, 1);
    family.jacobian(cell, y, J);
    double worst = 0;
    for (std::size_t j = 0; j < n; ++j) {
      std::vector<double> slope(n, 0.0);
      for (const auto& [step, weight] : {std::pair{1, 8.0}, {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
        std::vector<double> to = y;
        to[j] += step * 0.25;  // exact: a polynomial of degree 3
        family.residual(cell, to, r);
        for (std::size_t i = 0; i < n; ++i) slope[i] += weight / 3 * r[i];
      }
      for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(slope[i] - J[i * n + j]));
    }
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("two components whose comparators couple them are stepped, and a density without a quotient is refused") {
  for (const DirectResidual& stencil : {vu_quoc_li(), guo()}) {
    Evolution evolution(Lattice::circle(32, 32 * k), {std::make_shared<ResidualFamily>(family_for(stencil, Pair{}))},
                        h / 2, {}, fields(2));
    Stepper& stepper = evolution.stepper();
    Random random(11);
    stepper.start(random_rows(random, stepper.starting_rows(), 64, 0.5));
    for (int n = 0; n < 4; ++n) {
      stepper.step();
      CHECK(equation_defect(evolution, window_of(evolution)) < 3e-15);
      CHECK(stepper.residual() < 1e-14);
    }
  }
  CHECK_THROWS_AS(family_for(guo(), NoQuotient{}), BadInput);
}

TEST_CASE("comparators of a linear theory are their constant part, and are solved at once") {
  Random random(21);
  for (const DirectResidual& stencil : {vu_quoc_li(), guo(), damped_leapfrog(0.3)}) {
    const ResidualFamily family = family_for(stencil, KleinGordon{1.7}), sine = family_for(stencil, SineGordon{1.7});
    CHECK(family.sources()->groups.empty());
    CHECK_FALSE(sine.sources()->groups.empty());
    const auto part = family.constant_part(cell);
    REQUIRE(part);
    CHECK(part->is_all);
    CHECK_FALSE(sine.constant_part(cell)->is_all);
    const std::size_t size = delf::at(family.size());
    std::vector<double> r(size);
    const Row y = random_row(random, family.size(), 2);
    family.residual(cell, y, r);
    for (std::size_t i = 0; i < size; ++i) {
      double sum = part->r0[i];
      for (std::size_t m = 0; m < size; ++m) sum += part->J[i * size + m] * y[m];
      CHECK(std::abs(sum - r[i]) < 1e-14);
    }
  }
  // mh = 1.5 at Courant 1.5: too stiff for a fixed point, and there is none to find
  Problem p = problem_of("klein-gordon");
  p.parameters["theory.mass"] = 1.5;
  Evolution evolution = evolution_of(p, "guo", Lattice::circle(N, N / 1.5), 1.0);
  evolution.stepper().start({random_row(random, N, 1), random_row(random, N, 1)});
  evolution.stepper().step();
  CHECK(evolution.stepper().iterations() == 0);
}

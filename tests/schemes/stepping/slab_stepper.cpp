// SPDX-License-Identifier: MIT
#include "schemes/stepping/slab_stepper.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "jets/tables/spacetime_element.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/theories/klein_gordon.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/sine_gordon_impurity.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Family = std::shared_ptr<const StencilFamily>;

/// A family whose stencils are taken one by one, and whose Jacobians may be wrong by a factor: of the one that Newton's
/// method takes, and of the constant part. Without the latter every step is Newton's.
class Altered final : public StencilFamily {
 public:
  Altered(Family family, double jacobian, double constant)
      : StencilFamily(family->pattern(), family->values(), true),
        family_(std::move(family)),
        jacobian_(jacobian),
        constant_(constant) {}
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    family_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    family_->jacobian(cell, y, J);
    for (double& entry : J) entry *= jacobian_;
  }
  std::optional<ConstantPart> constant_part(const Cell& cell) const override {
    if (constant_ == 0) return std::nullopt;
    auto part = family_->constant_part(cell);
    if (part)
      for (double& entry : part->J) entry *= constant_;
    return part;
  }

 private:
  Family family_;
  double jacobian_, constant_;
};

Family element_family(int degree_time, int degree_space, double mass = 1) {
  const StencilTable element = spacetime_element(degree_time, degree_space, TimeQuadrature::gauss);
  return jet_family(element, SineGordon{mass});
}
Family newton_alone(Family family) { return std::make_shared<Altered>(std::move(family), 1, 0); }

Evolution element_evolution(Family family, int degree_time, int degree_space, const Lattice& lattice, double h) {
  std::vector<Component> components = fields(1);
  const StencilTable element = spacetime_element(degree_time, degree_space, TimeQuadrature::gauss);
  for (std::size_t n = 1; n < element.nodes.size(); ++n)
    components.push_back({"node " + std::to_string(n), Role::inner, element.nodes[n]});
  return {lattice, {std::move(family)}, h, {}, std::move(components)};
}

/// Rows of a wave of amplitude 2.5 and some more, at the nodes of every cell.
void start_wave(Evolution& evolution) {
  const LatticeSystem& system = evolution.system();
  const double k = system.lattice().space_step(), h = system.time_step();
  const double w = 2 * std::numbers::pi / system.lattice().length();
  std::vector<Row> rows(evolution.stepper().starting_rows());
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (int i = 0; i < system.lattice().sites(); ++i)
      for (const Component& c : system.all_components()) {
        const double t = (static_cast<double>(j) + c.at.time) * h, x = (i + c.at.space) * k;
        rows[j].push_back(2.5 * std::sin(w * (x - t)) + 0.5 * std::cos(3 * w * x + t));
      }
  evolution.stepper().start(rows);
}

struct Run {
  std::vector<Row> rows;  ///< as far as steps were made
  int iterations = 0;
  bool reported = false;
  double residual = 0;
};
Run run_wave(Evolution& evolution, int steps) {
  start_wave(evolution);
  Run run;
  try {
    for (int n = 0; n < steps; ++n) {
      evolution.stepper().step();
      run.rows.push_back(evolution.stepper().row(0));
      run.iterations += evolution.stepper().iterations();
      run.residual = std::max(run.residual, evolution.stepper().residual());
    }
  } catch (const NoConvergence&) {
    run.reported = true;
  }
  return run;
}
/// Over the rows that both have.
double distance(const Run& a, const Run& b) {
  double largest = 0;
  for (std::size_t n = 0; n < std::min(a.rows.size(), b.rows.size()); ++n)
    largest = std::max(largest, delf::testing::distance(a.rows[n], b.rows[n]));
  return largest;
}

const Lattice ring = Lattice::circle(64, 40);
const std::pair<int, int> degrees[]{{2, 2}, {1, 2}, {3, 1}, {2, 3}};

/// Of stencils taken lanes at a time, from those taken one by one.
double pack_defect(const StencilFamily& family, Random& random) {
  const std::size_t n = at(family.size());
  std::vector<Pack> y(n), r(n);
  Pack x;
  for (int l = 0; l < lanes; ++l) {
    x.v[l] = random(-5, 5);
    for (Pack& value : y) value.v[l] = random(-3, 3);
  }
  const Cell cell{0.3, 0.5, 0.7, 0};
  family.residual({cell, lanes, reinterpret_cast<double*>(&x), reinterpret_cast<double*>(y.data())},
                  reinterpret_cast<double*>(r.data()));
  double worst = 0;
  for (int l = 0; l < lanes; ++l) {
    std::vector<double> one, expected(n);
    for (const Pack& value : y) one.push_back(value[l]);
    family.residual({cell.time_step, cell.space_step, cell.t, x[l]}, one, expected);
    for (std::size_t i = 0; i < n; ++i) worst = std::max(worst, std::abs(r[i][l] - expected[i]));
  }
  return worst;
}

}  // namespace

TEST_CASE("elements taken lanes at a time have the residuals of elements taken one by one") {
  Random random(71);
  for (const auto& [time, space] : degrees) {
    const StencilTable element = spacetime_element(time, space, TimeQuadrature::gauss);
    CHECK(pack_defect(*jet_family(element, SineGordon{1.3}), random) < 2e-13);
    CHECK(pack_defect(*jet_family(element, SineGordonImpurity{}), random) < 2e-13);
  }
}

TEST_CASE("the constant part of an element's Jacobian is the Jacobian where the potential is straight") {
  const Cell cell{0.3, 0.5, 0.7, 0.2};
  for (const auto& [time, space] : degrees) {
    const StencilTable element = spacetime_element(time, space, TimeQuadrature::gauss);
    const auto bent = jet_family(element, SineGordon{1.3});
    const auto quadratic = jet_family(element, KleinGordon{1.3});
    const std::size_t n = at(bent->size());
    std::vector<double> J(n * n);
    const auto difference = [&](const StencilFamily& family, double phi) {
      family.jacobian(cell, std::vector<double>(n, phi), J);
      const auto constant = family.constant_part(cell);
      REQUIRE(constant);
      return delf::testing::distance(J, constant->J);
    };
    CHECK(difference(*bent, std::numbers::pi / 2) < 1e-14);
    CHECK(difference(*bent, 0) > 1e-4);
    CHECK(difference(*quadratic, 0.4) == 0);
  }
}

TEST_CASE("the fixed point with the constant part and Newton's method find the same slabs") {
  for (const auto& [time, space] : degrees)
    for (const double part : {1. / 8, 1. / 2}) {
      CAPTURE(time, space, part);
      const double h = part * ring.space_step();
      Evolution fixed = element_evolution(element_family(time, space), time, space, ring, h);
      Evolution newton = element_evolution(newton_alone(element_family(time, space)), time, space, ring, h);
      const Run a = run_wave(fixed, 30), b = run_wave(newton, 30);
      REQUIRE(a.rows.size() == 30);
      REQUIRE(b.rows.size() == 30);
      CHECK(distance(a, b) < 1e-12);
      CHECK(a.residual < 2e-13);
    }
}

TEST_CASE("the same between walls, where the first and the last cell have other unknowns") {
  for (const Wall wall : {Wall::fixed, Wall::natural}) {
    const Lattice lattice = Lattice::interval(41, 20, wall, Wall::natural);
    Evolution fixed = element_evolution(element_family(2, 2), 2, 2, lattice, 0.1);
    Evolution newton = element_evolution(newton_alone(element_family(2, 2)), 2, 2, lattice, 0.1);
    const Run a = run_wave(fixed, 30), b = run_wave(newton, 30);
    REQUIRE(a.rows.size() == 30);
    CHECK(distance(a, b) < 1e-12);
  }
}

TEST_CASE("where the constant part does not contract the slabs are those of Newton's method") {
  const double h = ring.space_step() / 2;
  const Family stiff = element_family(2, 2, 6);  // mh = 1.9
  Evolution tried = element_evolution(stiff, 2, 2, ring, h);
  Evolution newton = element_evolution(newton_alone(stiff), 2, 2, ring, h);
  const Run a = run_wave(tried, 4), b = run_wave(newton, 4);
  REQUIRE(b.rows.size() >= 1);
  REQUIRE(a.rows.size() == b.rows.size());
  CHECK(distance(a, b) < 1e-11);
}

TEST_CASE("a wrong constant part or a wrong Jacobian is slow, or reported, and no other solution") {
  const double h = ring.space_step() / 4;
  Evolution right = element_evolution(newton_alone(element_family(2, 2)), 2, 2, ring, h);
  const Run expected = run_wave(right, 10);
  REQUIRE(expected.rows.size() == 10);
  const auto with = [&](double jacobian, double constant) {
    Evolution evolution =
        element_evolution(std::make_shared<Altered>(element_family(2, 2), jacobian, constant), 2, 2, ring, h);
    const Run run = run_wave(evolution, 10);
    CAPTURE(jacobian, constant);
    CHECK((run.reported || run.rows.size() == 10));
    CHECK(distance(run, expected) < 2e-12);
    return run;
  };
  CHECK_FALSE(with(1, 1).reported);
  for (const double factor : {1.2, 3.0, 0.6, 0.3, -1.0, 100.0}) {
    CHECK_FALSE(with(1, factor).reported);  // Newton's method has the right one
    with(factor, 0);
    with(factor, factor);
  }
  CHECK(with(1, 1.2).iterations > with(1, 1).iterations);
  CHECK(with(-1, -1).reported);
}

TEST_CASE("elements that are started again give the same bits, whatever was stepped before") {
  for (const double mass : {1.0, 6.0}) {
    Evolution evolution = element_evolution(element_family(2, 2, mass), 2, 2, ring, ring.space_step() / 4);
    const Run once = run_wave(evolution, 12), again = run_wave(evolution, 12);
    REQUIRE(once.rows.size() == 12);
    CHECK(once.rows == again.rows);
  }
}

namespace {

/// Groups of unknowns at sites, coupled with their neighbours, round a circle or not. With `zero_diagonal` what is large
/// stands next to the diagonal.
struct Chain {
  std::vector<std::pair<int, int>> places;
  std::vector<double> values;
  std::vector<int> sites;  ///< of the rows
  Eigen::MatrixXd matrix;

  Chain(const std::vector<int>& sizes, bool circle, bool zero_diagonal, Random& random) {
    for (int site = 0; site < static_cast<int>(sizes.size()); ++site)
      for (int i = 0; i < sizes[site]; ++i) sites.push_back(site);
    const int n = static_cast<int>(sites.size()), last = static_cast<int>(sizes.size()) - 1;
    matrix = Eigen::MatrixXd::Zero(n, n);
    for (int r = 0; r < n; ++r)
      for (int c = 0; c < n; ++c) {
        const auto site = [&](int m) { return sites[m]; };
        const int apart = std::abs(site(r) - site(c));
        if (apart > 1 && !(circle && apart == last)) continue;
        matrix(r, c) = apart == 0 ? random(-1, 1) : random(-0.4, 0.4);
        if (r == c) matrix(r, c) = zero_diagonal ? 0 : matrix(r, c) + 6;
        if (zero_diagonal && c == (r ^ 1)) matrix(r, c) += 6;
        places.emplace_back(r, c);
        values.push_back(matrix(r, c));
      }
  }
  BlockSolver solver() const {
    return {static_cast<int>(matrix.rows()), places, std::vector<char>(places.size(), true), true};
  }
};

double solve_defect(const Chain& chain, BlockSolver& solver, Random& random) {
  std::vector<double> b(chain.matrix.rows()), x;
  for (double& value : b) value = random(-1, 1);
  REQUIRE(solver.factor(chain.values));
  solver.solve(b, x);
  const Eigen::Map<const Eigen::VectorXd> right(b.data(), chain.matrix.rows()), found(x.data(), chain.matrix.rows());
  const Eigen::VectorXd expected = chain.matrix.partialPivLu().solve(right);
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

TEST_CASE("bands are solved, round a circle or not, with odd groups or not") {
  Random random(72);
  for (const int group : {1, 2, 3, 4, 6})
    for (const int count : {40, 64, 97})
      for (const bool circle : {true, false})
        for (const bool odd : {false, true}) {
          CAPTURE(group, count, circle, odd);
          std::vector<int> sizes(count, group);
          if (odd && group > 1) sizes.front() = 1, sizes.back() = group - 1;
          const Chain chain(sizes, circle, false, random);
          BlockSolver solver = chain.solver();
          CHECK(solve_defect(chain, solver, random) < 1e-12);
          CHECK(contains(solver.name(), "band LU"));
        }
}

TEST_CASE("rows are exchanged where a pivot is zero, and a matrix that is no band is solved otherwise") {
  Random random(73);
  const Chain exchanged(std::vector<int>(40, 4), true, true, random);
  BlockSolver solver = exchanged.solver();
  CHECK(solve_defect(exchanged, solver, random) < 1e-10);

  // Every site's own entries are zero: it is solved from its neighbours.
  Chain off(std::vector<int>(63, 2), true, false, random);
  for (std::size_t p = 0; p < off.places.size(); ++p) {
    const auto [r, c] = off.places[p];
    if (off.sites[r] == off.sites[c]) off.values[p] = off.matrix(r, c) = 0;
  }
  BlockSolver other = off.solver();
  CHECK(solve_defect(off, other, random) < 1e-9);

  const Chain wide(std::vector<int>(4, 12), true, true, random);
  BlockSolver sparse = wide.solver();
  CHECK(solve_defect(wide, sparse, random) < 1e-10);
  CHECK(contains(sparse.name(), "sparse"));
}

TEST_CASE("a singular matrix is reported by every kind of block") {
  Random random(74);
  for (const int count : {4, 40}) {
    Chain chain(std::vector<int>(count, 2), true, false, random);
    for (std::size_t p = 0; p < chain.places.size(); ++p)
      if (chain.places[p].first == 3) chain.values[p] = 0;
    BlockSolver solver = chain.solver();
    CHECK_FALSE(solver.factor(chain.values));
  }
}

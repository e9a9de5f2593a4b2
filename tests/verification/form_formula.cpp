// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

const std::vector<Lattice> lattices{Lattice::circle(64, 40), Lattice::interval(64, 40, Wall::natural, Wall::natural)};
constexpr double round_off = 1e-13;
const LinearSymmetry shift{"φ → φ + ε", {0}, {1}};

double time_step(const Lattice& lattice) { return 0.5 * lattice.space_step(); }

/// A scheme with a random field on a random region.
Patch random_patch(std::mt19937_64& random, const Lattice& lattice, const Family& family) {
  Patch patch(lattice, {family}, time_step(lattice), random_centres(random, seam_or_wall(lattice)));
  REQUIRE(patch.U().regular());
  REQUIRE(!patch.U().interior().empty());
  REQUIRE(patch.on.equations().size() == patch.U().interior().size());
  patch.y = random_values(random, patch.on.nodes());
  return patch;
}
Patch random_patch(std::mt19937_64& random, const Lattice& lattice, const std::string& theory,
                   const SchemeName& scheme) {
  return random_patch(random, lattice, make_family(theory, scheme));
}

/// A scheme that says nothing of its Lagrangian, so that its equations alone are asked.
class Untold final : public StencilFamily {
 public:
  explicit Untold(Family family) : StencilFamily(family->pattern(), family->values(), false), family_(family) {}
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    family_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    family_->jacobian(cell, y, J);
  }

 private:
  Family family_;
};

}  // namespace

TEST_CASE("the sums over a region are those of their definitions, stencil by stencil") {
  std::mt19937_64 random(5);
  const LinearSymmetry affine{"", {0.7}, {1.3}};
  for (const SchemeName& scheme : all_schemes)
    for (const Lattice& lattice : lattices)
      for (int trial = 0; trial < 10; ++trial) {
        Patch patch = random_patch(random, lattice, "sine-gordon", scheme);
        const ByHand plain = by_hand(patch);
        CAPTURE(scheme.text(), lattice.is_circle(), trial);
        const auto places = [&](const std::vector<Site>& sites) {
          std::set<std::size_t> result;
          for (const Site site : sites) result.insert(patch.U().place(site));
          return result;
        };
        REQUIRE(plain.interior() == places(patch.U().interior()));
        REQUIRE(plain.boundary() == places(patch.U().boundary()));

        // V and W that are no first variations, and a field that is no solution: none of these sums is zero
        const RegionSystem::Pair pair{random_values(random, patch.y.size()), random_values(random, patch.y.size())};
        const auto agree = [](const Balance& sum, double expected) {
          CHECK(std::abs(sum.sum - expected) <= 1e-12 * sum.absolute);
          CHECK(std::abs(expected) > 1e-9 * sum.absolute);
        };
        if (scheme.method == "multisymplectic") {
          agree(patch.form_formula(pair), plain.form_formula(pair.V, pair.W));
        } else {
          agree(patch.form_formula(pair), plain.defect(pair.V, pair.W));
          // the agreement can fail: the other sum is another one
          CHECK(std::abs(patch.form_formula(pair).sum - plain.form_formula(pair.V, pair.W)) >
                1e-6 * patch.form_formula(pair).absolute);
        }
        agree(patch.on.noether(patch.y, shift), plain.noether(0, 1));
        agree(patch.on.noether(patch.y, affine), plain.noether(0.7, 1.3));

        const auto E = patch.on.residual(patch.y), MV = patch.on.linearised(patch.y, pair.V);
        const Eigen::VectorXd e = plain.equations();
        const Eigen::VectorXd mv = plain.linearised() * Eigen::Map<const Eigen::VectorXd>(
                                                            pair.V.data(), static_cast<Eigen::Index>(pair.V.size()));
        REQUIRE(E.size() == plain.interior().size());
        for (std::size_t n = 0; n < E.size(); ++n) {
          const auto b = static_cast<Eigen::Index>(patch.on.equations()[n]);
          CHECK(std::abs(E[n].sum - e[b]) <= 1e-12 * E[n].absolute);
          CHECK(std::abs(MV[n].sum - mv[b]) <= 1e-12 * MV[n].absolute);
        }
      }
}

TEST_CASE("every variational scheme satisfies the multisymplectic form formula on every region") {
  std::mt19937_64 random(7);
  double worst = 0, worst_defect = 0;
  for (const SchemeName& scheme : variational_schemes)
    for (const Lattice& lattice : lattices)
      for (int trial = 0; trial < 10; ++trial) {
        const Family family = make_family("sine-gordon", scheme);
        std::mt19937_64 same = random;
        const Patch patch = random_patch(random, lattice, family);
        const Patch untold = random_patch(same, lattice, std::make_shared<Untold>(family));
        REQUIRE(untold.y == patch.y);
        const auto pair = patch.variations(random);
        const double form = patch.form_formula(pair).relative(), defect = untold.form_formula(pair).relative();
        CAPTURE(scheme.text(), lattice.is_circle(), patch.y.size(), patch.U().interior().size());
        CHECK(form < round_off);
        CHECK(defect < round_off);
        worst = std::max(worst, form), worst_defect = std::max(worst_defect, defect);
      }
  CAPTURE(worst, worst_defect);
  CHECK(worst > 0);
  CHECK(worst_defect > 0);
}

TEST_CASE("the form formula can fail: V that breaks the linearised equations at one site") {
  std::mt19937_64 random(11);
  for (const SchemeName& scheme : variational_schemes) {
    const Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
    const auto pair = patch.variations(random);
    const Eigen::MatrixXd M = by_hand(patch).linearised();
    CAPTURE(scheme.text());
    // the sites of ∂U that some equation of int U feels, one after the other, some of them a little only
    const auto broken_at = [&](std::size_t place) {
      auto broken = pair;
      broken.V[place] += 0.01;
      return patch.form_formula(broken).relative();
    };
    std::vector<double> found;
    for (const Site a : patch.U().boundary())
      if (!M.col(static_cast<Eigen::Index>(patch.U().place(a))).isZero())
        found.push_back(broken_at(patch.U().place(a)));
    REQUIRE(!found.empty());
    CAPTURE(std::ranges::min(found));
    CHECK(found.front() > 1e-6);
    CHECK(std::ranges::min(found) > 1e-9);
    const auto most = patch.on.coupling_node(patch.y);
    REQUIRE(most);
    CHECK(broken_at(*most) > 1e-6);
  }
}

TEST_CASE("the form formula can fail: Vu-Quoc and Li, Guo et al. are not multisymplectic") {
  std::mt19937_64 random(13);
  for (const SchemeName& scheme : comparators) {
    double largest = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
      largest = std::max(largest, patch.form_formula(patch.variations(random)).relative());
    }
    CAPTURE(scheme.text(), largest);
    CHECK(largest > 1e-6);
  }
}

TEST_CASE("with a quadratic potential Vu-Quoc and Li, Guo et al. pass") {
  std::mt19937_64 random(17);
  for (const SchemeName& scheme : comparators)
    for (int trial = 0; trial < 10; ++trial) {
      const Patch patch = random_patch(random, lattices.front(), "klein-gordon", scheme);
      CAPTURE(scheme.text());
      CHECK(patch.form_formula(patch.variations(random)).relative() < round_off);
    }
}

TEST_CASE("Noether: φ → φ + ε is a symmetry of the wave equation, and its momentum balances on every region") {
  std::mt19937_64 random(19);
  for (const SchemeName& scheme : variational_schemes)
    for (const Lattice& lattice : lattices)
      for (int trial = 0; trial < 10; ++trial) {
        Patch patch = random_patch(random, lattice, "wave", scheme);
        patch.y = patch.on.first_variations(patch.y, 1, random).front();  // a linear equation: these are its solutions
        CAPTURE(scheme.text(), lattice.is_circle());
        CHECK(patch.on.noether(patch.y, shift).relative() < round_off);
      }
}

TEST_CASE("the Noether balance can fail: φ → φ + ε is no symmetry of sine-Gordon") {
  std::mt19937_64 random(23);
  for (const SchemeName& scheme : variational_schemes) {
    Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
    for (int n = 0; n < 30; ++n) {  // Newton's method on int U, to the nearest solution
      const ByHand plain = by_hand(patch);
      const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(plain.linearised());
      Eigen::Map<Eigen::VectorXd>(patch.y.data(), static_cast<Eigen::Index>(patch.y.size())) -=
          solver.solve(plain.equations());
    }
    double left = 0;
    for (const Balance& E : patch.on.residual(patch.y)) left = std::max(left, std::abs(E.sum));
    CAPTURE(scheme.text(), left);
    REQUIRE(left < 1e-12);
    CHECK(patch.on.noether(patch.y, shift).relative() > 1e-6);
  }
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

const std::vector<Lattice> lattices{Lattice::circle(64, 40), Lattice::interval(64, 40, Wall::natural, Wall::natural)};
constexpr double round_off = 1e-13;

/// A scheme with a random field on a random region.
Patch random_patch(std::mt19937& random, const Lattice& lattice, const std::string& theory, const SchemeName& scheme) {
  const double k = lattice.space_step(), h = 0.5 * k;
  const Family family = make_family(theory, scheme, h, k);
  Patch patch(random_region(random, lattice, family->pattern()), family, h);
  REQUIRE(patch.U.regular());
  REQUIRE(!patch.U.interior().empty());
  patch.y = random_vector(random, patch.size());
  return patch;
}

}  // namespace

TEST_CASE("every variational scheme satisfies the multisymplectic form formula on every region") {
  std::mt19937 random(7);
  for (const SchemeName& scheme : variational_schemes)
    for (const Lattice& lattice : lattices)
      for (int trial = 0; trial < 10; ++trial) {
        const Patch patch = random_patch(random, lattice, "sine-gordon", scheme);
        const auto V = patch.first_variation(random), W = patch.first_variation(random);
        CAPTURE(scheme.text(), lattice.is_circle(), patch.size(), patch.U.interior().size());
        CHECK(patch.form_formula(V, W).relative() < round_off);
        CHECK(patch.defect(V, W).relative() < round_off);
      }
}

TEST_CASE("the form formula can fail: V that breaks the linearised equations at one site") {
  std::mt19937 random(11);
  for (const SchemeName& scheme : variational_schemes) {
    const Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
    auto V = patch.first_variation(random);
    const auto W = patch.first_variation(random);
    const Eigen::MatrixXd M = patch.linearised();
    // a site of ∂U that some equation of int U feels
    const auto a = std::ranges::find_if(patch.U.boundary(), [&](Site s) { return !M.col(patch.index(s)).isZero(); });
    REQUIRE(a != patch.U.boundary().end());
    V[patch.index(*a)] += 0.01;
    CAPTURE(scheme.text());
    CHECK(patch.form_formula(V, W).relative() > 1e-6);
  }
}

TEST_CASE("the form formula can fail: Vu-Quoc and Li, Guo et al. are not multisymplectic") {
  std::mt19937 random(13);
  for (const SchemeName& scheme : comparators) {
    double largest = 0;
    for (int trial = 0; trial < 10; ++trial) {
      const Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
      const auto V = patch.first_variation(random), W = patch.first_variation(random);
      largest = std::max(largest, patch.defect(V, W).relative());
    }
    CAPTURE(scheme.text(), largest);
    CHECK(largest > 1e-6);
  }
}

TEST_CASE("with a quadratic potential Vu-Quoc and Li, Guo et al. pass") {
  std::mt19937 random(17);
  for (const SchemeName& scheme : comparators)
    for (int trial = 0; trial < 10; ++trial) {
      const Patch patch = random_patch(random, lattices.front(), "klein-gordon", scheme);
      const auto V = patch.first_variation(random), W = patch.first_variation(random);
      CAPTURE(scheme.text());
      CHECK(patch.defect(V, W).relative() < round_off);
    }
}

TEST_CASE("Noether: φ → φ + ε is a symmetry of the wave equation, and its momentum balances on every region") {
  std::mt19937 random(19);
  for (const SchemeName& scheme : variational_schemes)
    for (const Lattice& lattice : lattices)
      for (int trial = 0; trial < 10; ++trial) {
        Patch patch = random_patch(random, lattice, "wave", scheme);
        patch.y = patch.first_variation(random);  // a linear equation: its solutions are its first variations
        CAPTURE(scheme.text(), lattice.is_circle());
        CHECK(patch.noether().relative() < round_off);
      }
}

TEST_CASE("the Noether balance can fail: φ → φ + ε is no symmetry of sine-Gordon") {
  std::mt19937 random(23);
  for (const SchemeName& scheme : variational_schemes) {
    Patch patch = random_patch(random, lattices.front(), "sine-gordon", scheme);
    patch.solve();
    CAPTURE(scheme.text());
    REQUIRE(patch.equations().lpNorm<Eigen::Infinity>() < 1e-12);
    CHECK(patch.noether().relative() > 1e-6);
  }
}

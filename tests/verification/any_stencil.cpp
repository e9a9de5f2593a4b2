// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/families/random_stencil.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int seeds = 80;
constexpr double k = 0.5, h = 0.2;

Lattice ring(int seed) { return Lattice::circle(12 + seed % 13, (12 + seed % 13) * k); }

using RandomFamily = LagrangianFamily<RandomStencil>;
std::shared_ptr<const RandomFamily> family_of(int seed) {
  return std::make_shared<RandomFamily>(RandomStencil(static_cast<std::uint64_t>(seed)));
}

/// The sign of one entry of the Jacobian wrong: what code written by hand may do.
class Planted final : public StencilFamily {
 public:
  explicit Planted(Family family) : StencilFamily(family->pattern(), family->values(), true), family_(family) {}
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    family_->residual(cell, y, r);
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    family_->jacobian(cell, y, J);
    J[1] = -J[1];
  }

 private:
  Family family_;
};

std::vector<std::vector<double>> random_rows(Random& random, int rows, int sites, double amplitude) {
  std::vector<std::vector<double>> result(rows);
  for (auto& row : result)
    for (int i = 0; i < sites; ++i) row.push_back(random(-amplitude, amplitude));
  return result;
}

double form_defect(int seed, const Family& family) {
  std::mt19937_64 random(static_cast<std::uint64_t>(seed));
  const Lattice lattice = ring(seed);
  Patch patch(lattice, {family}, h, random_centres(random, seam_or_wall(lattice)));
  REQUIRE(patch.U().regular());
  REQUIRE(!patch.on.equations().empty());
  patch.y = random_values(random, patch.on.nodes());
  return patch.form_formula(patch.variations(random)).relative();
}

}  // namespace

TEST_CASE("a random stencil is planned or refused, and a planned one solves its field equations") {
  int planned = 0, refused = 0, stepped = 0, failed = 0;
  double worst = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    CAPTURE(seed);
    const Lattice lattice = ring(seed);
    std::optional<Evolution> evolution;
    try {
      evolution.emplace(lattice, FamilyList{family_of(seed)}, h);
      ++planned;
    } catch (const BadInput&) {
      ++refused;
      continue;
    }
    Random random(static_cast<std::uint64_t>(seed));
    Stepper& stepper = evolution->stepper();
    try {
      stepper.start(random_rows(random, stepper.starting_rows(), lattice.sites(), 0.01));
      stepper.step();
      ++stepped;
    } catch (const NoConvergence&) {
      ++failed;
      UNSCOPED_INFO("no convergence " << seed);
      continue;
    }
    UNSCOPED_INFO(seed << " residual " << stepper.residual());
    worst = std::max(worst, stepper.residual());
    CHECK(stepper.residual() < 1e-12);
  }
  CAPTURE(planned, refused, stepped, failed, worst);
  CHECK(planned + refused == seeds);
  CHECK(2 * planned > seeds);
  CHECK(2 * stepped > planned);
}

TEST_CASE("any random stencil satisfies the multisymplectic form formula on random regions") {
  double worst = 0;
  for (int seed = 0; seed < seeds; ++seed) {
    const double defect = form_defect(seed, family_of(seed));
    CAPTURE(seed);
    CHECK(defect < 1e-13);
    worst = std::max(worst, defect);
  }
  CAPTURE(worst);
  CHECK(worst > 0);
}

TEST_CASE("the form formula of a random stencil can fail: one entry of its Jacobian has the wrong sign") {
  for (int seed = 0; seed < seeds; ++seed) {
    CAPTURE(seed);
    CHECK(form_defect(seed, std::make_shared<Planted>(family_of(seed))) > 1e-6);
  }
}

TEST_CASE("the field equations of a random stencil are the differences of its summed action") {
  for (int seed = 0; seed < seeds; ++seed) {
    const Lattice lattice = ring(seed);
    const int N = lattice.sites();
    const auto family = family_of(seed);
    const LatticeSystem system(lattice, {family}, h);
    Random random(static_cast<std::uint64_t>(1000 + seed));
    Window window{&lattice, 1, 0, 0, random_rows(random, 5, N, 1)};
    const int site = random.pick(0, N - 1);

    // all stencils that can touch the site, which is in row 2: anchored in rows 0, 1, 2
    const auto action = [&](double shift) {
      Window shifted = window;
      shifted.rows[2][site] += shift;
      double sum = 0;
      std::vector<double> y(family->size());
      for (int j = 0; j < 3; ++j)
        for (int i = 0; i < N; ++i) {
          for (int v = 0; v < family->size(); ++v)
            y[v] = shifted(j + family->site(v).time, i + family->site(v).space, 0);
          sum += *family->lagrangian({h, k, 0, 0}, y);
        }
      return sum;
    };
    // exact for a quartic
    constexpr double step = 0.5;
    const double difference =
        (8 * (action(step) - action(-step)) - (action(2 * step) - action(-2 * step))) / (12 * step);
    std::vector<LatticeSystem::Value> values;
    system.equations(window, 2, values);
    const auto E = values[site];
    CAPTURE(seed, E.sum, difference);
    CHECK(std::abs(E.sum - difference) / E.absolute < 1e-12);
    const auto other = values[(site + 1) % N];
    CHECK(std::abs(other.sum - difference) / other.absolute > 1e-6);  // of the neighbour, it is not
  }
}

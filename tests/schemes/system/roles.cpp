// SPDX-License-Identifier: MIT
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "lattice/shapes/time_step.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/lattice_system.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double h = 0.1;
constexpr int q = 0, X = 1;  // components

/// L = h(½((q'−q)/h)² − ½Xq²) reads X at the lower row, and varies q alone if `varies_all` is false.
class Oscillator final : public StencilFamily {
 public:
  explicit Oscillator(bool varies_all)
      : StencilFamily({{{0, 0}, {1, 0}}, Placement::every_site}, {{0, q}, {0, X}, {1, q}}, true) {
    if (!varies_all) varied_ = {true, false, true};
  }
  void residual(const Cell& cell, std::span<const double> y, std::span<double> r) const override {
    const double v = (y[2] - y[0]) / cell.time_step;
    r[0] = -v - cell.time_step * y[1] * y[0];
    r[1] = -0.5 * cell.time_step * y[0] * y[0];
    r[2] = v;
  }
  void jacobian(const Cell& cell, std::span<const double> y, std::span<double> J) const override {
    const double k = 1 / cell.time_step, t = cell.time_step;
    const double all[]{k - t * y[1], -t * y[0], -k, -t * y[0], 0, 0, -k, 0, k};
    std::ranges::copy(all, J.begin());
  }
};

/// X = 1 + q²
class Slaved final : public StencilFamily {
 public:
  Slaved() : StencilFamily({{{0, 0}}, Placement::every_site}, {{0, q}, {0, X}}, false) { varied_ = {false, true}; }
  void residual(const Cell&, std::span<const double> y, std::span<double> r) const override {
    r[0] = 7;  // belongs to no equation
    r[1] = y[1] - 1 - y[0] * y[0];
  }
  void jacobian(const Cell&, std::span<const double> y, std::span<double> J) const override {
    J[0] = J[1] = 0, J[2] = -2 * y[0], J[3] = 1;
  }
};

std::vector<std::shared_ptr<const StencilFamily>> families(bool varies_all = false) {
  return {std::make_shared<Oscillator>(varies_all), std::make_shared<Slaved>()};
}
const std::vector<Component> components{{"q"}, {"X", Role::slaved}};

}  // namespace

TEST_CASE("what a family reads and does not vary has no part in its residual") {
  const Lattice point = Lattice::point();
  const std::vector<std::vector<double>> rows{{0.3, 1.5}, {0.4, 1.7}, {0.6, 1.2}};
  const auto equations = [&](bool varies_all) {
    const LatticeSystem system(point, families(varies_all), h, components);
    std::vector<LatticeSystem::Value> values;
    system.equations(system.window(0, rows, 0), 1, values);
    return std::vector<double>{values[0].sum, values[1].sum};
  };
  // (q₁ − q₀)/h − (q₂ − q₁)/h − hX₁q₁ and X₁ − 1 − q₁²
  const double E = (0.4 - 0.3) / h - (0.6 - 0.4) / h - h * 1.7 * 0.4, G = 1.7 - 1 - 0.16;
  CHECK(std::abs(equations(false)[0] - E) < 1e-14);
  CHECK(std::abs(equations(false)[1] - G) < 1e-14);
  CHECK(std::abs(equations(true)[1] - (G - 0.5 * h * 0.16)) < 1e-14);  // ∂L/∂X too
}

TEST_CASE("a slaved component follows its own equation, step by step") {
  Evolution evolution(Lattice::point(), families(), h, {}, components);
  evolution.stepper().start({{0.5, 1.25}, {0.52, 1 + 0.52 * 0.52}});
  double before = 0.5, now = 0.52;
  for (int n = 0; n < 40; ++n) {
    evolution.stepper().step();
    const double next = 2 * now - before - h * h * (1 + now * now) * now;
    before = now, now = next;
    const auto row = evolution.stepper().row(0);
    CHECK(std::abs(row[q] - now) < 1e-13);
    // as it was found with the row: at this row, or at the one before
    const int behind = evolution.stepper().behind()[X];
    const double there = behind == 0 ? now : before;
    CHECK(std::abs(row[X] - 1 - there * there) < 1e-13);
  }
}

TEST_CASE("fields are numbered wherever they stand, and their values gain the turn around a circle") {
  const Lattice ring = Lattice::circle(4, 6);
  const LatticeSystem system(ring, families(), h,
                             {{"lambda", Role::multiplier},
                              {"phi"},
                              {"node", Role::inner, {0.5, 0}, false, 1},
                              {"trace", Role::trace},
                              {"psi"},
                              {"X", Role::slaved, {}, true}});
  CHECK(system.fields() == 2);
  CHECK(system.field_component(0) == 1);
  CHECK(system.field_component(1) == 4);
  CHECK(system.component(4).field == 1);
  CHECK(system.moves());
  const Window window = system.window(0, {std::vector<double>(24, 1.0)}, 2.5);
  const double gained[]{0, 2.5, 2.5, 2.5, 2.5, 0};
  for (int c = 0; c < 6; ++c) {
    CHECK(system.monodromy_of(c, 2.5) == gained[c]);
    CHECK(window(0, 4, c) == 1 + gained[c]);
    CHECK(window(0, -5, c) == 1 - 2 * gained[c]);
  }
  for (const Role role : all_roles) CHECK(std::string(to_string(role)).size() > 4);
}

TEST_CASE("a symmetry acts on the values of its fields at every node, in whatever order they stand") {
  // nodes of two fields, the second before the first
  const std::vector<Component> order{{"node of psi", Role::inner, {0.5, 0}, false, 1},
                                     {"node of phi", Role::inner, {0.5, 0}, false, 0},
                                     {"phi"},
                                     {"X", Role::slaved},
                                     {"psi"}};
  class Five final : public StencilFamily {
   public:
    Five() : StencilFamily({{{0, 0}}, Placement::every_site}, {{0, 0}, {0, 1}, {0, 2}, {0, 3}, {0, 4}}, true) {}
    void residual(const Cell&, std::span<const double>, std::span<double>) const override {}
    void jacobian(const Cell&, std::span<const double>, std::span<double>) const override {}
  };
  const auto family = std::make_shared<Five>();
  const LatticeSystem system(Lattice::circle(4, 6), {family}, h, order);
  // a rotation of (phi, psi)
  LinearSymmetry rotation;
  rotation.shift = {0, 0}, rotation.matrix = {0, -1, 1, 0};
  std::vector<double> xi;
  generator(system, *family, rotation, std::vector<double>{2, 3, 5, 7, 11}, xi);
  CHECK(xi == std::vector<double>{3, -2, -11, 0, 5});
}

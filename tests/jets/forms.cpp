// SPDX-License-Identifier: MIT
#include "jets/forms.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "jets/batch_of.hpp"
#include "jets/discrete_lagrangian.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/residual_family.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::for_each_map;
using delf::testing::for_each_theory;
using delf::testing::Random;

namespace {

const Cell cell{0.1, 0.25, 0.4, 0.6};

/// |Σ_l Ωˡ(V, W)| relative to Σ_l |Ωˡ(V, W)|.
double sum_of_forms(int vertices, std::span<const double> jacobian, std::span<const double> V,
                    std::span<const double> W) {
  double sum = 0, size = 0;
  for (int l = 0; l < vertices; ++l) {
    const double form = multisymplectic_form(l, static_cast<int>(V.size()) / vertices, jacobian, V, W);
    sum += form, size += std::abs(form);
  }
  return std::abs(sum) / size;
}

/// The worst over random values and variations, for a residual stencil without a Lagrangian.
template <std::size_t n>
double of_comparator(const DirectResidual& stencil) {
  const ResidualFamily family(stencil, std::make_shared<BatchOf<SineGordon>>(SineGordon{1}));
  Random random(12);
  double worst = 0;
  std::vector<double> J(n * n);
  for (int m = 0; m < 20; ++m) {
    family.jacobian(cell, random.array<n>(-2, 2), std::span(J));
    worst = std::max(worst, sum_of_forms(n, J, random.array<n>(-1, 1), random.array<n>(-1, 1)));
  }
  return worst;
}

/// ½|φ_t|² − ½|φ_x|² − ¼|φ|⁴ in ℝ²
struct Rotor {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    const auto r = j.phi[0] * j.phi[0] + j.phi[1] * j.phi[1];
    return 0.5 * (j.phi_t[0] * j.phi_t[0] + j.phi_t[1] * j.phi_t[1]) -
           0.5 * (j.phi_x[0] * j.phi_x[0] + j.phi_x[1] * j.phi_x[1]) - 0.25 * r * r;
  }
};

}  // namespace

TEST_CASE("the sum of the Cartan forms is dL, on every stencil for every theory") {
  Random random(13);
  for_each_theory([&](const auto& theory) {
    for_each_map([&](auto map) {
      const auto lagrangian = discrete_lagrangian(map, theory);
      constexpr std::size_t size = decltype(lagrangian)::size;
      const auto y = random.array<size>(-2, 2), V = random.array<size>(-1, 1);
      const auto gradient = lagrangian.gradient(y, cell);
      double sum = 0, absolute = 0;
      for (int l = 0; l < lagrangian.n; ++l) sum += cartan_form(l, 1, gradient, V);
      for (double g : gradient) absolute += std::abs(g);
      // dL·V along y + εV
      constexpr double e = 1e-3;
      const auto along = [&](double s) {
        auto z = y;
        for (std::size_t i = 0; i < size; ++i) z[i] += s * V[i];
        return lagrangian(z, cell);
      };
      const double derivative = (8 * (along(e) - along(-e)) - (along(2 * e) - along(-2 * e))) / (12 * e);
      CHECK(std::abs(sum - derivative) < 1e-10 * absolute);
      CHECK(std::abs(sum - V[0] * gradient[0] - derivative) > 1e-6 * absolute);  // one vertex left out
    });
  });
}

TEST_CASE("the multisymplectic forms of a discrete Lagrangian sum to zero on every stencil") {
  Random random(14);
  for_each_theory([&](const auto& theory) {
    for_each_map([&](auto map) {
      const auto lagrangian = discrete_lagrangian(map, theory);
      constexpr std::size_t size = decltype(lagrangian)::size;
      const auto hessian = lagrangian.hessian(random.template array<size>(-2, 2), cell);
      CHECK(sum_of_forms(lagrangian.n, hessian, random.template array<size>(-1, 1),
                         random.template array<size>(-1, 1)) < 1e-14);
    });
  });
}

TEST_CASE("the sum can fail: it is not zero for the residuals of Vu-Quoc and Li, and of Guo et al.") {
  CHECK(of_comparator<9>(vu_quoc_li()) > 0.1);
  CHECK(of_comparator<5>(guo()) > 0.1);
  // nor for a Hessian with one entry changed
  Random random(15);
  auto hessian = discrete_lagrangian(rectangle, SineGordon{1.2}).hessian(random.array<4>(-2, 2), cell);
  hessian[1] *= 1.001;
  CHECK(sum_of_forms(4, hessian, random.array<4>(-1, 1), random.array<4>(-1, 1)) > 1e-6);
}

TEST_CASE("Ωˡ is antisymmetric, bilinear, and −dΘˡ") {
  Random random(16);
  const auto lagrangian = discrete_lagrangian(hexagon, PhiFour{});
  const auto y = random.array<6>(-1, 1), V = random.array<6>(-1, 1), W = random.array<6>(-1, 1),
             U = random.array<6>(-1, 1);
  const auto hessian = lagrangian.hessian(y, cell);
  std::array<double, 6> combined;
  for (std::size_t i = 0; i < 6; ++i) combined[i] = 2 * V[i] - 3 * U[i];
  for (int l = 0; l < 6; ++l) {
    const auto omega = [&](const auto& a, const auto& b) { return multisymplectic_form(l, 1, hessian, a, b); };
    CHECK(std::abs(omega(V, W) + omega(W, V)) < 1e-14);
    CHECK(std::abs(omega(V, V)) < 1e-14);
    CHECK(std::abs(omega(combined, W) - 2 * omega(V, W) + 3 * omega(U, W)) < 1e-13);
    // dΘ(V, W) = V[Θ(W)] − W[Θ(V)] for constant V and W
    const auto derivative = [&](const auto& along, const auto& of) {
      constexpr double e = 1e-4;
      auto above = y, below = y;
      for (std::size_t i = 0; i < 6; ++i) above[i] += e * along[i], below[i] -= e * along[i];
      return (cartan_form(l, 1, lagrangian.gradient(above, cell), of) -
              cartan_form(l, 1, lagrangian.gradient(below, cell), of)) /
             (2 * e);
    };
    CHECK(std::abs(omega(V, W) + derivative(V, W) - derivative(W, V)) < 1e-8);
  }
}

TEST_CASE(
    "the momentum of translations φ → φ + ε sums to zero on every stencil of the wave equation, not of sine-Gordon") {
  Random random(17);
  for_each_map([&](auto map) {
    const auto wave = discrete_lagrangian(map, Wave{});
    const auto sine_gordon = discrete_lagrangian(map, SineGordon{});
    constexpr std::size_t size = decltype(wave)::size;
    const auto y = random.array<size>(-2, 2);
    std::array<double, size> generator;
    generator.fill(1);
    const auto sum_of = [&](const auto& lagrangian) {
      const auto gradient = lagrangian.gradient(y, cell);
      double sum = 0, absolute = 0;
      for (int l = 0; l < lagrangian.n; ++l) {
        const double J = momentum_map(l, 1, gradient, generator);
        sum += J, absolute += std::abs(J);
      }
      return std::abs(sum) / absolute;
    };
    CHECK(sum_of(wave) < 1e-14);
    CHECK(sum_of(sine_gordon) > 1e-5);
  });
}

TEST_CASE("with two components the forms sum over those of their vertex alone, and rotations have a momentum") {
  Random random(18);
  const auto lagrangian = discrete_lagrangian(rectangle, Rotor{});
  const auto y = random.array<8>(-1, 1), V = random.array<8>(-1, 1), W = random.array<8>(-1, 1);
  const auto gradient = lagrangian.gradient(y, cell);
  for (int l = 0; l < 4; ++l) {
    const std::size_t i = 2 * l;
    CHECK(std::abs(cartan_form(l, 2, gradient, V) - (gradient[i] * V[i] + gradient[i + 1] * V[i + 1])) < 1e-15);
  }
  CHECK(sum_of_forms(4, lagrangian.hessian(y, cell), V, W) < 1e-14);
  // ξ = (−φ², φ¹): Σ_l Jˡ = 0 because L is invariant; a scaling is no symmetry
  std::array<double, 8> rotation, scaling = y;
  for (std::size_t l = 0; l < 4; ++l) rotation[2 * l] = -y[2 * l + 1], rotation[2 * l + 1] = y[2 * l];
  double rotated = 0, scaled = 0;
  for (int l = 0; l < 4; ++l) {
    rotated += momentum_map(l, 2, gradient, rotation);
    scaled += momentum_map(l, 2, gradient, scaling);
  }
  CHECK(std::abs(rotated) < 1e-14);
  CHECK(std::abs(scaled) > 1e-3);
}

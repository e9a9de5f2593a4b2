// SPDX-License-Identifier: MIT
#include "schemes/system/legendre.hpp"

#include <cmath>

#include "jets/batch_of.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// ℓ = −√(1 − v²) − ½q²: p = v/√(1 − v²), H = √(1 + p²) + ½q²
struct Relativistic {
  auto operator()(const auto& j) const { return -sqrt(1.0 - j.phi_t * j.phi_t) - 0.5 * (j.phi * j.phi); }
};
/// No inertia: p is q, whatever v is.
struct Degenerate {
  auto operator()(const auto& j) const { return j.phi * j.phi_t - 0.5 * (j.phi * j.phi); }
};
/// A mass that depends on q, and a term linear in v.
struct Magnetic {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    const auto &q = j.phi, &v = j.phi_t;
    return (1.0 + q[1] * q[1]) * (v[0] * v[0]) + 0.5 * (v[1] * v[1]) + q[0] * v[1] - cos(q[0]);
  }
};

}  // namespace

TEST_CASE("velocities and the Hamiltonian of given momenta, where momenta are not linear in velocities too") {
  const BatchOf<Relativistic> fast{Relativistic{}};
  for (const double p : {-0.6, 0.0, 0.3, 0.7}) {
    const double q[] = {0.4}, momentum[] = {p};
    const auto v = velocity_of(fast, q, momentum);
    REQUIRE(v);
    CHECK(std::abs((*v)[0] - p / std::sqrt(1 + p * p)) < 1e-15);
    CHECK(std::abs(hamiltonian(fast, q, momentum) - (std::sqrt(1 + p * p) + 0.08)) < 1e-15);
  }
  const BatchOf<Magnetic> magnetic{Magnetic{}};
  const double q[] = {0.3, -0.5}, p[] = {0.8, 0.2};
  const auto v = velocity_of(magnetic, q, p);
  REQUIRE(v);
  CHECK(std::abs((*v)[0] - 0.8 / 2.5) < 1e-15);
  CHECK(std::abs((*v)[1] + 0.1) < 1e-15);
  CHECK(std::abs(hamiltonian(magnetic, q, p) - (1.25 * 0.32 * 0.32 + 0.005 + std::cos(0.3))) < 1e-15);
}

TEST_CASE("a density without inertia has no velocities, and its Hamiltonian here is not a number") {
  const BatchOf<Degenerate> degenerate{Degenerate{}};
  const double q[] = {0.4}, p[] = {0.3};
  CHECK_FALSE(velocity_of(degenerate, q, p));
  CHECK(std::isnan(hamiltonian(degenerate, q, p)));
}

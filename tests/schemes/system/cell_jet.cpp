// SPDX-License-Identifier: MIT
#include "schemes/system/cell_jet.hpp"

#include <cmath>
#include <vector>

#include "tests/catch.hpp"
#include "jets/batch_of.hpp"
#include "schemes/system/stress_energy.hpp"

namespace delf {
namespace {

/// ½φ_t² − ½φ_xx² + φ_tx²
struct Stiff {
  static constexpr int jet_order = 2;
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_xx * j.phi_xx) + j.phi_tx * j.phi_tx; }
};

double field(double t, double x) { return 1 + 2 * t - 3 * x + 0.5 * t * x + 0.7 * x * x; }

std::vector<double> row(const Lattice& lattice, double t) {
  std::vector<double> y;
  for (int i = 0; i < lattice.sites(); ++i) y.push_back(field(t, lattice.position(i)));
  return y;
}

}  // namespace

TEST_CASE("the jets of cells are exact on quadratic fields, at walls too, and know no second derivative in time") {
  const BatchOf<Stiff> density{Stiff{}};
  const double h = 0.1;
  for (const int sites : {3, 4, 9}) {
    const Lattice lattice = Lattice::interval(sites, 2.0);
    CellJets jets(density, lattice, h, 0);
    const auto below = row(lattice, 0), above = row(lattice, h);
    for (int cell = 0; cell + 1 < sites; ++cell) {
      const double x = lattice.position(cell) + lattice.space_step() / 2, t = h / 2;
      const double* jet = jets.at(cell, below, above);
      CHECK(jet[1] == Approx(2 + 0.5 * x));
      CHECK(jet[2] == Approx(-3 + 0.5 * t + 1.4 * x));
      CHECK(std::isnan(jet[3]));
      CHECK(jet[4] == Approx(0.5));
      CHECK(jet[5] == Approx(1.4));
      // φ_t ∂ℓ/∂φ_t + φ_tx ∂ℓ/∂φ_tx − ℓ
      CHECK(stress_energy(density, jet, t, x).energy == Approx(0.5 * (jet[1] * jet[1] + 1.4 * 1.4) + 0.25));
    }
  }
  // around a circle a turn is added: φ = x, which gains L
  const Lattice circle = Lattice::circle(5, 2.0);
  CellJets jets(density, circle, h, 2.0);
  std::vector<double> y;
  for (int i = 0; i < 5; ++i) y.push_back(circle.position(i));
  for (const int cell : {0, 3, 4}) {
    const double* jet = jets.at(cell, y, y);
    CHECK(jet[2] == Approx(1));
    CHECK(std::abs(jet[5]) < 1e-13);
  }
  // two sites have no second differences
  CHECK(CellJets(density, Lattice::interval(2, 1.0), h, 0)
            .at(0, std::vector<double>{0, 1}, std::vector<double>{0, 1})[5] == 0);
}

}  // namespace delf

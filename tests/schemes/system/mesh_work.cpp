// SPDX-License-Identifier: MIT
#include "schemes/system/mesh_work.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A sin³(0.9 t), whose rate may be given wrong.
class Push final : public GivenInTime {
 public:
  Push(double amplitude, double of_rate) : amplitude_(amplitude), of_rate_(of_rate) {}
  double value(int, double t) const override { return amplitude_ * std::pow(std::sin(0.9 * t), 3); }
  double rate(int, double t) const override {
    return of_rate_ * amplitude_ * 2.7 * std::pow(std::sin(0.9 * t), 2) * std::cos(0.9 * t);
  }

 private:
  double amplitude_, of_rate_;
};

/// A strip of pendula at rest that is driven at the left, or pushed there by a flux.
std::shared_ptr<const MeshSpace> strip(bool by_flux, double of_rate) {
  auto space = std::make_shared<MeshSpace>(MeshSpace{rectangle_mesh(6, 0.4, 15, 2, true), {}});
  const std::vector<PartCondition> left{{"left", !by_flux}};
  space->fixed = held_points(space->mesh, false, left);
  for (const auto& [point, share] : side_shares(space->mesh, space->mesh.parts[0].sides)) {
    auto given = std::make_shared<Push>(by_flux ? 0.8 * share : 1.2, of_rate);
    (by_flux ? space->fluxes : space->driven).push_back({point, std::move(given)});
  }
  return space;
}

/// The largest gap of the energy less the work, over the largest energy.
double gap(const std::shared_ptr<const MeshSpace>& space, const std::string& method, double h) {
  Problem p;
  p.theory = "sine-gordon", p.method = method;
  p.lattice = Lattice::on(space);
  p.time_step = h;
  Simulation simulation(p);
  const auto values = at(p.lattice.sites()) * simulation.components().size();
  simulation.start_legendre(std::vector<double>(values, 0.0), std::vector<double>(values, 0.0));
  const LatticeSystem& system = simulation.evolution().system();
  const MeshEnergy energy(simulation.theory().shared_density(), *space);
  MeshWork work(system, simulation.theory().shared_density());
  double largest = 0, apart = 0;
  const std::size_t C = simulation.components().size();
  for (bool first = true; simulation.time(simulation.newest()) < 6; first = false) {
    if (!first) simulation.step();
    work.add(simulation.evolution().stepper().window(2));
    const double t = simulation.time(simulation.newest());
    std::vector<double> row(at(p.lattice.sites())), p_of_row;
    simulation.copy_row(0, row);
    const std::vector<double> all = simulation.momenta(0);
    for (std::size_t n = 0; n < all.size(); n += C) p_of_row.push_back(all[n]);
    std::vector<double> rates = energy.rates(row, p_of_row, t);
    work.give_rates(rates, t);
    const double E = energy(row, rates, t);
    largest = std::max(largest, std::abs(E)), apart = std::max(apart, std::abs(E - work.sum()));
  }
  CHECK(largest > 0.1);
  return apart / largest;
}

}  // namespace

TEST_CASE("the energy of a mesh less the work of its boundary stays, to the order of the method") {
  for (const bool by_flux : {false, true}) {
    CAPTURE(by_flux);
    const auto space = strip(by_flux, 1);
    CHECK(gap(space, "multisymplectic", 0.1) / gap(space, "multisymplectic", 0.05) == Approx(4).margin(0.4));
    CHECK(gap(space, "composition", 0.2) / gap(space, "composition", 0.1) == Approx(16).margin(2));
    // with rates that are not those of the motion it does not
    CHECK(gap(strip(by_flux, 0.99), "composition", 0.1) > 1e-4);
  }
}

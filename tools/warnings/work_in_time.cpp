// SPDX-License-Identifier: MIT
#include "tools/warnings/work_in_time.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "schemes/row_monitors.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/stress_energy.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

WorkInTime::WorkInTime(const Simulation& simulation, const Lattice& lattice, double monodromy)
    : simulation_(simulation), lattice_(lattice) {
  const BatchDensity& density = simulation.theory().density();
  const LatticeSystem& system = simulation.evolution().system();
  if (density.is_placed() && !system.moves() && !simulation.is_processed() && system.fields() == density.components())
    jets_.emplace(density, lattice, system.time_step(), monodromy);
}

void WorkInTime::see() {
  if (!jets_ || simulation_.newest() < 1 || simulation_.evolution().stepper().held() < 2) return;
  const std::int64_t newest = simulation_.newest();
  const double before = simulation_.time(newest - 1), after = simulation_.time(newest), t = 0.5 * (before + after);
  if (seen_ > 0 && !(t > all_.time)) return;  // rows 0 and 1 are one pair
  const std::vector<double> below = row_of(simulation_.evolution(), Role::field, 1),
                            above = row_of(simulation_.evolution(), Role::field, 0);
  const double k = lattice_.space_step();
  double power = 0;
  for (int i = 0; i < lattice_.cells(); ++i)
    power -=
        k * stress_energy(simulation_.theory().density(), jets_->at(i, below, above), t, lattice_.position(i) + 0.5 * k)
                .by_t;
  if (!std::isfinite(power)) return;
  step_ = after - before, largest_power_ = std::max(largest_power_, std::abs(power));
  if (seen_ == 0) {
    all_ = half_ = {0, t, power};
  } else {
    all_.take(t, power);
    if (seen_ % 2 == 0) half_.take(t, power);
  }
  ++seen_;
}

double WorkInTime::value() const {
  constexpr std::int64_t few = 5;
  return reads_time() && seen_ >= few ? all_.work : std::numeric_limits<double>::quiet_NaN();
}

double WorkInTime::uncertainty() const {
  Sum half = half_;
  if (half.time < all_.time) half.take(all_.time, all_.power);
  return std::abs(half.work - all_.work) + step_ * largest_power_;
}

void WorkInTime::visit(SavedState& state) {
  state("work of the density", all_), state("work on half of the rows", half_);
  state("largest power", largest_power_), state("last step", step_), state("rows that work", seen_);
}

}  // namespace delf

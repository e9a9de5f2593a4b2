// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/energy.hpp"

namespace delf {

using EnergyOfRows = std::function<EnergyMomentum(const RowsInTime&)>;

/// An energy that runs and checks observe: one constant of this type, and a line in energies.cpp. A run records one that
/// schemes are compared by as `energy`, and one that belongs to the scheme's own rows as `energy_own`.
struct EnergyEntry {
  std::string name;     ///< "quadratic invariant"
  std::string formula;  ///< and how well it is kept, in one line
  std::string source;
  std::string rows;  ///< energy_own: whose rows have it, "linear theories on two rows"
  /// Of the problem's theory and equations; nothing where there is none.
  EnergyOfRows (*make)(const FieldTheory&, const LatticeSystem&, const Problem&) = nullptr;
};
const std::vector<const EnergyEntry*>& energy_entries();

/// H(q, p) of a row, by the Legendre transform of the scheme itself.
extern const EnergyEntry hamiltonian_of_row;

/// What a run records as its energy: the method's, or that of the symmetric rectangle's jets.
const EnergyEntry& energy_of_run(const Problem&);

struct OwnEnergy {
  const EnergyEntry* entry;
  EnergyOfRows value;
};
/// The energy that the method of the problem declares for its rows, or else the quadratic invariant of a linear theory; nothing
/// where there is neither, and where the energy of the run is the method's own already. The simulation is that of the
/// problem.
std::optional<OwnEnergy> own_energy(const Simulation&, const Problem&);
/// Its value at the newest row; not a number as long as there is one row only.
double newest_own_energy(const OwnEnergy&, const Simulation&);

}  // namespace delf

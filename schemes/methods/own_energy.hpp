// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <optional>
#include <string>

#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// An energy that belongs to a scheme's own rows, beside the one that all schemes are compared by (energy_formula): what
/// the rows keep to round-off, or to the order of the method.
struct OwnEnergy {
  std::string name;     ///< "quadratic invariant"
  std::string meaning;  ///< its formula, and what is kept of it, in one line
  bool exact;           ///< rows that solve the equations keep it to round-off
  std::function<double(const RowsInTime&)> value;
};

/// The offer of a method: one constant of this type is in the file of the method, or beside it.
struct OwnEnergyEntry {
  std::string method;   ///< a MethodEntry's name
  std::string formula;  ///< for `delf help`
  /// The energy for the problem's theory and equations; nothing where there is none.
  std::optional<OwnEnergy> (*make)(const FieldTheory&, const LatticeSystem&, const Problem&);
};
/// A new one adds a line there.
const std::vector<const OwnEnergyEntry*>& own_energy_entries();

/// The one that the method of the problem offers, or else the quadratic invariant of a linear theory; nothing where there
/// is neither, and where the energy of the run is the method's own already. The simulation is that of the problem.
std::optional<OwnEnergy> own_energy(const Simulation&, const Problem&);
/// Its value at the newest row; not a number as long as there is one row only.
double newest_own_energy(const OwnEnergy&, const Simulation&);

/// The quadratic invariant of linear variational equations over two rows, A y₊ + B y + Aᵀ y₋ + c = 0: products of the
/// equation with y₊ and y₋ telescope, so I = y₊ᵀA y₊ + yᵀB y₊ + yᵀA y + cᵀ(y + y₊) is kept, and so is E = −I/2h. With
/// v = y₊ − y, m = ½(y + y₊) and Aₛ = ½(A + Aᵀ),
///
///     E = vᵀ (B − 2Aₛ)/(8h) v − mᵀ (B + 2Aₛ)/(2h) m − cᵀm/h
///
/// A, B and c are the constant parts of the equations. It is kinetic energy plus potential, but for a constant; for (5.12)
/// it is the energy of Marsden–Patrick–Shkoller's footnote 4. Nothing if the equations are not linear, depend on t or x, are
/// of more than two rows, or of more than fields.
std::optional<OwnEnergy> quadratic_invariant(const LatticeSystem&, int winding);
inline constexpr const char* quadratic_invariant_formula =
    "E = v'(B - 2A)v/8h - m'(B + 2A)m/2h with v = y+ - y, m = (y + y+)/2, A y+ + B y + A'y- the linear equations of "
    "the scheme itself; kept to round-off";

}  // namespace delf

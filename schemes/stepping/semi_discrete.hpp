// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <map>
#include <span>
#include <vector>

#include "lattice/matrix_entry.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Linear equations of velocities: entries at site · C + component, the row that of a value whose equation it is.
struct Bonds {
  std::vector<MatrixEntry> entries = {};
  bool slaved = false;
  std::map<int, double> rates = {};  ///< their right sides, by row; 0 where there is none
};

/// Energy and momentum at one row of an element, from the momenta p there, [i·C + c]. With the quadrature of the
/// element's lower side, L(y, v) = k Σ w ℓ(φ, φ_t, φ_x), φ_t = Σ φ_b v_b, is a Lagrangian of mechanics, and
///
///     H = p·v − L(y, v)   where   p = ∂L/∂v(y, v),         P = −k Σ w φ_x ∂ℓ/∂φ_t.
///
/// v is found by Newton's method with the mass matrix ∂²L/∂v∂v; it is zero at fixed walls. Not a number where that
/// finds none; where ℓ is linear in φ_t, H does not depend on v, and none is needed. Where values are bound, Σ ∂G/∂y v = 0
/// (or the bond's rate) holds too, and momenta are known up to forces: those of the bonds, −∂Gᵀ/∂y μ, or, for `slaved`,
/// any force on the value that each is the equation of.
EnergyMomentum semi_discrete_energy(const JetFamily&, const LatticeSystem&, const Window&, std::int64_t row,
                                    std::span<const double> p, const Bonds& = {});
/// Those velocities v, [i·C + c]; 0 where there are none, and not a number where none were found.
std::vector<double> semi_discrete_rates(const JetFamily&, const LatticeSystem&, const Window&, std::int64_t row,
                                        std::span<const double> p, const Bonds& = {});

}  // namespace delf

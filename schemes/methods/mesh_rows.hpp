// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "lattice/space/mesh.hpp"
#include "schemes/methods/method_registry.hpp"

namespace delf {

/// The usual method on a mesh: a table of time on its sites and cells, T in the middle of each step, and V at its ends,
///
///     S = Σ_j Σ_i A_i h_j T((y_i^{j+1} − y_i^j)/h_j) + Σ_j ½ h_j [V(y^j) + V(y^{j+1})],
///
/// explicit where T is quadratic. A constraint holds at every row, λ_j G(y^j): SHAKE on a mesh (Ryckaert, Ciccotti,
/// Berendsen, J. Comput. Phys. 23, 327, 1977). Where cells have steps of their own, AsynchronousStepper steps the same system.
const StencilTable& time_of_mesh_rows();
SchemeParts rows_on_mesh(const FieldTheory&, const Problem&);
/// h_K of cells with steps of their own: so many times the shortest edge of each.
std::vector<double> cell_steps(const Mesh&, double courant);

/// Steps that the field chooses and that a run back chooses again (StepDensity), h ≈ ε σ with
///
///     σ = 1/√(1 + s²⟨φ_t²⟩),    G = s²⟨φ_t·φ_tt⟩ / (1 + s²⟨φ_t²⟩),    ⟨f⟩ = Σ_i A_i f_i / Σ_i A_i:
///
/// rows as far apart as the path (t, sφ) of the field is long, in the mean over space. φ_t is that of the momenta of the row,
/// so G changes its sign with time. Throws BadInput where φ_tt does not follow from φ alone: T must be quadratic in φ_t,
/// without a constraint.
RowDensity density_of_mesh_rows(const RowsInTime&, std::span<const double> momenta, double strength);

}  // namespace delf

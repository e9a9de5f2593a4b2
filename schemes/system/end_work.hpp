// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "schemes/families/driven_end.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/system/momenta.hpp"

namespace delf {

/// The walls of a system that move as functions of time, each with its column.
using DrivenEnds = std::vector<std::pair<int, const DrivenEnd*>>;
DrivenEnds driven_ends(const LatticeSystem&);
/// True if the end gives the component a value there: a field at a vertex or at a node inside a cell, at its own time.
bool is_given(const LatticeSystem&, int column, int component, const DrivenEnd&);
/// A flux at a natural wall, as WallFlux has it in the action.
struct EndFlux {
  int column;
  FormulasOfTime flux;
};

/// The work that the ends of an interval do on the field. Without elements in time it is summed from row to row,
///
///     W += F_j (y_{j+1} − y_{j−1})/2,    F_j = −E_j/h at a driven wall,    F_j = f(t_j) of a flux,
///
/// with the residual E_j that the wall's own equation would have on the symmetric rectangle, whose jets the energy is of:
/// other stencils have another share of a wall's inertia. The energy of rows n − 1 and n less W is that of rows 0 and 1, as
/// far as the scheme keeps energies at all. With them −E is what the wall takes of an impulse at each node of time, and
/// up to row n
///
///     W = −Σ E ḟ(t of the node) + (p − ∂S/∂y of what lies below) ḟ, in row n less in the first row,    W = h Σ_q w_q f φ_t,
///
/// with p of the Legendre transform of the row: kept to the order of the method, and to order 2 at a driven wall of sub-steps,
/// between which it moves along straight lines. Where a method has tests of its own, E is tested by the functions of the field.
class EndWork {
 public:
  /// The density is that of the theory, and of its energy.
  EndWork(const LatticeSystem&, const std::shared_ptr<const BatchDensity>&, std::vector<EndFlux>);

  /// The work is one of elements: add() is called for the rows of the start too, before the first step.
  bool by_elements() const { return element_.has_value(); }
  /// Rows n − 2, n − 1 and n; of elements as many of them as there are.
  void add(const Window&);
  /// Up to the middle of rows n − 1 and n; of elements up to row n.
  double sum() const { return sum_; }

  /// SavedState, of a room above this one.
  template <class State>
  void visit(State& state) {
    state("work of the ends", sum_);
    if (element_) state("work at the newest row", at_row_), state("begun", begun_);
  }

 private:
  void add_step(const Window&);
  double flowed_in(const Window&) const;

  const LatticeSystem& system_;
  /// The density on the symmetric rectangle, or on an element tested by its own functions; none: the system itself, of
  /// densities with second derivatives and of other elements.
  std::optional<LatticeSystem> observed_;
  std::vector<EndFlux> fluxes_;
  DrivenEnds ends_;
  std::unique_ptr<const Assembly> walls_;  ///< the equations that driven walls would have; null: none is driven
  std::unique_ptr<const HalfEquations> below_, below_walls_;  ///< of elements; the second null: that of the first
  std::optional<StencilTable> element_;                       ///< in time, on the site of a wall
  double sum_ = 0;
  double at_row_ = 0;  ///< what the sum has of the newest row alone
  int begun_ = 0;
};

}  // namespace delf

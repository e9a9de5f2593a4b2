// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "schemes/families/driven_end.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The walls of a system that move as functions of time, each with its column.
using DrivenEnds = std::vector<std::pair<int, const DrivenEnd*>>;
DrivenEnds driven_ends(const LatticeSystem&);
/// Gives them their values in a row, y[i·C + c].
void set_driven_ends(const LatticeSystem&, const DrivenEnds&, std::int64_t row, std::span<double> y);
/// Something flows in at a wall.
bool has_flux(const LatticeSystem&);

/// A flux at a natural wall, as WallFlux has it in the action.
struct EndFlux {
  int column;
  FormulasOfTime flux;
};

/// The work that the ends of an interval do on the field, summed from row to row,
///
///     W += F_j (y_{j+1} − y_{j−1})/2,    F_j = −E_j/h at a driven wall,    F_j = f(t_j) of a flux,
///
/// with the residual E_j that the wall's own equation would have. The energy of rows n − 1 and n less W is that of rows 0 and
/// 1, as far as the scheme keeps energies at all.
class EndWork {
 public:
  EndWork(const LatticeSystem&, std::vector<EndFlux>);

  /// Rows n − 2, n − 1 and n.
  void add(const Window&);
  /// Between rows n − 1 and n.
  double sum() const { return sum_; }

  /// SavedState, of a room above this one.
  template <class State>
  void visit(State& state) {
    state("work of the ends", sum_);
  }

 private:
  const LatticeSystem& system_;
  std::vector<EndFlux> fluxes_;
  std::unique_ptr<const Assembly> walls_;  ///< the equations that driven walls would have; null: none is driven
  double sum_ = 0;
};

}  // namespace delf

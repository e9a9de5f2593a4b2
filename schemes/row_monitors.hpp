// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "schemes/methods/energies.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/assembled_row.hpp"

namespace delf {

/// The newest two rows, for what a method says of them.
RowsInTime newest_rows(const FieldTheory&, const Evolution&);
/// The components of one role of the row `back` rows before the newest, site by site.
std::vector<double> row_of(const Evolution&, Role, int back);

/// The quantities watched in the newest rows of a run: energy, momentum and charge, constraints, Noether's sums, and
/// those of the method. Arguments are kept by reference; work space is allocated when it is first asked.
class RowMonitors {
 public:
  RowMonitors(const Problem&, const FieldTheory&, const std::vector<LinearSymmetry>&, const Evolution&);

  Simulation::Monitors now();
  /// Noether's conserved quantities; none for stencils of more than two rows, which would need rows that are not held.
  const std::vector<std::string>& conserved_names() const { return conserved_names_; }
  std::size_t bytes() const;
  /// The value that bytes() will have once monitors were asked.
  std::size_t bytes_of_run() const;

 private:
  void prepare();
  void copy_newest_pair();
  void copy_observed_pair();
  EnergyMomentum energy_momentum() const;
  double charge() const;
  double constraint();
  void find_conserved(Simulation::Monitors&) const;
  const RowLayout& layout() const { return own_layout_ ? *own_layout_ : *stepper_.layout(); }

  const Problem& problem_;
  const MethodEntry& method_;
  EnergyOfRows energy_;  ///< the method's; none: that of the symmetric rectangle
  const FieldTheory& theory_;
  const std::vector<LinearSymmetry>& symmetries_;
  const Evolution& evolution_;
  const Stepper& stepper_;
  const LatticeSystem& system_;
  AssembledRow equations_;
  bool has_constraints_;
  int field_lag_;     ///< rows from the newest row of fields up to the newest slab
  double monodromy_;  ///< φ(x + L) − φ(x)
  std::vector<std::string> conserved_names_;
  std::unique_ptr<RowLayout> own_layout_;  ///< where steps do not go by rows
  RowBuffer cell_weights_, positions_, last_rows_;
  std::vector<const double*> monitored_;
};

}  // namespace delf

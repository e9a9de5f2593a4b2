// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "schemes/simulation.hpp"
#include "schemes/system/cell_jet.hpp"

namespace delf {

class SavedState;

/// The energy of a density that reads t is not conserved: it changes by the work
///
///     W = −∫∫ ∂ℓ/∂t dx dt,    E(t) − W(t) = E(0)
///
/// on jets of the symmetric rectangle of the rows that are seen, by the trapezium rule from one to the next.
class WorkInTime {
 public:
  WorkInTime(const Simulation&, const Lattice&, double monodromy);

  /// The newest two rows of the simulation.
  void see();
  /// True if ∂ℓ/∂t is not zero on a row that was seen.
  bool reads_time() const { return largest_power_ > 0; }
  /// W so far, 0 where nothing was seen to do work.
  double sum() const { return all_.work; }
  /// The same for reports; not a number where the density does not read t, or too few rows were seen.
  double value() const;
  /// The part of W that its records may have missed: what the rule on half of them differs by, and half a step's work.
  double uncertainty() const;
  void visit(SavedState&);

 private:
  const Simulation& simulation_;
  Lattice lattice_;
  std::optional<CellJets> jets_;  ///< none: the density reads neither t nor x, or the sites move
  struct Sum {
    double work = 0, time = 0, power = 0;
    void take(double t, double p) { work += 0.5 * (t - time) * (power + p), time = t, power = p; }
  };
  Sum all_, half_;
  double largest_power_ = 0, step_ = 0;
  std::int64_t seen_ = 0;
};

}  // namespace delf

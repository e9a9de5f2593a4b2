// SPDX-License-Identifier: MIT
#include <algorithm>

#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/cell_jet.hpp"
#include "schemes/system/stress_energy.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// The energy of the cells left of x, of the one that x cuts in proportion.
class EnergyLeft final : public Measurement {
 public:
  EnergyLeft(const MeasuredField& field, const std::vector<double>& numbers)
      : field_(field), x_(field.place(numbers[0])) {}

  void see(const MeasuredRow& row) override {
    time_ = row.time;
    above_.assign(row.row.begin(), row.row.end());
    below_.assign(row.other.begin(), row.other.end());
  }

  void visit(SavedState& state) override {
    state("time", time_), state("row above", above_), state("row below", below_);
  }

  // H = Σ k (φ_t ∂ℓ/∂φ_t − ℓ), on the jets of the symmetric rectangle; of a cut cell, what lies left of x
  double value() const override {
    if (below_.empty() || field_.lattice.space() == Space::point) return unknown;
    const double h = field_.time_step, k = field_.lattice.space_step();
    CellJets jets(field_.theory->density(), field_.lattice, h, field_.monodromy);
    double energy = 0;
    for (int i = 0; i < field_.lattice.cells(); ++i) {
      const double begin = field_.lattice.position(i), share = std::clamp(x_ - begin, 0.0, k);
      if (share == 0) break;
      energy +=
          share *
          stress_energy(field_.theory->density(), jets.at(i, below_, above_), time_ - 0.5 * h, begin + 0.5 * k).energy;
    }
    return energy;
  }

 private:
  MeasuredField field_;
  double x_, time_ = 0;
  std::vector<double> above_, below_;
};

}  // namespace

const MeasurementEntry energy_left_measurement{
    "energy_left",
    "x",
    "the energy left of x, in the last row and the one before it",
    1,
    1,
    [](const MeasuredField& field, const std::vector<double>& numbers) -> std::unique_ptr<Measurement> {
      return std::make_unique<EnergyLeft>(field, numbers);
    }};

}  // namespace delf

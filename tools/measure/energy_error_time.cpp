// SPDX-License-Identifier: MIT
#include <cmath>

#include "lattice/error.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// The first time at which |E − E₀| > level·|E₀|: how long a run keeps its energy.
class EnergyErrorTime final : public Measurement {
 public:
  explicit EnergyErrorTime(double level) : level_(level) {
    if (!(level > 0)) throw BadInput("", "the level must be positive; 0.01 is 1 %");
  }
  void see(const MeasuredRow& row) override {
    if (std::isnan(time_) && std::abs(row.energy_error) > level_) time_ = row.time;
  }
  double value() const override { return time_; }
  void visit(SavedState& state) override { state("time of the energy error", time_); }

 private:
  double level_, time_ = unknown;
};

}  // namespace

const MeasurementEntry energy_error_time_measurement{
    "energy_error_time",
    "level",
    "the first recorded time at which the energy is off by more than the level, relative to row 0; 0.01 is 1 %",
    1,
    1,
    [](const MeasuredField&, const std::vector<double>& numbers) -> std::unique_ptr<Measurement> {
      return std::make_unique<EnergyErrorTime>(numbers[0]);
    },
    false};

}  // namespace delf

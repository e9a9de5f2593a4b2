// SPDX-License-Identifier: MIT
#include <cmath>

#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

template <int sign>
class ExtremeEnergy final : public Measurement {
 public:
  void see(const MeasuredRow& row) override {
    if (std::isnan(most_) || sign * row.energy > sign * most_) most_ = row.energy;
  }
  double value() const override { return most_; }
  void visit(SavedState& state) override { state("extreme energy", most_); }

 private:
  double most_ = unknown;
};

template <int sign>
std::unique_ptr<Measurement> make_extreme_energy(const MeasuredField&, const std::vector<double>&) {
  return std::make_unique<ExtremeEnergy<sign>>();
}

}  // namespace

const MeasurementEntry energy_minimum_measurement{
    "energy_minimum", "", "the least energy of the recorded rows", 0, 0, make_extreme_energy<-1>, false};
const MeasurementEntry energy_maximum_measurement{
    "energy_maximum", "", "the largest energy of the recorded rows", 0, 0, make_extreme_energy<1>, false};

}  // namespace delf

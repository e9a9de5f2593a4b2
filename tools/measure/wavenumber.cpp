// SPDX-License-Identifier: MIT
#include <numbers>

#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"
#include "tools/measure/spectrum.hpp"

namespace delf {

namespace {

class Wavenumber final : public Measurement {
 public:
  explicit Wavenumber(const MeasuredField& field) : field_(field) {}
  // 2π m/L; on a circle without what the field gains around it
  void see(const MeasuredRow& row) override {
    const Lattice& lattice = field_.lattice;
    if (lattice.space() == Space::point) return;
    std::vector<double> values;
    for (int i = 0; i < lattice.cells(); ++i)
      values.push_back(field_.at(row.row, i) - field_.monodromy * i / lattice.cells());
    value_ = 2 * std::numbers::pi * spectrum_peak(values, lattice.is_circle()) / lattice.length();
  }
  double value() const override { return value_; }
  void visit(SavedState& state) override { state("wavenumber", value_); }

 private:
  MeasuredField field_;
  double value_ = unknown;
};

}  // namespace

const MeasurementEntry wavenumber_measurement{
    "wavenumber",
    "",
    "of the strongest wave in the last row: the largest peak of its spectrum",
    0,
    0,
    [](const MeasuredField& field, const std::vector<double>&) -> std::unique_ptr<Measurement> {
      return std::make_unique<Wavenumber>(field);
    }};

}  // namespace delf

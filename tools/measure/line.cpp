// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>

#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// The amplitude of a line of the spectrum in time, |2 Σ_j w_j (f_j − f̄) e^{−iωt_j}|/Σ_j w_j, with Hann's window over a time T
/// that must be known before it is seen: w = 1 − cos(2πt/T).
class Line final : public Measurement {
 public:
  Line(const MeasuredField& field, const std::vector<double>& numbers)
      : field_(field), x_(field.place(numbers[0])), omega_(numbers[1]), until_(numbers[2]) {}
  bool sees_steps() const override { return true; }
  void see(const MeasuredRow& row) override {
    if (row.time > until_ * (1 + 1e-12)) return;
    const double w = 1 - std::cos(2 * std::numbers::pi * row.time / until_), f = field_.at(row.row, x_);
    const double c = std::cos(omega_ * row.time), s = std::sin(omega_ * row.time);
    sums_.f += w * f, sums_.c += w * c, sums_.s += w * s, sums_.fc += w * f * c, sums_.fs += w * f * s, sums_.w += w;
  }
  double value() const override {
    const double mean = sums_.f / sums_.w;
    return 2 * std::hypot(sums_.fc - mean * sums_.c, sums_.fs - mean * sums_.s) / sums_.w;
  }
  void visit(SavedState& state) override { state("sums of a line", sums_); }

 private:
  MeasuredField field_;
  double x_, omega_, until_;
  struct Sums {
    double w, f, c, s, fc, fs;
  } sums_{};
};

}  // namespace

const MeasurementEntry line_measurement{
    "spectral_line",
    "x, omega, T",
    "the amplitude of the oscillation of frequency omega at x, over the time from 0 to T: a line of its spectrum",
    3,
    3,
    make_measurement<Line>};

}  // namespace delf

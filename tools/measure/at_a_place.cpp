// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>

#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"
#include "tools/measure/spectrum.hpp"

namespace delf {

namespace {

/// φ at one place, over time.
class AtAPlace : public Measurement {
 public:
  AtAPlace(const MeasuredField& field, double x) : field_(field), x_(field.place(x)) {}
  void see(const MeasuredRow& row) override {
    times_.push_back(row.time);
    values_.push_back(field_.at(row.row, x_));
  }

  void visit(SavedState& state) override { state("times at a place", times_), state("values at a place", values_); }

 protected:
  std::vector<double> times_, values_;

 private:
  MeasuredField field_;
  double x_;
};

class Last final : public AtAPlace {
 public:
  Last(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  void see(const MeasuredRow& row) override {
    times_.clear(), values_.clear();
    AtAPlace::see(row);
  }
  double value() const override { return values_.empty() ? unknown : values_.back(); }
};

/// The largest value, or its time: of the parabola through the largest recorded value and those before and after it.
template <int sign, bool of_time>
class Extreme final : public AtAPlace {
 public:
  Extreme(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  double value() const override {
    if (values_.empty()) return unknown;
    const auto larger = [](double a, double b) { return sign * a < sign * b; };
    const auto j = static_cast<std::size_t>(std::ranges::max_element(values_, larger) - values_.begin());
    if (j == 0 || j + 1 == values_.size()) return of_time ? times_[j] : values_[j];
    // f = b + ½(c − a)s + ½(a − 2b + c)s²,   largest at s = ½(a − c)/(a − 2b + c)
    const double a = values_[j - 1], b = values_[j], c = values_[j + 1], curvature = a - 2 * b + c;
    const double s = curvature == 0 ? 0 : 0.5 * (a - c) / curvature;
    const bool even = std::abs(times_[j + 1] - 2 * times_[j] + times_[j - 1]) < 1e-9 * (times_[j + 1] - times_[j - 1]);
    if (!even) return of_time ? times_[j] : b;
    return of_time ? times_[j] + s * (times_[j + 1] - times_[j]) : b - 0.25 * (a - c) * s;
  }
};

class Crossings final : public AtAPlace {
 public:
  Crossings(const MeasuredField& field, const std::vector<double>& numbers)
      : AtAPlace(field, numbers[0]), level_(numbers[1]) {}
  double value() const override {
    if (values_.empty()) return unknown;
    int count = 0;
    for (std::size_t j = 1; j < values_.size(); ++j) count += (values_[j - 1] < level_) != (values_[j] < level_);
    return count;
  }

 private:
  double level_;
};

class Frequency final : public AtAPlace {
 public:
  Frequency(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  // ω = 2π m/(n Δt); the last row, which may come early, is left out
  double value() const override {
    if (values_.size() < 9) return unknown;
    const std::size_t n = values_.size() - 1;
    return 2 * std::numbers::pi * spectrum_peak(std::span(values_).first(n), false) /
           (static_cast<double>(n) * (times_[1] - times_[0]));
  }
};

template <class Kind>
std::unique_ptr<Measurement> make(const MeasuredField& field, const std::vector<double>& numbers) {
  return std::make_unique<Kind>(field, numbers);
}

}  // namespace

const MeasurementEntry value_measurement{"value", "x", "the field at x, in the last row", 1, 1, make<Last>};
const MeasurementEntry minimum_measurement{"minimum", "x", "the least value at x", 1, 1, make<Extreme<-1, false>>};
const MeasurementEntry maximum_measurement{"maximum", "x", "the largest value at x", 1, 1, make<Extreme<1, false>>};
const MeasurementEntry minimum_time_measurement{"minimum_time",         "x", "when the field at x is least", 1, 1,
                                                make<Extreme<-1, true>>};
const MeasurementEntry maximum_time_measurement{"maximum_time",        "x", "when the field at x is largest", 1, 1,
                                                make<Extreme<1, true>>};
const MeasurementEntry crossings_measurement{
    "crossings", "x, level", "how often the field at x passes the level, from recorded row to recorded row",
    2,           2,          make<Crossings>};
const MeasurementEntry frequency_measurement{
    "frequency", "x", "2 pi/period of the strongest oscillation at x: the largest peak of its spectrum",
    1,           1,   make<Frequency>};

}  // namespace delf

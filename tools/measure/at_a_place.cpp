// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"
#include "tools/measure/spectrum.hpp"

namespace delf {

namespace {

/// φ at one place, over the rows of all steps.
class AtAPlace : public Measurement {
 public:
  AtAPlace(const MeasuredField& field, double x) : field_(field), x_(field.place(x)) {}
  bool sees_steps() const override { return true; }
  void see(const MeasuredRow& row) final { see(Sample{row.time, field_.at(row.row, x_)}); }

 protected:
  struct Sample {
    double time = unknown, value = unknown;
  };

 private:
  virtual void see(const Sample&) = 0;

  MeasuredField field_;
  double x_;
};

class Last final : public AtAPlace {
 public:
  Last(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  bool sees_steps() const override { return false; }
  double value() const override { return last_.value; }
  void visit(SavedState& state) override { state("last at a place", last_); }

 private:
  void see(const Sample& now) override { last_ = now; }

  Sample last_;
};

/// The largest value, or its time: of the parabola through the largest value and those one step before and after it.
template <int sign, bool of_time>
class Extreme final : public AtAPlace {
 public:
  Extreme(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  double value() const override {
    const auto& [a, b, c] = around_;
    // f = b + ½(c − a)s + ½(a − 2b + c)s²,   largest at s = ½(a − c)/(a − 2b + c)
    const double curvature = a.value - 2 * b.value + c.value, slope = 0.5 * (a.value - c.value);
    const bool even = std::abs(c.time - 2 * b.time + a.time) < 1e-9 * (c.time - a.time);
    if (!even || curvature == 0) return of_time ? b.time : b.value;  // at an end of the run too
    const double s = slope / curvature;
    return of_time ? b.time + s * (c.time - b.time) : b.value - 0.5 * slope * s;
  }
  void visit(SavedState& state) override { state("extreme at a place", around_), state("last at a place", last_); }

 private:
  void see(const Sample& now) override {
    if (std::isnan(around_.largest.value) || sign * now.value > sign * around_.largest.value)
      around_ = {last_, now, {}};
    else if (std::isnan(around_.after.time)) around_.after = now;
    last_ = now;
  }

  struct Around {
    Sample before, largest, after;
  } around_;
  Sample last_;
};

class Crossings final : public AtAPlace {
 public:
  Crossings(const MeasuredField& field, const std::vector<double>& numbers)
      : AtAPlace(field, numbers[0]), level_(numbers[1]) {}
  double value() const override { return std::isnan(last_.time) ? unknown : static_cast<double>(count_); }
  void visit(SavedState& state) override { state("crossings", count_), state("last at a place", last_); }

 private:
  void see(const Sample& now) override {
    if (!std::isnan(last_.time) && (last_.value < level_) != (now.value < level_)) ++count_;
    last_ = now;
  }

  double level_;
  std::int64_t count_ = 0;
  Sample last_;
};

/// ω = 2π m/(n Δt), m the peak of the spectrum of n values Δt apart. What they say is held against the mean square of the
/// rate of change from step to step, ω̄² = ⟨φ_t²⟩/⟨(φ − ⟨φ⟩)²⟩: there is no answer from less than a period, ω̄ n Δt < 2π, nor
/// beyond Nyquist's frequency, ω̄ Δt > π, where a slower wave has the same values.
class Frequency final : public AtAPlace {
 public:
  Frequency(const MeasuredField& field, const std::vector<double>& numbers) : AtAPlace(field, numbers[0]) {}
  double value() const override {
    const std::size_t n = values_.size();
    if (n < 8 || !(rates_ > 0)) return unknown;
    const double apart = static_cast<double>(apart_) * step_, m = spectrum_peak(values_, false);
    const double variance = squares_ / static_cast<double>(seen_) - std::pow(sum_ / static_cast<double>(seen_), 2);
    const double mean = std::sqrt(rates_ / static_cast<double>(seen_ - 1) / variance);
    const bool is_resolved =
        mean * apart <= std::numbers::pi && mean * apart * static_cast<double>(n) >= 2 * std::numbers::pi;
    if (!is_resolved || !(m > 1)) return unknown;
    return 2 * std::numbers::pi * m / (static_cast<double>(n) * apart);
  }
  void visit(SavedState& state) override {
    state("values at a place", values_), state("steps between values", apart_), state("values seen", seen_);
    state("first at a place", first_), state("last at a place", last_), state("step", step_);
    state("sum at a place", sum_), state("squares at a place", squares_), state("rates at a place", rates_);
  }

 private:
  void see(const Sample& now) override {
    constexpr std::size_t capacity = 1 << 16;
    if (seen_ == 0) first_ = now;
    else {
      if (seen_ == 1) step_ = now.time - last_.time;
      rates_ += std::pow((now.value - last_.value) / (now.time - last_.time), 2);
    }
    sum_ += now.value - first_.value, squares_ += std::pow(now.value - first_.value, 2);
    if (values_.size() == capacity) {  // full: every second one is dropped
      for (std::size_t i = 0; i < capacity / 2; ++i) values_[i] = values_[2 * i];
      values_.resize(capacity / 2);
      apart_ *= 2;
    }
    if (seen_++ % apart_ == 0) values_.push_back(now.value);
    last_ = now;
  }

  std::vector<double> values_;
  std::int64_t apart_ = 1, seen_ = 0;
  double step_ = 0, sum_ = 0, squares_ = 0, rates_ = 0;
  Sample first_, last_;
};

}  // namespace

const MeasurementEntry value_measurement{"value", "x", "the field at x, in the last row", 1, 1, make_measurement<Last>};
const MeasurementEntry minimum_measurement{"minimum", "x", "the least value at x, of all steps",
                                           1,         1,   make_measurement<Extreme<-1, false>>};
const MeasurementEntry maximum_measurement{"maximum", "x", "the largest value at x, of all steps",
                                           1,         1,   make_measurement<Extreme<1, false>>};
const MeasurementEntry minimum_time_measurement{
    "minimum_time", "x", "when the field at x is least", 1, 1, make_measurement<Extreme<-1, true>>};
const MeasurementEntry maximum_time_measurement{
    "maximum_time", "x", "when the field at x is largest", 1, 1, make_measurement<Extreme<1, true>>};
const MeasurementEntry crossings_measurement{
    "crossings", "x, level", "how often the field at x passes the level, from step to step",
    2,           2,          make_measurement<Crossings>};
const MeasurementEntry frequency_measurement{
    "frequency",
    "x",
    "2 pi/period of the strongest oscillation at x: the largest peak of its spectrum; none of less than a period",
    1,
    1,
    make_measurement<Frequency>};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdint>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// Four numbers of successive rows, one step apart, and the polynomial of degree 3 through them.
struct FourInTime {
  double times[4], values[4];
  std::int64_t seen = 0;

  void add(double time, double value) {
    for (int m = 0; m < 3; ++m) times[m] = times[m + 1], values[m] = values[m + 1];
    times[3] = time, values[3] = value, ++seen;
  }
  double at(double t) const {
    double sum = 0;
    for (int m = 0; m < 4; ++m) {
      double weight = values[m];
      for (int n = 0; n < 4; ++n)
        if (n != m) weight *= (t - times[n]) / (times[m] - times[n]);
      sum += weight;
    }
    return sum;
  }
  /// The root of at(t) = 0 between the middle two, where it changes its sign there.
  double root() const {
    double low = times[1], high = times[2];
    for (int halvings = 0; halvings < 60; ++halvings) {
      const double middle = 0.5 * (low + high);
      ((at(middle) < 0) == (values[1] < 0) ? low : high) = middle;
    }
    return 0.5 * (low + high);
  }
};

std::int64_t counting_number(double n) {
  if (!(n >= 1 && n == std::round(n))) throw BadInput("", "passages are counted 1, 2, ...; choose one of them");
  return static_cast<std::int64_t>(n);
}

/// The time of the n-th passage of a level at x, or in the section φ = level of a point the value of a field at it.
class Passage : public Measurement {
 public:
  bool sees_steps() const override { return true; }
  void see(const MeasuredRow& row) override {
    level_now_.add(row.time, here(row) - level_), other_now_.add(row.time, other(row));
    if (level_now_.seen < 4 || !std::isnan(found_)) return;
    const bool before = level_now_.values[1] < 0, after = level_now_.values[2] < 0;
    if (before == after || (upwards_ && !before) || ++count_ < number_) return;
    const double t = level_now_.root();
    found_ = upwards_ ? other_now_.at(t) : t;
  }
  double value() const override { return found_; }
  void visit(SavedState& state) override {
    state("four in time", level_now_), state("four of another", other_now_), state("passages", count_);
    state("passage", found_);
  }

 protected:
  Passage(const MeasuredField& field, double level, double number, bool upwards)
      : field_(field), level_(level), number_(counting_number(number)), upwards_(upwards) {}
  MeasuredField field_;

 private:
  virtual double here(const MeasuredRow&) const = 0;
  virtual double other(const MeasuredRow&) const { return 0; }

  double level_, found_ = unknown;
  std::int64_t number_, count_ = 0;
  bool upwards_;
  FourInTime level_now_{}, other_now_{};
};

class CrossingTime final : public Passage {
 public:
  CrossingTime(const MeasuredField& field, const std::vector<double>& numbers)
      : Passage(field, numbers[1], numbers[2], false), x_(field.place(numbers[0])) {}

 private:
  double here(const MeasuredRow& row) const override { return field_.at(row.row, x_); }
  double x_;
};

class SectionValue final : public Passage {
 public:
  SectionValue(const MeasuredField& field, const std::vector<double>& numbers)
      : Passage(field, numbers[1], numbers[2], true), of_(at(numbers[0]) - 1) {
    if (field.lattice.space() != Space::point || !(numbers[0] >= 1 && numbers[0] <= field.fields))
      throw BadInput("", "sections are those of a point, and its coordinates are 1, 2, ...; choose one of them");
  }

 private:
  double here(const MeasuredRow& row) const override { return row.row[0]; }
  double other(const MeasuredRow& row) const override { return row.row[of_]; }
  std::size_t of_;
};

}  // namespace

const MeasurementEntry crossing_time_measurement{"crossing_time",
                                                 "x, level, n",
                                                 "when the field at x passes the level for the n-th time, up or down",
                                                 3,
                                                 3,
                                                 make_measurement<CrossingTime>};
const MeasurementEntry section_value_measurement{
    "section_value",
    "a, level, n",
    "on a point: coordinate a where the first one rises through the level for the n-th time",
    3,
    3,
    make_measurement<SectionValue>};

}  // namespace delf

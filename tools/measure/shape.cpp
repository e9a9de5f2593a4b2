// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

/// A number of a row, kept of the last one.
class OfLastRow : public Measurement {
 public:
  explicit OfLastRow(const MeasuredField& field) : field_(field) {}
  void see(const MeasuredRow& row) final { now_ = of(row.row); }
  double value() const final { return now_; }
  void visit(SavedState& state) final { state("of the last row", now_); }

 protected:
  MeasuredField field_;

 private:
  virtual double of(std::span<const double> row) const = 0;

  double now_ = unknown;
};

/// Σ' φ_i/Σ' 1; Σ': the ends of an interval count half.
class Mean final : public OfLastRow {
 public:
  Mean(const MeasuredField& field, const std::vector<double>&) : OfLastRow(field) {}

 private:
  double of(std::span<const double> row) const override {
    const int sites = field_.lattice.sites();
    double sum = 0, shares = 0;
    for (int i = 0; i < sites; ++i) {
      const bool end = field_.lattice.space() == Space::interval && (i == 0 || i + 1 == sites);
      const double share = end ? 0.5 : 1.0;
      sum += share * field_.at(row, i), shares += share;
    }
    return sum / shares;
  }
};

/// The distance between the first places from the left where a row passes two levels, on straight lines between sites.
class Width final : public OfLastRow {
 public:
  Width(const MeasuredField& field, const std::vector<double>& numbers)
      : OfLastRow(field), low_(numbers[0]), high_(numbers[1]) {}

 private:
  double of(std::span<const double> row) const override { return std::abs(place(row, high_) - place(row, low_)); }

  double place(std::span<const double> row, double level) const {
    for (int i = 0; i + 1 < field_.lattice.sites() + (field_.lattice.is_circle() ? 1 : 0); ++i) {
      const double a = field_.at(row, i) - level, b = field_.at(row, i + 1) - level;
      if ((a < 0) != (b < 0)) return (i + a / (a - b)) * field_.lattice.space_step();
    }
    return unknown;
  }

  double low_, high_;
};

/// The n-th highest peak of a row, or where it is: of the parabola through the highest site and those beside it.
template <bool of_place>
class Peak final : public OfLastRow {
 public:
  Peak(const MeasuredField& field, const std::vector<double>& numbers) : OfLastRow(field) {
    if (!(numbers[0] >= 1 && numbers[0] == std::round(numbers[0])))
      throw BadInput("", "peaks are 1, 2, ... from the highest; choose one of them");
    number_ = at(numbers[0]);
  }

 private:
  double of(std::span<const double> row) const override {
    std::vector<std::pair<double, double>> peaks;  // height, place
    const int ends = field_.lattice.is_circle() ? 0 : 1;
    // Where a field is flat its last digits have hills of their own, which are no peaks.
    double size = 0;
    for (const double value : row) size = std::max(size, std::abs(value));
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * size;
    for (int i = ends; i < field_.lattice.sites() - ends; ++i) {
      const double a = field_.at(row, i - 1), b = field_.at(row, i), c = field_.at(row, i + 1);
      if (!(b > a && b >= c && b - std::min(a, c) > rounding)) continue;
      // f = b + ½(c − a)s + ½(a − 2b + c)s²,   largest at s = ½(a − c)/(a − 2b + c)
      const double s = 0.5 * (a - c) / (a - 2 * b + c);
      peaks.emplace_back(b + 0.25 * (c - a) * s, field_.lattice.position(i) + s * field_.lattice.space_step());
    }
    if (peaks.size() < number_) return unknown;
    std::ranges::sort(peaks, std::greater{});
    return of_place ? peaks[number_ - 1].second : peaks[number_ - 1].first;
  }

  std::size_t number_;
};

}  // namespace

const MeasurementEntry mean_measurement{"mean", "", "the mean of the field over the last row",
                                        0,      0,  make_measurement<Mean>};
const MeasurementEntry pulse_width_measurement{
    "pulse_width",
    "low, high",
    "how far apart the first places from the left are where the last row passes these two levels",
    2,
    2,
    make_measurement<Width>};
const MeasurementEntry peak_measurement{"peak", "n", "the height of the n-th highest peak of the last row",
                                        1,      1,   make_measurement<Peak<false>>};
const MeasurementEntry peak_position_measurement{
    "peak_position", "n", "where the n-th highest peak of the last row is", 1, 1, make_measurement<Peak<true>>};

}  // namespace delf

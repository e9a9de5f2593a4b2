// SPDX-License-Identifier: MIT
#include "tools/measure/kinks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

std::vector<KinkAt> kinks_of(const MeasuredField& field, std::span<const double> row, double level) {
  constexpr double period = 2 * std::numbers::pi;
  const Lattice& lattice = field.lattice;
  std::vector<KinkAt> kinks;
  if (lattice.space() == Space::point) return kinks;
  // n(φ) = ⌊(φ − level)/2π⌋ changes by one at each level
  const auto sheet = [&](double phi) {
    return field.angle ? std::floor((phi - level) / period) : phi < level ? -1.0 : 0.0;
  };
  for (int i = 0; i < lattice.cells(); ++i) {
    const double a = field.at(row, i), b = field.at(row, i + 1), from = sheet(a), to = sheet(b);
    // A field that grows without bound turns any number of times in a cell: these are no kinks.
    constexpr double most_turns = 8;
    if (!std::isfinite(a) || !std::isfinite(b) || from == to || std::abs(to - from) > most_turns) continue;
    const int sign = to > from ? 1 : -1;
    const std::size_t first = kinks.size();
    for (double n = std::min(from, to) + 1; n <= std::max(from, to); ++n)
      kinks.push_back({lattice.position(i) + lattice.space_step() * (level + n * period - a) / (b - a), sign});
    if (sign < 0) std::reverse(kinks.begin() + static_cast<std::ptrdiff_t>(first), kinks.end());
  }
  return kinks;
}

namespace {

constexpr double pi = std::numbers::pi;

// Halfway between vacua: π of an angle, or else 0, as in phi4.
double level_of(const MeasuredField& field, const std::vector<double>& numbers, std::size_t at) {
  return numbers.size() > at ? numbers[at] : field.angle ? pi : 0.0;
}

template <bool with_sign>
class Count final : public Measurement {
 public:
  Count(const MeasuredField& field, const std::vector<double>& numbers)
      : field_(field), level_(level_of(field, numbers, 0)) {}
  void see(const MeasuredRow& row) override {
    count_ = 0;
    for (const KinkAt& kink : kinks_of(field_, row.row, level_)) count_ += with_sign ? kink.sign : 1;
  }
  double value() const override { return count_; }
  void visit(SavedState& state) override { state("kinks", count_); }

 private:
  MeasuredField field_;
  double level_, count_ = unknown;
};

// n = ±1, ±2, …
int number_of_kink(double n) {
  constexpr double most = 1e6;
  if (n == 0 || n != std::floor(n) || !(std::abs(n) <= most))
    throw BadInput("",
                   fmt::format("there is no kink {:.6g}; kinks are 1, 2, ... from the left and -1, -2, ... from the "
                               "right",
                               n));
  return static_cast<int>(n);
}

/// The n-th kink, counted from 1 at the left end, or from −1 at the right end.
class OneKink : public Measurement {
 public:
  OneKink(const MeasuredField& field, const std::vector<double>& numbers)
      : field_(field), number_(number_of_kink(numbers[0])), level_(level_of(field, numbers, 1)) {}
  void see(const MeasuredRow& row) override {
    const std::vector<KinkAt> kinks = kinks_of(field_, row.row, level_);
    // another number of kinks: this one may have become another
    if (kinks.size() != kinks_) times_.clear(), places_.clear();
    kinks_ = kinks.size();
    const int count = static_cast<int>(kinks.size()), index = number_ > 0 ? number_ - 1 : count + number_;
    if (index < 0 || index >= count) return;
    double x = kinks[index].x;
    if (field_.lattice.is_circle() && !places_.empty())  // round the circle without a jump
      x = places_.back() + std::remainder(x - places_.back(), field_.lattice.length());
    times_.push_back(row.time);
    places_.push_back(x);
  }

  void visit(SavedState& state) override {
    state("number of kinks", kinks_), state("times of a kink", times_), state("places of a kink", places_);
  }

 protected:
  const MeasuredField& field() const { return field_; }
  std::vector<double> times_, places_;

 private:
  MeasuredField field_;
  int number_;
  double level_;
  std::size_t kinks_ = 0;
};

class Position final : public OneKink {
 public:
  using OneKink::OneKink;
  double value() const override {
    if (places_.empty()) return unknown;
    const double L = field().lattice.length(), x = places_.back();
    return field().lattice.is_circle() ? x - L * std::floor(x / L) : x;
  }
};

/// The slope of the straight line through its last positions: the last fifth of those since the number of kinks changed.
class Speed final : public OneKink {
 public:
  using OneKink::OneKink;
  double value() const override {
    const std::size_t n = std::max<std::size_t>(2, times_.size() / 5);
    if (times_.size() < n) return unknown;
    double t = 0, x = 0, xt = 0, tt = 0;
    const std::size_t first = times_.size() - n;
    for (std::size_t j = first; j < times_.size(); ++j) t += times_[j], x += places_[j];
    t /= static_cast<double>(n), x /= static_cast<double>(n);
    for (std::size_t j = first; j < times_.size(); ++j)
      xt += (places_[j] - x) * (times_[j] - t), tt += (times_[j] - t) * (times_[j] - t);
    return xt / tt;
  }
};

}  // namespace

const MeasurementEntry kinks_measurement{"kinks",
                                         "[level]",
                                         "how many kinks and antikinks the last row has: places where it passes the "
                                         "level (pi modulo 2 pi for an angle, else 0)",
                                         0,
                                         1,
                                         make_measurement<Count<false>>};
const MeasurementEntry charge_measurement{
    "kink_charge", "[level]", "kinks less antikinks in the last row", 0, 1, make_measurement<Count<true>>};
const MeasurementEntry position_measurement{
    "position",
    "n [, level]",
    "where kink n is in the last row: from the left 1, 2, ..., from the right -1, -2, ...",
    1,
    2,
    make_measurement<Position>};
const MeasurementEntry speed_measurement{
    "speed",
    "n [, level]",
    "of kink n at the end: the slope of its positions in the last fifth of the time since the number of kinks changed",
    1,
    2,
    make_measurement<Speed>};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/measure/kinks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <optional>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "tools/measure/entries.hpp"

namespace delf {

namespace {

constexpr double pi = std::numbers::pi, period = 2 * pi;

/// A minimum of −ℓ(φ, 0, 0) near φ, by Newton's method; nothing where it does not stay within `width`.
std::optional<double> minimum_near(const BatchDensity& density, double start, double width) {
  const ScratchRows phi(1, lanes), slope(1, lanes), curvature(1, lanes);
  double at = start;
  for (int iteration = 0; iteration < 20; ++iteration) {
    std::fill_n(phi[0], lanes, at);
    density.slope({lanes, phi.data()}, slope.data());
    density.curvature({lanes, phi.data()}, curvature.data());
    const double step = slope[0][0] / curvature[0][0];
    if (!std::isfinite(step)) break;  // of a flat minimum, such as that of phi^4
    at -= step;
    if (!(std::abs(at - start) <= width)) return std::nullopt;
  }
  return at;
}

}  // namespace

std::vector<double> levels_between_vacua(const MeasuredField& field, std::span<const double> row) {
  if (field.angle) return {pi};
  const BatchDensity& density = field.theory->density();
  if (!density.formula() || density.components() > 1 || density.is_placed()) return {0.0};
  const auto [least, most] = std::ranges::minmax(row);
  const double margin = 0.25 * (most - least), from = least - margin, to = most + margin;
  constexpr int points = 64 * lanes;
  const ScratchRows jet(density.variables(), points), l(1, points);
  for (int a = 0; a < density.variables(); ++a) std::fill_n(jet[a], points, 0.0);
  for (int i = 0; i < points; ++i) jet[0][i] = from + (to - from) * i / (points - 1);
  density.value({points, jet.data()}, l[0]);
  std::vector<double> vacua, levels;
  for (int i = 1; i + 1 < points; ++i)
    if (l[0][i] > l[0][i - 1] && l[0][i] >= l[0][i + 1])
      if (const auto vacuum = minimum_near(density, jet[0][i], 2 * (to - from) / points)) vacua.push_back(*vacuum);
  for (std::size_t n = 1; n < vacua.size(); ++n) levels.push_back(std::midpoint(vacua[n - 1], vacua[n]));
  return levels.empty() ? std::vector<double>{0.0} : levels;
}

std::vector<KinkAt> kinks_of(const MeasuredField& field, std::span<const double> row, std::span<const double> levels) {
  const Lattice& lattice = field.lattice;
  std::vector<KinkAt> kinks;
  if (lattice.space() == Space::point) return kinks;
  // n(φ) = ⌊(φ − level)/2π⌋, or the number of levels up to φ, changes by one at each level
  const auto sheet = [&](double phi) {
    return field.angle ? std::floor((phi - levels[0]) / period)
                       : static_cast<double>(std::ranges::upper_bound(levels, phi) - levels.begin());
  };
  const auto level = [&](double n) { return field.angle ? levels[0] + n * period : levels[std::lround(n) - 1]; };
  for (int i = 0; i < lattice.cells(); ++i) {
    const double a = field.at(row, i), b = field.at(row, i + 1), from = sheet(a), to = sheet(b);
    // A field that grows without bound turns any number of times in a cell: these are no kinks.
    constexpr double most_turns = 8;
    if (!std::isfinite(a) || !std::isfinite(b) || from == to || std::abs(to - from) > most_turns) continue;
    const int sign = to > from ? 1 : -1;
    const std::size_t first = kinks.size();
    for (double n = std::min(from, to) + 1; n <= std::max(from, to); ++n)
      kinks.push_back({lattice.position(i) + lattice.space_step() * (level(n) - a) / (b - a), sign});
    if (sign < 0) std::reverse(kinks.begin() + static_cast<std::ptrdiff_t>(first), kinks.end());
  }
  return kinks;
}

namespace {

/// The levels that kinks pass: the number that is given, or those between the vacua near the first row that is seen.
class Levels {
 public:
  Levels(const std::vector<double>& numbers, std::size_t at) {
    if (numbers.size() > at) levels_ = {numbers[at]};
  }
  const std::vector<double>& of(const MeasuredField& field, std::span<const double> row) {
    if (levels_.empty()) levels_ = levels_between_vacua(field, row);
    return levels_;
  }
  void visit(SavedState& state) { state("levels of kinks", levels_); }

 private:
  std::vector<double> levels_;
};

template <bool with_sign>
class Count final : public Measurement {
 public:
  Count(const MeasuredField& field, const std::vector<double>& numbers) : field_(field), levels_(numbers, 0) {}
  void see(const MeasuredRow& row) override {
    count_ = 0;
    for (const KinkAt& kink : kinks_of(field_, row.row, levels_.of(field_, row.row)))
      count_ += with_sign ? kink.sign : 1;
  }
  double value() const override { return count_; }
  void visit(SavedState& state) override { levels_.visit(state), state("kinks", count_); }

 private:
  MeasuredField field_;
  Levels levels_;
  double count_ = unknown;
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
      : field_(field), number_(number_of_kink(numbers[0])), levels_(numbers, 1) {}
  void see(const MeasuredRow& row) override {
    const std::vector<KinkAt> kinks = kinks_of(field_, row.row, levels_.of(field_, row.row));
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
    levels_.visit(state);
    state("number of kinks", kinks_), state("times of a kink", times_), state("places of a kink", places_);
  }

 protected:
  const MeasuredField& field() const { return field_; }
  std::vector<double> times_, places_;

 private:
  MeasuredField field_;
  int number_;
  Levels levels_;
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

const MeasurementEntry kinks_measurement{
    "kinks",
    "[level]",
    "how many kinks and antikinks the last row has: places where it passes the "
    "level (pi modulo 2 pi for an angle, halfway between vacua of a density in text, else 0)",
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

// SPDX-License-Identifier: MIT
#include "tools/figures/thinned_rows.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

namespace {

constexpr std::size_t most_frames = 600;

void drop_every_second(std::vector<double>& all, std::size_t width) {
  const std::size_t kept = all.size() / width / 2;
  for (std::size_t f = 1; f < kept; ++f)
    std::copy_n(all.begin() + static_cast<std::ptrdiff_t>(2 * f * width), width,
                all.begin() + static_cast<std::ptrdiff_t>(f * width));
  all.resize(kept * width);
}

}  // namespace

ThinnedRows::ThinnedRows(const Lattice& lattice, std::size_t components)
    : capacity_(lattice.sites() == 1 ? 10 * most_frames : most_frames),
      site_stride_(std::max<std::size_t>(1, (delf::at(lattice.sites()) + most_frames - 1) / most_frames)),
      components_(components) {
  for (std::size_t i = 0; i < delf::at(lattice.sites()); i += site_stride_)
    space_.push_back(lattice.position(static_cast<int>(i)));
  newest_.resize(space_.size() * components_);
  newest_rates_.resize(newest_.size());
}

void ThinnedRows::append(double time, std::span<const double> row, std::span<const double> rates) {
  for (std::size_t n = 0; n < newest_.size(); ++n) {
    const std::size_t at = n / components_ * site_stride_ * components_ + n % components_;
    newest_[n] = row[at];
    newest_rates_[n] = rates.empty() ? std::numeric_limits<double>::quiet_NaN() : rates[at];
  }
  newest_time_ = time;
  newest_kept_ = false;
  if (seen_++ % stride_ == 0) keep();
}

void ThinnedRows::keep() {
  if (times_.size() >= capacity_) halve();
  put();
}

void ThinnedRows::put() {
  times_.push_back(newest_time_);
  values_.insert(values_.end(), newest_.begin(), newest_.end());
  rates_.insert(rates_.end(), newest_rates_.begin(), newest_rates_.end());
  newest_kept_ = true;
}

// The capacity is even: the row that finds it full is the next of those that are kept.
void ThinnedRows::halve() {
  drop_every_second(times_, 1);
  for (std::vector<double>* all : {&values_, &rates_}) drop_every_second(*all, newest_.size());
  stride_ *= 2;
}

void ThinnedRows::visit(SavedState& state) {
  state("stride of thinned rows", stride_), state("rows seen", seen_), state("newest is kept", newest_kept_);
  state("newest time", newest_time_), state("newest", newest_), state("newest rates", newest_rates_);
  state("times", times_), state("frames", values_), state("rates", rates_);
}

void ThinnedRows::finish() {
  if (!newest_kept_) put();
}

// The last record may come early, after less than a full interval.
int ThinnedRows::even_frames() const {
  std::size_t n = times_.size();
  while (n > 2 && !(times_[n - 1] - times_[n - 2] > 0.999 * (times_[1] - times_[0]))) --n;
  return static_cast<int>(n);
}

double ThinnedRows::alias() const {
  constexpr double little = 1e-4;         // a hundredth of what the field varies by is not seen
  const bool is_map = space_.size() > 1;  // of the first component; of a point all coordinates are drawn
  const std::size_t step = is_map ? components_ : 1, width = newest_.size();
  double missed = 0, changed = 0, size = 0;
  for (int f = 1; f < even_frames(); ++f) {
    const auto now = frame(f), last = frame(f - 1);
    const double *const rates = &rates_[delf::at(f) * width], *const last_rates = rates - width;
    const double half = 0.5 * (time(f) - time(f - 1));
    double sum = 0, squares = 0;
    for (std::size_t i = 0; i < width; i += step) {
      const double change = now[i] - last[i], by_rates = half * (rates[i] + last_rates[i]);
      if (std::isnan(by_rates)) continue;
      missed += (change - by_rates) * (change - by_rates), changed += change * change;
      sum += now[i], squares += now[i] * now[i];
    }
    size += is_map ? squares - sum * sum / static_cast<double>(width / step) : squares;
  }
  return missed <= little * size ? 0 : missed / changed;
}

std::span<const double> ThinnedRows::frame(int index) const {
  return std::span(values_).subspan(delf::at(index) * newest_.size(), newest_.size());
}

}  // namespace delf

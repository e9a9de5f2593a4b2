// SPDX-License-Identifier: MIT
#include "tools/figures/film.hpp"

#include <algorithm>

#include "schemes/stepping/saved_state.hpp"

namespace delf {

namespace {
constexpr std::int64_t most = 600;
std::int64_t stride_for(std::int64_t count, std::int64_t limit = most) {
  return std::max<std::int64_t>(1, (count + limit - 1) / limit);
}
}  // namespace

Film::Film(const Lattice& lattice, std::int64_t expected_frames, std::size_t components)
    : stride_(stride_for(expected_frames, lattice.sites() == 1 ? 10 * most : most)),
      site_stride_(static_cast<std::size_t>(stride_for(lattice.sites()))),
      components_(components) {
  for (std::size_t i = 0; i < static_cast<std::size_t>(lattice.sites()); i += site_stride_)
    space_.push_back(lattice.position(static_cast<int>(i)));
  newest_.resize(space_.size() * components_);
}

void Film::append(double time, std::span<const double> row) {
  for (std::size_t i = 0; i < space_.size(); ++i)
    for (std::size_t a = 0; a < components_; ++a)
      newest_[i * components_ + a] = row[i * site_stride_ * components_ + a];
  newest_time_ = time;
  newest_kept_ = false;
  if (seen_++ % stride_ == 0) keep(time);
}

void Film::keep(double time) {
  times_.push_back(time);
  values_.insert(values_.end(), newest_.begin(), newest_.end());
  newest_kept_ = true;
  // the last record may come early, after less than a full interval
  const auto n = times_.size();
  const double first = n > 1 ? times_[1] - times_[0] : 0;
  if (n < 3 || times_[n - 1] - times_[n - 2] > 0.999 * first) even_frames_ = static_cast<int>(n);
}

void Film::visit(SavedState& state) {
  state("film stride", stride_), state("rows seen", seen_), state("newest is kept", newest_kept_);
  state("even frames", even_frames_), state("newest time", newest_time_), state("newest", newest_);
  state("times", times_), state("frames", values_);
}

void Film::finish() {
  if (!newest_kept_) keep(newest_time_);
}

std::span<const double> Film::frame(int index) const {
  return std::span(values_).subspan(static_cast<std::size_t>(index) * newest_.size(), newest_.size());
}

}  // namespace delf

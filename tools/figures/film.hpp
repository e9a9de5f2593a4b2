// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/lattice.hpp"

namespace delf {

class SavedState;

/// The recorded rows, thinned to what a figure can show: at most about 600 frames of at most 600 sites, or 6000 of one
/// site, always with the first row and the last one. Independent of fields.h5.
class Film {
 public:
  Film(const Lattice&, std::int64_t expected_frames, std::size_t components = 1);

  void append(double time, std::span<const double> row);
  /// Keeps the newest row, due or not.
  void finish();

  void visit(SavedState&);

  int frames() const noexcept { return static_cast<int>(times_.size()); }
  double time(int frame) const { return times_[static_cast<std::size_t>(frame)]; }
  std::span<const double> frame(int index) const;  ///< site by site
  std::size_t components() const noexcept { return components_; }
  const std::vector<double>& space() const noexcept { return space_; }
  /// How many frames, from the first one, are equally spaced in time.
  int even_frames() const noexcept { return even_frames_; }

 private:
  void keep(double time);

  std::int64_t stride_, seen_ = 0;
  std::size_t site_stride_, components_;
  bool newest_kept_ = true;
  int even_frames_ = 0;
  double newest_time_ = 0;
  std::vector<double> space_, newest_, times_, values_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/lattice.hpp"

namespace delf {

class SavedState;

/// The recorded rows, thinned to what a figure can show: at most 600 frames of at most 600 sites, or 6000 of one site, always
/// with the first row and the last one. When it is full every second frame is dropped, whatever the length of the run: a run
/// in parts has those of the whole. Independent of fields.h5.
class ThinnedRows {
 public:
  explicit ThinnedRows(const Lattice&, std::size_t components = 1);

  /// A row, with its rates of change where they are known: see alias().
  void append(double time, std::span<const double> row, std::span<const double> rates = {});
  /// Keeps the newest row, due or not.
  void finish();

  void visit(SavedState&);

  int frames() const noexcept { return static_cast<int>(times_.size()); }
  double time(int frame) const { return times_[frame]; }
  std::span<const double> frame(int index) const;  ///< site by site
  std::size_t components() const noexcept { return components_; }
  const std::vector<double>& space() const noexcept { return space_; }
  /// The number of frames, from the first one, that are equally spaced in time.
  int even_frames() const;
  /// Records from frame to frame.
  std::int64_t stride() const noexcept { return stride_; }
  /// The distance of the frames from showing the motion. The change D from frame to frame is held against that of the
  /// rates, P = ½Δt (φ_t + φ_t′): Σ|D − P|²/Σ|D|² over all frames, which for an oscillation is below ¼ for more than
  /// 2.7 frames a period, and above 1 beyond Nyquist's frequency. 0 where nothing moves.
  double alias() const;
  /// True if frames are farther apart than the motion lasts: what moves in a figure may not exist.
  bool is_aliased() const { return !(alias() <= aliased); }
  static constexpr double aliased = 0.25;

 private:
  void keep();
  void put();
  void halve();

  std::size_t capacity_;
  std::int64_t stride_ = 1, seen_ = 0;
  std::size_t site_stride_, components_;
  bool newest_kept_ = true;
  double newest_time_ = 0;
  std::vector<double> space_, newest_, times_, values_;
  std::vector<double> newest_rates_, rates_;  ///< not numbers where they are not known
};

}  // namespace delf

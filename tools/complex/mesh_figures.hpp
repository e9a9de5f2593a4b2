// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/complex/complex_scene.hpp"

namespace delf {

class SavedState;

/// Rows of a run on a mesh for its figures: four, evenly spread.
class MeshFilm {
 public:
  explicit MeshFilm(const ComplexScene&);
  /// Rows come in the order of their steps.
  void add(std::int64_t step, double time, std::span<const double> values);

  /// A run that is resumed with more steps keeps of its frames those that it would have chosen.
  void visit(SavedState&);

  struct Frame {
    std::int64_t step;
    double time;
    std::vector<double> values;
  };
  const std::vector<Frame>& frames() const { return frames_; }

 private:
  std::int64_t steps_;
  std::vector<Frame> frames_;
};

/// Draws into `folder`/figures: `field`, the first field at these times (curves over an interval, maps of triangles in the
/// plane and in space), or over the stencils of a finite complex in x and t; `levels`, which of these are solved one after
/// the other, by the levels of the sites; and `updates`, in which order asynchronous cells of an interval act. Returns what
/// is missing, in one line, or an empty string.
std::string draw_mesh(const ComplexScene&, const MeshFilm&, std::span<const int> levels,
                      const std::filesystem::path& folder);

}  // namespace delf

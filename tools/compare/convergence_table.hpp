// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tools/measure/measures.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// A line of the table.
struct ConvergenceLevel {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  int sites = 1;
  double space_step = 0, time_step = 0, seconds = 0;
  double size = 0;  ///< the largest |φ| of the last row
  std::int64_t steps = 0;
  double linf = unknown, l2 = unknown;  ///< errors, or differences from the next level
  double apart = unknown;               ///< the largest difference from the next level's row, whatever errors are
  double order = unknown;  ///< log₂ of an error's ratio to the next level's: the maximum norm's, on meshes L2's
  std::vector<NamedNumber> measures;
};

struct ConvergenceTable {
  bool exact = false;      ///< errors against the exact solution; else differences between one level and the next
  double size = 0;         ///< the largest |φ| of row 0, and of the last rows
  bool all_sites = false;  ///< errors are those of all sites of a finite complex, not of the last row
  std::vector<ConvergenceLevel> levels;
  double ConvergenceLevel::*norm = &ConvergenceLevel::linf;  ///< that the orders are of
  std::string ended;            ///< why there are fewer than asked for; empty if there are as many
  std::string status = "done";  ///< or interrupted, or of the level that failed: not-finite, no-convergence, …

  /// The order between the last two levels whose errors are known, and above rounding.
  double order() const;
};

/// Fills a table with levels 0, 1, …, which `add` runs and appends, one at a call; it returns false if it was interrupted. A
/// level that fails, or that cannot be run, is the end of the table; the first throws. Then finds each level's order, from
/// its error in that norm and the next level's, where both are above rounding.
void fill(ConvergenceTable&, int levels, double ConvergenceLevel::*norm, const std::function<bool(int level)>& add);

/// Levels of the scene at 1, ½, ¼, … of its steps in time and space.
ConvergenceTable converge(const Scene&, int levels);

}  // namespace delf

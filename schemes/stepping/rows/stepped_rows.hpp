// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <vector>

#include "schemes/stepping/rows/section_rows.hpp"
#include "schemes/stepping/step_method.hpp"

namespace delf {

/// What steps know of the rows that they have made: how large those are, which are still there, and one to go back to.
///
/// Steps in place write over the newest row. Only one of the rows held is written then, so that the row before the last
/// step that was not in place lies where it was, with all that a step needs: what follows it can be found again.
struct SteppedRows {
  SectionRows& rows;
  double time_step;

  std::int64_t n = -1;         ///< newest row
  double largest[2] = {0, 0};  ///< |y| of the newest two rows
  double largest_ever = 0;     ///< |y| of all rows since the start, where steps find it; others in one loop find
  double squares_ever = 0;     ///< Σy² of each row: the largest since the start
  int iterations = 0;          ///< of the last step
  int known = 0;               ///< newest rows that have not been written over
  /// The row to go back to; −1: none. What was known when it was the newest.
  std::int64_t kept_row = -1, kept_overwritten = 0;
  double kept_largest[2] = {0, 0};

  /// Rows 0 … of the start, which stand.
  void start(const std::vector<std::vector<double>>& start_rows) {
    rows.restore(0);
    known = std::min(static_cast<int>(start_rows.size()), rows.rows_held());
    kept_row = -1;
    largest_ever = squares_ever = 0;
    for (std::size_t r = 0; r < start_rows.size(); ++r) {
      rows.set_row(static_cast<std::int64_t>(r), start_rows[r]);
      if (r > 0) rows.find_increment(static_cast<std::int64_t>(r));
      largest[1] = largest[0];
      largest[0] = 0;
      double squares = 0;
      for (const double y : start_rows[r]) squares += y * y, largest[0] = std::max(largest[0], std::abs(y));
      largest_ever = std::max(largest_ever, largest[0]);
      squares_ever = std::max(squares_ever, squares);
    }
    n = static_cast<std::int64_t>(start_rows.size()) - 1;
  }

  /// The next one, whose largest |y| iterations ask for.
  void row_is_found(double value) {
    largest[1] = largest[0];
    largest[0] = value;
    largest_ever = std::max(largest_ever, value);
    known = std::min(known + 1, rows.rows_held());
  }

  /// Before row_is_found().
  void keep() {
    kept_row = n;
    kept_overwritten = rows.overwritten();
    std::ranges::copy(largest, kept_largest);
  }
  void go_back() {
    n = kept_row;
    rows.restore(kept_overwritten);
    std::ranges::copy(kept_largest, largest);
    known = 1;
  }

  /// Throws std::logic_error if so many of the newest rows are not there.
  void require(int count) const {
    if (count > known)
      throw std::logic_error("delf: rows before the newest were written over by step(false), or not stepped yet");
  }

  [[noreturn, gnu::noinline]] void report_not_finite() {
    // Implicit steps spread an overflow over the whole row: it is where the field was largest. Of long rows Σy²
    // overflows before any value does: it is where the field is largest.
    const std::vector<double> row = rows.row(n + 1), before = rows.row(n);
    const auto fine = [](double x) { return !overflowed(std::abs(x)); };
    const auto largest_of = [](const std::vector<double>& values) {
      return std::ranges::max_element(values, {}, [](double x) { return std::abs(x); }) - values.begin();
    };
    const bool everywhere = std::ranges::none_of(row, fine), nowhere = std::ranges::all_of(row, fine);
    const auto bad = everywhere ? largest_of(before)
                     : nowhere  ? largest_of(row)
                                : std::ranges::find_if_not(row, fine) - row.begin();
    throw NotFinite(
        fmt::format("step {}, t = {:.6g}, site {}: the field is no longer finite: the scheme is unstable here; "
                    "reduce lattice.courant or lattice.time_step, or choose an implicit stencil",
                    n + 1, static_cast<double>(n + 1) * time_step, bad / rows.components()));
  }
};

}  // namespace delf

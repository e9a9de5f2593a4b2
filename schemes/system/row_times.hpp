// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

namespace delf {

/// When the rows of a section are: t_n = n h, or, where steps have lengths of their own, as they were given.
class RowTimes {
 public:
  explicit RowTimes(double step) : step_(step) {}

  bool uniform() const { return rows_.empty(); }
  /// The step from a row to the next one. Rows beyond those that are known continue the first step or the last.
  double step(std::int64_t row) const { return uniform() ? step_ : at(row).step; }
  double time(std::int64_t row) const { return uniform() ? static_cast<double>(row) * step_ : own_time(row); }

  /// Row 0, with the step above it: from here on steps have lengths of their own.
  void begin(double step);
  /// The step above the newest row that is known; or without it again.
  void add(double step);
  void drop() { rows_.pop_back(); }
  /// The times of rows 0, 1, …, two of them at least, that something else has made.
  void set(const std::vector<double>& times);
  /// All rows are remembered, and not the newest alone.
  void keep_all() { all_ = true; }

  /// SavedState, of a room above this one.
  template <class State>
  void visit(State& state) {
    state("first row of known time", first_), state("times of rows", rows_);
  }

 private:
  struct Row {
    double time, step;  ///< and from there to the next row
  };
  /// The nearest row that is known.
  const Row& at(std::int64_t row) const;
  double own_time(std::int64_t row) const;

  double step_;
  bool all_ = false;
  std::int64_t first_ = 0;
  std::vector<Row> rows_;
};

}  // namespace delf

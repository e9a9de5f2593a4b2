// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace delf {

/// The columns of a series.csv, as far as its lines are whole: the last one of a run that was killed may be a part of one.
struct SeriesTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;

  SeriesTable() = default;
  /// Empty where there is none, or one without times, of another program.
  explicit SeriesTable(const std::filesystem::path&);
  /// Null if it is not there.
  const std::vector<double>* column(const std::string& name) const;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/rows_file.hpp"

namespace delf {

/// Rows as a table of text: the header `row,site,NAME,…`, then one line for each site of each row, in any order. Rows
/// and sites count from 0, and none may be missing. A column named t or time has the time of the row, the same at all its
/// sites. Lines that are empty or begin with # are passed over.
class RowsTable final : public RowsFile {
 public:
  explicit RowsTable(const std::filesystem::path&);

  int sites() const override { return sites_; }
  int frames() const override { return frames_; }
  int components() const override { return components_; }
  std::optional<double> time(int frame) const override;
  std::vector<double> row(int frame) const override;
  std::optional<int> winding() const override { return std::nullopt; }
  std::vector<std::string> names() const override { return names_; }

 private:
  int frames_ = 0, sites_ = 0, components_ = 0;
  std::vector<double> values_, times_;
  std::vector<std::string> names_;
};

}  // namespace delf

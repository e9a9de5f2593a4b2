// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "lattice/error.hpp"

namespace delf {

/// An error of a file of rows.
inline BadInput bad_file(const std::string& what) { return {"initial.file", what}; }

/// Rows in a file, to start from. Errors of the file are thrown as BadInput with the key initial.file, or
/// initial.frame for a missing frame.
class RowsFile {
 public:
  virtual ~RowsFile() = default;
  virtual int sites() const = 0;
  virtual int frames() const = 0;
  virtual int components() const = 0;  ///< fields at the vertices
  /// The time of a frame, if the file says it.
  virtual std::optional<double> time(int frame) const = 0;
  /// Site by site: row[i·components + a].
  virtual std::vector<double> row(int frame) const = 0;
  /// The momenta of the fields in a frame, in the same order, if the file has them.
  virtual std::optional<std::vector<double>> momenta(int) const { return std::nullopt; }
  /// The gain of the field around the circle, in units of 2π, if the file says so.
  virtual std::optional<int> winding() const = 0;
  /// The names of the fields in their order; empty if the file says none.
  virtual std::vector<std::string> names() const { return {}; }
};

/// A table if the name ends in .csv, else a fields.h5.
std::unique_ptr<RowsFile> open_rows(const std::filesystem::path&);

}  // namespace delf

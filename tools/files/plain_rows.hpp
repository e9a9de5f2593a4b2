// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "tools/files/rows_file.hpp"

namespace delf {

/// Numbers with a shape, as other programs write them: 1-D, frames × values, or frames × sites × components.
struct PlainArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;        ///< the last index runs first
  std::vector<double> times;         ///< of the frames, if the file says them
  std::vector<double> momenta = {};  ///< as many as values, if the file has them

  /// The number of values in the shape.
  std::size_t count() const { return std::accumulate(shape.begin(), shape.end(), std::size_t{1}, std::multiplies{}); }
};

/// The rows of such an array, for a scheme whose rows have sites · components values. A line is a frame, or a column is,
/// whichever has that many values; one unknown may be 1-D.
class PlainRows final : public RowsFile {
 public:
  /// Throws BadInput, key initial.file, for another shape.
  PlainRows(PlainArray, int sites, int components);

  int sites() const override { return sites_; }
  int frames() const override { return frames_; }
  int components() const override { return components_; }
  std::optional<double> time(int frame) const override;
  std::vector<double> row(int frame) const override;
  std::optional<std::vector<double>> momenta(int frame) const override;
  std::optional<int> winding() const override { return std::nullopt; }

 private:
  std::vector<double> frame_of(const std::vector<double>& values, int frame) const;

  int frames_ = 0, sites_, components_;
  bool columns_ = false;  ///< are the frames
  PlainArray array_;
};

// All throw BadInput, key initial.file.

/// A table of text, separated by commas, semicolons or blanks. Lines that begin with # or % are passed over, and so is a
/// line of names. A column named t or time, or one more than the `row_size` values of a row, has the times. Columns named p,
/// or p1, p2, …, as many as others, are momenta.
PlainArray read_table(const std::filesystem::path&, std::size_t row_size);
/// NumPy's .npy, of float64 or float32.
PlainArray read_npy(const std::filesystem::path&);
/// NumPy's .npz, not compressed: the array `name`; if it is empty q, phi, u or field, or the only one. Beside q, phi, u or
/// field, p, pi, v or momentum are the momenta, and t or time the times.
PlainArray read_npz(const std::filesystem::path&, const std::string& name);
/// A data set of an HDF5 file, of one to three axes, and its momenta: momentum, p or pi of the same shape.
PlainArray read_dataset(const std::filesystem::path&, const std::string& name);

/// FILE of FILE:/NAME, which is a data set in it; any other path as it is.
std::filesystem::path file_of_rows(const std::filesystem::path&);
/// The reader for a name: .npy, .npz, a table if it ends in .csv, .txt or .dat, or the data set of an HDF5 file, or an
/// array of an .npz, that is given as FILE:/NAME.
/// Nothing for other names.
std::unique_ptr<RowsFile> open_plain_rows(const std::filesystem::path&, int sites, int components);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <vector>

#include "tools/hdf5_handle.hpp"
#include "tools/rows_file.hpp"

namespace delf {

/// The rows of a fields.h5.
class FieldsReader final : public RowsFile {
 public:
  explicit FieldsReader(const std::filesystem::path&);

  int sites() const override { return sites_; }
  int frames() const override { return frames_; }
  int components() const override { return components_; }
  std::optional<double> time(int frame) const override;
  std::vector<double> row(int frame) const override;
  std::optional<int> winding() const override;

 private:
  Hdf5Handle file_, field_;
  int frames_ = 0, sites_ = 0, components_ = 0;
};

}  // namespace delf

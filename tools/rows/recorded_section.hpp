// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/fields_reader.hpp"
#include "tools/report/failure.hpp"

namespace delf {

/// The rows of a file in the layout of fields.h5, of a run or of any other program, as a section of a system's
/// components: the first frame is row 0, and the next frames are the next rows. Or those of a plain array (plain_rows.hpp).
///
/// Errors of the file are thrown as BadScene: "command line: OPTION FILE: what; remedy".
class RecordedSection {
 public:
  /// `back`, of each component: the rows that its value in a frame lies behind the fields there. Multipliers and inner
  /// nodes are recorded with the row that they were found with.
  RecordedSection(const std::filesystem::path&, const LatticeSystem&, const std::vector<int>& back, double time_step,
                  const char* option);

  int rows() const { return file_->frames(); }
  /// The gain of the field around the circle, in units of 2π, if the file says so.
  std::optional<int> winding() const { return file_->winding(); }
  /// All components, each at row j: [i·C + c]. Those that no frame has, because they would have been found with rows
  /// after the last, are zero.
  std::vector<double> row(std::int64_t j) const;
  /// The resolved scene that the file has as an attribute; empty if it has none.
  std::string scene() const { return fields_ ? fields_->scene() : std::string(); }
  /// The file has values of this role.
  bool has(Role role) const { return shape(role).frames > 0; }
  /// The momenta of the fields at frame j, if the file has them in the same shape.
  std::optional<std::vector<double>> momenta(std::int64_t j) const { return file_->momenta(static_cast<int>(j)); }

 private:
  struct Column {
    Role role;
    int index;  ///< in the dataset of its role
    int back;
  };
  BadScene wrong(const std::string& what) const;
  void check_shape(const LatticeSystem&, Role) const;
  FieldsReader::Shape shape(Role) const;
  std::string recorded(const std::string& key) const;
  void check_times(double time_step) const;
  std::vector<double> own_times() const;
  void check_space(const LatticeSystem&) const;
  void check_finite(const std::vector<double>& values, Role, int frame) const;
  /// The columns of this role that frame j + back has, into a row.
  void read(Role, int back, std::int64_t j, std::vector<double>& row) const;

  std::string place_;
  std::unique_ptr<RowsFile> file_;
  const FieldsReader* fields_ = nullptr;  ///< the same, if it is of the layout of fields.h5
  std::vector<Column> columns_;
};

}  // namespace delf

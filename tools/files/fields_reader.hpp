// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/system/lattice_system.hpp"
#include "tools/files/hdf5_handle.hpp"
#include "tools/files/rows_file.hpp"

namespace delf {

/// The rows of a fields.h5, one frame at a time. A run starts from its fields at the vertices; a verification
/// reads the other roles too.
class FieldsReader final : public RowsFile {
 public:
  explicit FieldsReader(const std::filesystem::path&);

  int sites() const override { return shape(Role::field).sites; }
  int frames() const override { return shape(Role::field).frames; }
  int components() const override { return shape(Role::field).components; }
  std::optional<double> time(int frame) const override;
  std::vector<double> row(int frame) const override;
  /// The momenta of /momentum; nothing where it is not of the shape of /field, or not finite.
  std::optional<std::vector<double>> momenta(int frame) const override;
  /// Throws BadInput where the attribute is anything but one whole number.
  std::optional<int> winding() const override;
  std::vector<std::string> names() const override;

  /// The resolved scene that the file has as an attribute; empty if it has none.
  std::string scene() const;
  /// The positions of the sites, /space; nothing where it is not one number for each.
  std::optional<std::vector<double>> positions() const;
  /// The positions of sites that move in a frame, /mesh; nothing where there are none.
  std::optional<std::vector<double>> moving_positions(int frame) const;
  /// All of /space, on a mesh n × dimension, row by row; nothing where it is neither that nor one number for each site.
  std::optional<std::vector<double>> coordinates() const;

  struct Shape {
    int frames = 0, sites = 0, components = 0;
  };
  /// The shape of the dataset of a role; all zero if there is none, or none of three axes.
  const Shape& shape(Role role) const { return part(role).shape; }
  /// A frame of it as it is, finite or not: [i·components + c]. Throws BadInput, key initial.file.
  std::vector<double> values(Role, int frame) const;

 private:
  struct Part {
    Hdf5Handle dataset;
    Shape shape;
  };
  void open(const std::filesystem::path&);
  void read_all() const;
  const Part& part(Role role) const { return parts_[at(role)]; }

  Hdf5Handle file_, time_, momentum_;
  std::array<Part, all_roles.size()> parts_;  ///< by role; held open, so that HDF5 keeps the block that a frame is in
};

}  // namespace delf

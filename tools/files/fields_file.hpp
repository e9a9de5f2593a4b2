// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "tools/files/hdf5_handle.hpp"
#include "tools/files/record.hpp"
#include "tools/files/row_names.hpp"
#include "tools/files/written_part.hpp"

namespace delf {

/// A mesh as fields.h5 has it: /space of several coordinates, and /cells, the points of each, −1 where it has fewer.
struct MeshOfFile {
  int coordinates = 1;
  std::span<const std::int32_t> cells = {};
  int corners = 0;          ///< columns of /cells
  bool node_times = false;  ///< /node_time, frames × sites: sites have times of their own
};

/// The recorded rows as fields.h5:
///
///     /time   frames                       attribute units
///     /space  sites                        attribute units
///     /field  frames × sites × fields      values as they are, not reduced modulo 2π
///     /inner, /multiplier, /trace, /slaved  the same of components of these roles; if there are any
///     /mesh   frames × sites               of a mesh that moves: its positions
///     /NAME   frames × sites × values      what the method declares beside them, such as /momentum; with `meaning`
/// Where there is more than one field at the vertices, each has an attribute `components`: names, comma separated.
///
///     /       attributes scene (the resolved scene), version, winding
///
/// Axes have names by dimension scales: time, space (site of a mesh) and NAME_component.
/// With `kept`, a file of that name is gone on with behind its first frames: they are copied, and the copy takes its place.
/// Throws BadScene where they cannot be read or are others, and leaves the file as it is.
/// Rows are written in blocks, and each block is flushed: what has been written stays readable. Throws SystemFailure, and
/// leaves a file then that any reader opens, with the rows of its last flush.
class FieldsFile {
 public:
  FieldsFile(const std::filesystem::path&, std::span<const double> space, std::int64_t expected_frames,
             const std::string& scene, int winding, const RowNames& = {}, const MeshOfFile& = {},
             const WrittenPart& kept = {});
  ~FieldsFile();

  void append(double time, const RecordedRow&, const RecordedDatasets& = {}, std::span<const double> node_times = {});
  /// Writes the buffered rows; with `sync` they reach the disk. The frames that are there.
  const WrittenPart& flush(bool sync);
  /// Writes the buffered rows. Until then they may be missing on the disk.
  void close();

 private:
  struct Rows {
    Hdf5Handle dataset;
    std::vector<hsize_t> shape;  ///< sites, or sites × components
    std::vector<double> waiting;
    std::string name = {};
  };
  Rows rows(const char* name, std::vector<hsize_t> shape) const;
  void name_axes(hid_t positions, hid_t cells, const MeshOfFile&);
  bool has_room();
  void write_block();
  bool close_all();
  void copy_frames(const std::filesystem::path& from, const WrittenPart& kept);
  void abandon();
  void require(bool went_well, const char* what);

  std::filesystem::path path_, written_to_;  ///< path_, or a file that is to take its place
  std::size_t sites_, frames_per_block_;
  WrittenPart written_;        ///< frames
  std::vector<double> times_;  ///< buffered
  RowNames names_;
  Hdf5Handle file_, time_;  ///< closed in the other order
  std::vector<Rows*> all_rows();
  ByRole<Rows> rows_;
  Rows mesh_, node_times_;
  std::vector<Rows> datasets_;  ///< of the method
};

}  // namespace delf

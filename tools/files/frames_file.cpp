// SPDX-License-Identifier: MIT
#include "tools/files/frames_file.hpp"

#include <fmt/format.h>

#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tools/files/hdf5_handle.hpp"
#include "tools/report/failure.hpp"

namespace delf {
namespace {

/// Part of a data set, whole or by offset, stride and count.
using Extent = std::vector<hsize_t>;
Hdf5Handle space_of(const Extent& shape) {
  return {H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose};
}
bool select(hid_t space, const Extent& offset, const Extent& stride, const Extent& count) {
  return H5Sselect_hyperslab(space, H5S_SELECT_SET, offset.data(), stride.empty() ? nullptr : stride.data(),
                             count.data(), nullptr) >= 0;
}

class FramesFile {
 public:
  explicit FramesFile(const std::filesystem::path& path) : path_(path), file_(-1, H5Fclose) {
    const Hdf5Handle format(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
    H5Pset_libver_bounds(format, H5F_LIBVER_V110, H5F_LIBVER_V110);
    H5Pset_obj_track_times(creation, false);
    file_ = Hdf5Handle(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, format), H5Fclose);
    require(static_cast<bool>(file_));
  }
  void require(bool went_well) const {
    if (!went_well)
      throw SystemFailure(
          fmt::format("{}: cannot be written; check that its disk has room and may be written to", path_.string()));
  }
  void group(const std::string& name) {
    require(static_cast<bool>(
        Hdf5Handle(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose)));
  }
  /// A virtual data set; `map` says what of fields.h5 is where in it.
  template <class Map>
  void add(const std::string& name, const Extent& shape, const Map& map) {
    const Hdf5Handle target = space_of(shape), properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
    H5Pset_obj_track_times(properties, false);
    map(static_cast<hid_t>(target), [&](const std::string& data_set, hid_t source) {
      require(H5Pset_virtual(properties, target, "fields.h5", data_set.c_str(), source) >= 0);
    });
    const Hdf5Handle made(H5Dcreate2(file_, name.c_str(), H5T_IEEE_F64LE, target, H5P_DEFAULT, properties, H5P_DEFAULT),
                          H5Dclose);
    require(static_cast<bool>(made));
  }
  void close() { require(file_.close()); }

 private:
  std::filesystem::path path_;
  Hdf5Handle file_;
};

/// Numbers that follow each other by one difference above 0, from the first on.
std::size_t run_length(std::span<const std::int32_t> numbers) {
  if (numbers.size() < 2 || numbers[1] <= numbers[0]) return 1;
  std::size_t n = 2;
  while (n < numbers.size() && numbers[n] - numbers[n - 1] == numbers[1] - numbers[0]) ++n;
  return n;
}

}  // namespace

void write_frames_file(const std::filesystem::path& folder, const std::vector<SharedRows>& shared, std::size_t frames,
                       std::size_t sites, const FurtherFrames& further) {
  quiet_hdf5();
  FramesFile file(folder / frames_file_name);
  for (const SharedRows& rows : shared) {
    const Extent all = rows.has_components ? Extent{frames, sites, rows.components.size()} : Extent{frames, sites};
    const Hdf5Handle source = space_of(all);
    for (std::size_t a = 0; a < rows.components.size(); ++a) {
      const std::string& name = rows.components[a];
      file.group(name);
      // Sites of frame n: `count` of them, each `stride` after the one before.
      const auto in_frame = [&](std::size_t n, std::size_t first, std::size_t stride, std::size_t count) {
        return rows.has_components ? select(source, {n, first, a}, {1, stride, 1}, {1, count, 1})
                                   : select(source, {n, first}, {1, stride}, {1, count});
      };
      const std::span<const std::int32_t> copies = further.copies;
      for (std::size_t n = 0; n < frames; ++n)
        file.add(name + "/" + fmt::to_string(n), {sites + copies.size()}, [&](hid_t target, const auto& from) {
          file.require(select(target, {0}, {}, {sites}) && in_frame(n, 0, 1, sites));
          from(rows.data_set, source);
          for (std::size_t first = 0, length = 0; first < copies.size(); first += length) {
            length = run_length(copies.subspan(first));
            const std::size_t apart = length > 1 ? at(copies[first + 1] - copies[first]) : 1;
            file.require(select(target, {sites + first}, {}, {length}) &&
                         in_frame(n, at(copies[first]), apart, length));
            from(rows.data_set, source);
          }
        });
      if (further.together)
        file.add(name + "/all", {frames, sites}, [&](hid_t, const auto& from) {
          file.require(rows.has_components ? select(source, {0, 0, a}, {}, {frames, sites, 1})
                                           : select(source, {0, 0}, {}, {frames, sites}));
          from(rows.data_set, source);
        });
    }
  }
  if (!further.moving.empty())
    file.add("places", {frames * sites, 2}, [&](hid_t target, const auto& from) {
      const Hdf5Handle positions = space_of({frames, sites}), times = space_of({frames});
      file.require(select(target, {0, 0}, {}, {frames * sites, 1}));
      from(further.moving, positions);
      for (std::size_t i = 0; i < sites; ++i) {  // every time beside each site of its frame
        file.require(select(target, {i, 1}, {sites, 1}, {frames, 1}));
        from("/time", times);
      }
    });
  file.close();
}

}  // namespace delf

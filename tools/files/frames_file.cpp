// SPDX-License-Identifier: MIT
#include "tools/files/frames_file.hpp"

#include <fmt/format.h>

#include <array>

#include "tools/files/hdf5_handle.hpp"
#include "tools/report/failure.hpp"

namespace delf {

void write_frames_file(const std::filesystem::path& folder, const std::vector<std::string>& components,
                       std::size_t frames, std::size_t sites) {
  quiet_hdf5();
  const std::filesystem::path path = folder / frames_file_name;
  const auto require = [&](bool went_well) {
    if (!went_well)
      throw SystemFailure(
          fmt::format("{}: cannot be written; check that its disk has room and may be written to", path.string()));
  };
  const Hdf5Handle format(H5Pcreate(H5P_FILE_ACCESS), H5Pclose), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_libver_bounds(format, H5F_LIBVER_V110, H5F_LIBVER_V110);
  H5Pset_obj_track_times(creation, false);
  Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation, format), H5Fclose);
  require(static_cast<bool>(file));
  const std::array<hsize_t, 3> all{frames, sites, components.size()};
  const hsize_t of_frame = sites;
  const Hdf5Handle source(H5Screate_simple(3, all.data(), nullptr), H5Sclose),
      target(H5Screate_simple(1, &of_frame, nullptr), H5Sclose);
  for (std::size_t a = 0; a < components.size(); ++a) {
    const Hdf5Handle group(H5Gcreate2(file, components[a].c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    require(static_cast<bool>(group));
    for (std::size_t n = 0; n < frames; ++n) {
      const std::array<hsize_t, 3> offset{n, 0, a}, count{1, sites, 1};
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_obj_track_times(properties, false);
      require(H5Sselect_hyperslab(source, H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr) >= 0 &&
              H5Pset_virtual(properties, target, "fields.h5", "/field", source) >= 0);
      const Hdf5Handle frame(
          H5Dcreate2(group, fmt::to_string(n).c_str(), H5T_IEEE_F64LE, target, H5P_DEFAULT, properties, H5P_DEFAULT),
          H5Dclose);
      require(static_cast<bool>(frame));
    }
  }
  require(file.close());
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/files/frames_file.hpp"

#include <fmt/format.h>

#include <array>

#include "tools/files/hdf5_handle.hpp"
#include "tools/report/failure.hpp"

namespace delf {
namespace {

/// Numbers that follow each other by one difference above 0, from the first on.
std::size_t run_length(std::span<const std::int32_t> numbers) {
  if (numbers.size() < 2 || numbers[1] <= numbers[0]) return 1;
  std::size_t n = 2;
  while (n < numbers.size() && numbers[n] - numbers[n - 1] == numbers[1] - numbers[0]) ++n;
  return n;
}

}  // namespace

void write_frames_file(const std::filesystem::path& folder, const std::vector<std::string>& components,
                       std::size_t frames, std::size_t sites, std::span<const std::int32_t> copies) {
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
  const hsize_t of_frame = sites + copies.size();
  const Hdf5Handle source(H5Screate_simple(3, all.data(), nullptr), H5Sclose),
      target(H5Screate_simple(1, &of_frame, nullptr), H5Sclose);
  for (std::size_t a = 0; a < components.size(); ++a) {
    const Hdf5Handle group(H5Gcreate2(file, components[a].c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
    require(static_cast<bool>(group));
    for (std::size_t n = 0; n < frames; ++n) {
      const std::array<hsize_t, 3> offset{n, 0, a}, count{1, sites, 1};
      const Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
      H5Pset_obj_track_times(properties, false);
      const hsize_t none = 0, all_sites = sites;
      require(
          H5Sselect_hyperslab(source, H5S_SELECT_SET, offset.data(), nullptr, count.data(), nullptr) >= 0 &&
          (copies.empty() || H5Sselect_hyperslab(target, H5S_SELECT_SET, &none, nullptr, &all_sites, nullptr) >= 0) &&
          H5Pset_virtual(properties, target, "fields.h5", "/field", source) >= 0);
      for (std::size_t first = 0, length = 0; first < copies.size(); first += length) {
        length = run_length(copies.subspan(first));
        const hsize_t to = sites + first, many = length;
        const auto apart = length > 1 ? static_cast<hsize_t>(copies[first + 1] - copies[first]) : 1;
        const std::array<hsize_t, 3> from{n, static_cast<hsize_t>(copies[first]), a}, stride{1, apart, 1},
            run{1, many, 1};
        require(H5Sselect_hyperslab(source, H5S_SELECT_SET, from.data(), stride.data(), run.data(), nullptr) >= 0 &&
                H5Sselect_hyperslab(target, H5S_SELECT_SET, &to, nullptr, &many, nullptr) >= 0 &&
                H5Pset_virtual(properties, target, "fields.h5", "/field", source) >= 0);
      }
      const Hdf5Handle frame(
          H5Dcreate2(group, fmt::to_string(n).c_str(), H5T_IEEE_F64LE, target, H5P_DEFAULT, properties, H5P_DEFAULT),
          H5Dclose);
      require(static_cast<bool>(frame));
    }
  }
  require(file.close());
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/files/hdf5_handle.hpp"

namespace delf {

/// A file of rows, also one that is still written, or whose writer was killed.
inline Hdf5Handle open_to_read(const std::filesystem::path& path) {
  Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (file) return file;
  // A file that is just being written is read again, each time after a longer pause: 16 of them are some milliseconds,
  // and the hundred that HDF5 would take on a damaged file last for hours.
  const Hdf5Handle patience(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_metadata_read_attempts(patience, 16);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY | H5F_ACC_SWMR_READ, patience), H5Fclose};
}

}  // namespace delf

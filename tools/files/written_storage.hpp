// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>

#include "tools/files/hdf5_handle.hpp"

namespace delf {

/// Whether a data set has storage for all of its values. What was never written reads as zeros, and takes no room in a file
/// whatever its extents. Filters such as deflate may make constant values as few as a millionth.
inline bool was_written(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose),
      properties(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, H5S_MAX_RANK> extents{};
  const int rank = H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  double least = static_cast<double>(H5Tget_size(type));  // HDF5 counts the values as an integer, which may overflow
  for (int axis = 0; axis < rank; ++axis) least *= static_cast<double>(extents[static_cast<std::size_t>(axis)]);
  const int filters = H5Pget_nfilters(properties);
  for (int n = 0; n < filters; ++n) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(n), &flags, &values, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SHUFFLE) least /= 1e6;
  }
  return static_cast<double>(H5Dget_storage_size(dataset)) >= least;
}

}  // namespace delf

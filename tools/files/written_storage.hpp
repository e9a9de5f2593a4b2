// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>

#include "tools/files/hdf5_handle.hpp"

namespace delf {

/// True if a data set has storage for all of its values. Those never written read as zeros, and take no room in a file
/// whatever its extents. Filters such as deflate may make constant values as few as a millionth. With `growing`, one frame of a
/// data set in chunks is enough: where a disk was full, it is longer than what fitted.
inline bool was_written(hid_t dataset, bool growing = false) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose), type(H5Dget_type(dataset), H5Tclose),
      properties(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, H5S_MAX_RANK> extents{};
  const int rank = H5Sget_simple_extent_dims(space, extents.data(), nullptr);
  const std::size_t size = H5Tget_size(type);
  if (size == 0) return false;               // a damaged type
  double least = static_cast<double>(size);  // HDF5 counts the values as an integer, which may overflow
  for (int axis = growing && H5Pget_layout(properties) == H5D_CHUNKED ? 1 : 0; axis < rank; ++axis)
    least *= static_cast<double>(extents[axis]);
  const int filters = H5Pget_nfilters(properties);
  for (int n = 0; n < filters; ++n) {
    unsigned flags = 0;
    std::size_t values = 0;
    const H5Z_filter_t filter =
        H5Pget_filter2(properties, static_cast<unsigned>(n), &flags, &values, nullptr, 0, nullptr, nullptr);
    if (filter != H5Z_FILTER_FLETCHER32 && filter != H5Z_FILTER_SHUFFLE) least /= 1e6;
  }
  // A damaged header may claim more than the file has.
  const Hdf5Handle file(H5Iget_file_id(dataset), H5Fclose);
  hsize_t bytes = 0;
  return H5Fget_filesize(file, &bytes) >= 0 && static_cast<double>(bytes) >= least &&
         static_cast<double>(H5Dget_storage_size(dataset)) >= least;
}

/// True if the chunk that the frame begins in is there; also where there are no chunks.
inline bool frame_was_written(hid_t dataset, hsize_t frame) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, H5S_MAX_RANK> chunk{}, corner{};
  if (H5Pget_layout(properties) != H5D_CHUNKED || H5Pget_chunk(properties, H5S_MAX_RANK, chunk.data()) < 1) return true;
  corner[0] = frame - frame % chunk[0];
  unsigned filters = 0;
  haddr_t address = HADDR_UNDEF;
  hsize_t bytes = 0;
  return H5Dget_chunk_info_by_coord(dataset, corner.data(), &filters, &address, &bytes) >= 0 && bytes > 0;
}

}  // namespace delf

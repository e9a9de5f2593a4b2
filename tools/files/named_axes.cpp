// SPDX-License-Identifier: MIT
#include "tools/files/named_axes.hpp"

#include <fmt/format.h>
#include <hdf5_hl.h>

#include <string>

namespace delf {

bool make_scale(hid_t dataset, const char* name) { return H5DSset_scale(dataset, name) >= 0; }

Hdf5Handle scale_without_values(hid_t file, const char* name, hsize_t size) {
  const Hdf5Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose),
      properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);  // a rerun gives the same bytes
  Hdf5Handle scale(H5Dcreate2(file, name, H5T_IEEE_F32BE, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose);
  const std::string words = fmt::format("This is a netCDF dimension but not a netCDF variable.{:10d}", size);
  if (!scale || !make_scale(scale, words.c_str())) return {};
  return scale;
}

bool name_axis(hid_t dataset, unsigned axis, hid_t scale, const char* label) {
  return H5DSattach_scale(dataset, scale, axis) >= 0 && H5DSset_label(dataset, axis, label) >= 0;
}

}  // namespace delf

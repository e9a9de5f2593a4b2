// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>

#include "tools/files/hdf5_handle.hpp"

namespace delf {

/// Axes of HDF5 data sets that have names, by dimension scales and labels: xarray, h5py and netCDF then read
/// frames × sites × components as such. All return false where HDF5 fails.

/// Makes a data set of one axis the scale of that name: the positions along every axis it is attached to.
bool make_scale(hid_t dataset, const char* name);
/// A scale of `size` positions without values, in the words of netCDF.
Hdf5Handle scale_without_values(hid_t file, const char* name, hsize_t size);
/// Gives an axis of a data set its scale and its label.
bool name_axis(hid_t dataset, unsigned axis, hid_t scale, const char* label);

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/fields_reader.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>

#include "lattice/error.hpp"

namespace delf {

namespace {

BadInput bad_file(const std::string& what) { return {"initial.file", what}; }

bool read_slice(hid_t dataset, int rank, const hsize_t* offset, const hsize_t* count, double* out) {
  const Hdf5Handle source(H5Dget_space(dataset), H5Sclose), target(H5Screate_simple(rank, count, nullptr), H5Sclose);
  return H5Sselect_hyperslab(source, H5S_SELECT_SET, offset, nullptr, count, nullptr) >= 0 &&
         H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, out) >= 0;
}

}  // namespace

FieldsReader::FieldsReader(const std::filesystem::path& path) {
  quiet_hdf5();
  file_ = {H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose};
  if (!file_) throw bad_file("is not an HDF5 file that can be read; name the fields.h5 of a run");
  field_ = {H5Dopen2(file_, "field", H5P_DEFAULT), H5Dclose};
  if (!field_) throw bad_file("has no dataset /field; name the fields.h5 of a run");
  const Hdf5Handle space(H5Dget_space(field_), H5Sclose);
  std::array<hsize_t, 3> extent{};
  if (H5Sget_simple_extent_ndims(space) != 3 || H5Sget_simple_extent_dims(space, extent.data(), nullptr) != 3)
    throw bad_file("/field is not frames x sites x components; name the fields.h5 of a run");
  constexpr hsize_t most = std::numeric_limits<int>::max();
  if (extent[2] < 1 || extent[0] > most || extent[1] > most || extent[2] > most)
    throw bad_file(fmt::format("/field is {} x {} x {}; name the fields.h5 of a run", extent[0], extent[1], extent[2]));
  frames_ = static_cast<int>(extent[0]);
  sites_ = static_cast<int>(extent[1]);
  components_ = static_cast<int>(extent[2]);
}

std::optional<double> FieldsReader::time(int frame) const {
  const Hdf5Handle dataset(H5Dopen2(file_, "time", H5P_DEFAULT), H5Dclose);
  if (!dataset) return std::nullopt;
  const auto offset = static_cast<hsize_t>(frame);
  const hsize_t one = 1;
  double t = 0;
  if (!read_slice(dataset, 1, &offset, &one, &t)) throw bad_file(fmt::format("/time has no frame {}", frame));
  return t;
}

std::vector<double> FieldsReader::row(int frame) const {
  if (frame >= frames_)
    throw BadInput("initial.frame", fmt::format("frame {} is needed, and the file has {} of them; record more rows, "
                                                "with output.every = 1",
                                                frame, frames_));
  std::vector<double> values(static_cast<std::size_t>(sites_) * static_cast<std::size_t>(components_));
  const std::array<hsize_t, 3> offset{static_cast<hsize_t>(frame), 0, 0}, count{1, static_cast<hsize_t>(sites_),
                                                                             static_cast<hsize_t>(components_)};
  if (!read_slice(field_, 3, offset.data(), count.data(), values.data()))
    throw bad_file(fmt::format("frame {} cannot be read; the file is damaged", frame));
  for (std::size_t i = 0; i < values.size(); ++i)
    if (!std::isfinite(values[i]))
      throw bad_file(fmt::format("frame {} is not finite at site {}; take an earlier frame", frame,
                                 i / static_cast<std::size_t>(components_)));
  return values;
}

std::optional<int> FieldsReader::winding() const {
  const Hdf5Handle attribute(H5Aopen(file_, "winding", H5P_DEFAULT), H5Aclose);
  int value = 0;
  return attribute && H5Aread(attribute, H5T_NATIVE_INT, &value) >= 0 ? std::optional(value) : std::nullopt;
}

}  // namespace delf

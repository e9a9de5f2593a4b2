// SPDX-License-Identifier: MIT
#include "tools/files/fields_reader.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"
#include "tools/files/open_to_read.hpp"
#include "tools/files/read_apart.hpp"
#include "tools/files/written_storage.hpp"

namespace delf {

namespace {

int rank_of(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  return H5Sget_simple_extent_ndims(space);
}

// Nothing if there is none of that name; throws BadInput if there is one that cannot be read.
Hdf5Handle open_dataset(hid_t file, const char* name) {
  Hdf5Handle dataset(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!dataset && H5Lexists(file, name, H5P_DEFAULT) != 0)
    throw bad_file(fmt::format("/{} cannot be read; the file is damaged", name));
  return dataset;
}

bool read_slice(hid_t dataset, int rank, const hsize_t* offset, const hsize_t* count, double* out) {
  if (rank_of(dataset) != rank) return false;  // or HDF5 would read past the ends of offset and count
  const Hdf5Handle source(H5Dget_space(dataset), H5Sclose), target(H5Screate_simple(rank, count, nullptr), H5Sclose);
  return H5Sselect_hyperslab(source, H5S_SELECT_SET, offset, nullptr, count, nullptr) >= 0 &&
         H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, out) >= 0;
}

// frames × sites × components; nothing for any other rank
std::optional<std::array<hsize_t, 3>> extent_of(hid_t dataset) {
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  std::array<hsize_t, 3> extent{};
  if (H5Sget_simple_extent_ndims(space) != 3 || H5Sget_simple_extent_dims(space, extent.data(), nullptr) != 3)
    return std::nullopt;
  return extent;
}

// "name another by --dataset u (with --fields), or the fields.h5 of a run": of what the file has at its root.
std::string other_datasets(hid_t file) {
  std::string names;
  const auto add = [](hid_t from, const char* name, const H5L_info_t*, void* to) -> herr_t {
    const Hdf5Handle dataset(H5Dopen2(from, name, H5P_DEFAULT), H5Dclose);
    if (dataset && rank_of(dataset) > 1 && rank_of(dataset) < 4) {
      std::string& all = *static_cast<std::string*>(to);
      all += (all.empty() ? "" : ", ") + std::string(name);
    }
    return 0;
  };
  H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
  return names.empty()
             ? "name the fields.h5 of a run"
             : fmt::format("name another data set of --fields by --dataset {}, or the fields.h5 of a run", names);
}

bool fits(const std::array<hsize_t, 3>& extent) {
  constexpr hsize_t most = std::numeric_limits<int>::max();
  return extent[2] >= 1 && extent[0] <= most && extent[1] <= most && extent[2] <= most;
}

}  // namespace

FieldsReader::FieldsReader(const std::filesystem::path& path) {
  quiet_hdf5();
  read_apart(path, [&] {
    open(path);
    read_all();
  });
  open(path);
}

void FieldsReader::read_all() const {
  scene(), names(), coordinates();
  for (int frame = 0; frame < frames(); ++frame) {
    time(frame), momenta(frame);
    for (const Role role : all_roles)
      if (frame < shape(role).frames) values(role, frame);
  }
  winding();
}

void FieldsReader::open(const std::filesystem::path& path) {
  file_ = open_to_read(path);
  if (!file_ && access(path.c_str(), R_OK) != 0) throw bad_file("cannot be read; check its permissions");
  if (!file_) throw bad_file("is not an HDF5 file that can be read; name the fields.h5 of a run");
  time_ = open_dataset(file_, "time");
  if (time_ && !was_written(time_, true)) throw bad_file("/time was never written; write the time of each frame there");
  momentum_ = open_dataset(file_, "momentum");
  for (const Role role : all_roles) {
    const bool needed = role == Role::field;
    Hdf5Handle dataset = open_dataset(file_, to_string(role));
    if (needed && !dataset) throw bad_file("has no dataset /field; " + other_datasets(file_));
    const auto extent = extent_of(dataset);
    if (needed && !extent) throw bad_file("/field is not frames x sites x components; " + other_datasets(file_));
    if (needed && !fits(*extent))
      throw bad_file(
          fmt::format("/field is {} x {} x {}; name the fields.h5 of a run", (*extent)[0], (*extent)[1], (*extent)[2]));
    if (!extent || !fits(*extent)) continue;
    if (!was_written(dataset, true))
      throw bad_file(fmt::format("/{} is {} x {} x {}, and not all of that was ever written; write it whole",
                                 to_string(role), (*extent)[0], (*extent)[1], (*extent)[2]));
    parts_[at(role)] = {
        std::move(dataset),
        {static_cast<int>((*extent)[0]), static_cast<int>((*extent)[1]), static_cast<int>((*extent)[2])}};
  }
}

std::optional<double> FieldsReader::time(int frame) const {
  if (!time_) return std::nullopt;
  const auto offset = static_cast<hsize_t>(frame);
  const hsize_t one = 1;
  double t = 0;
  if (!read_slice(time_, 1, &offset, &one, &t)) throw bad_file(fmt::format("/time has no frame {}", frame));
  return t;
}

std::vector<double> FieldsReader::values(Role role, int frame) const {
  const auto& [dataset, shape] = part(role);
  std::vector<double> values(at(shape.sites) * at(shape.components));
  const std::array<hsize_t, 3> offset{static_cast<hsize_t>(frame), 0, 0},
      count{1, static_cast<hsize_t>(shape.sites), static_cast<hsize_t>(shape.components)};
  if (!frame_was_written(dataset, offset[0]))
    throw bad_file(fmt::format("frame {} of /{} was never written; take an earlier frame", frame, to_string(role)));
  if (!read_slice(dataset, 3, offset.data(), count.data(), values.data()))
    throw bad_file(fmt::format("frame {} cannot be read; the file is damaged", frame));
  return values;
}

std::vector<double> FieldsReader::row(int frame) const {
  if (frame >= frames())
    throw BadInput("initial.frame", fmt::format("frame {} is needed, and the file has {} of them; record more rows, "
                                                "with output.every = 1",
                                                frame, frames()));
  const std::vector<double> row = values(Role::field, frame);
  for (std::size_t i = 0; i < row.size(); ++i)
    if (!std::isfinite(row[i]))
      throw bad_file(
          fmt::format("frame {} is not finite at site {}; take an earlier frame", frame, i / at(components())));
  return row;
}

std::optional<std::vector<double>> FieldsReader::momenta(int frame) const {
  const auto extent = momentum_ ? extent_of(momentum_) : std::nullopt;
  const hsize_t frames = static_cast<hsize_t>(this->frames()), sites = static_cast<hsize_t>(this->sites()),
                fields = static_cast<hsize_t>(components());
  if (!extent || *extent != std::array{frames, sites, fields}) return std::nullopt;
  std::vector<double> p(sites * fields);
  const std::array<hsize_t, 3> offset{static_cast<hsize_t>(frame), 0, 0}, count{1, sites, fields};
  if (frame >= this->frames() || !read_slice(momentum_, 3, offset.data(), count.data(), p.data())) return std::nullopt;
  for (const double value : p)
    if (!std::isfinite(value)) return std::nullopt;
  return p;
}

std::optional<std::vector<double>> FieldsReader::positions() const {
  const Hdf5Handle dataset(H5Dopen2(file_, "space", H5P_DEFAULT), H5Dclose);
  const hsize_t none = 0, sites = static_cast<hsize_t>(this->sites());
  std::vector<double> x(sites);
  if (!dataset || rank_of(dataset) != 1) return std::nullopt;
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  if (H5Sget_simple_extent_npoints(space) != static_cast<hssize_t>(sites)) return std::nullopt;
  return read_slice(dataset, 1, &none, &sites, x.data()) ? std::optional(x) : std::nullopt;
}

std::optional<std::vector<double>> FieldsReader::moving_positions(int frame) const {
  const Hdf5Handle dataset = open_dataset(file_, "mesh");
  const hsize_t from[2] = {static_cast<hsize_t>(frame), 0}, count[2] = {1, static_cast<hsize_t>(sites())};
  if (!dataset || rank_of(dataset) != 2) return std::nullopt;
  std::vector<double> x(count[1]);
  return read_slice(dataset, 2, from, count, x.data()) ? std::optional(x) : std::nullopt;
}

std::optional<std::vector<double>> FieldsReader::coordinates() const {
  const Hdf5Handle dataset(H5Dopen2(file_, "space", H5P_DEFAULT), H5Dclose);
  if (!dataset || rank_of(dataset) != 2) return positions();
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  hsize_t extent[2];
  H5Sget_simple_extent_dims(space, extent, nullptr);
  constexpr hsize_t most_dimensions = 3, from[2] = {0, 0};
  if (extent[0] != static_cast<hsize_t>(sites()) || extent[1] > most_dimensions) return std::nullopt;
  std::vector<double> x(extent[0] * extent[1]);
  return read_slice(dataset, 2, from, extent, x.data()) ? std::optional(x) : std::nullopt;
}

namespace {

/// The text of an attribute; empty if there is none, or if it is no text.
std::string text_of(hid_t object, const char* name) {
  if (H5Aexists(object, name) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
  if (!attribute) throw bad_file("its attributes cannot be read; the file is damaged");
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  if (H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0 || H5Sget_simple_extent_npoints(space) != 1)
    return {};
  std::string text(H5Tget_size(type), '\0');
  if (H5Aread(attribute, type, text.data()) < 0) throw bad_file("its attributes cannot be read; the file is damaged");
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

}  // namespace

std::string FieldsReader::scene() const { return text_of(file_, "scene"); }

std::vector<std::string> FieldsReader::names() const {
  const std::string text = text_of(part(Role::field).dataset, "components");
  return text.empty() ? std::vector<std::string>() : parts_of(text);
}

std::optional<int> FieldsReader::winding() const {
  const htri_t there = H5Aexists(file_, "winding");
  if (there == 0) return std::nullopt;
  const Hdf5Handle attribute(H5Aopen(file_, "winding", H5P_DEFAULT), H5Aclose);
  if (there < 0 || !attribute) throw bad_file("its attributes cannot be read; the file is damaged");
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose), space(H5Aget_space(attribute), H5Sclose);
  constexpr auto remedy = "write one whole number, or leave it out and let the rows say it";
  const H5T_class_t kind = H5Tget_class(type);
  if (kind != H5T_INTEGER && kind != H5T_FLOAT)
    throw bad_file(fmt::format("its attribute winding is {}; {}", kind == H5T_STRING ? "a text" : "no number", remedy));
  if (const auto count = H5Sget_simple_extent_npoints(space);
      count != 1)  // or more would be written than there is room for
    throw bad_file(fmt::format("its attribute winding has {} values; {}", count, remedy));
  double value = 0;
  if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &value) < 0)
    throw bad_file("its attributes cannot be read; the file is damaged");
  if (value != std::round(value) || std::abs(value) > std::numeric_limits<int>::max())
    throw bad_file(fmt::format("its attribute winding is {}; {}", value, remedy));
  return static_cast<int>(value);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/files/fields_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>

#include "lattice/index.hpp"
#include "tools/files/mark_closed.hpp"
#include "tools/files/named_axes.hpp"
#include "tools/files/open_to_read.hpp"
#include "tools/report/failure.hpp"

namespace delf {

namespace {

bool write_text(hid_t object, const char* name, const std::string& text) {
  const Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
  H5Tset_size(type, std::max<std::size_t>(1, text.size()));
  H5Tset_cset(type, H5T_CSET_UTF8);
  H5Tset_strpad(type, H5T_STR_NULLPAD);
  const Hdf5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute, type, text.c_str()) >= 0;
}

bool write_integer(hid_t object, const char* name, int value) {
  const Hdf5Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Hdf5Handle attribute(H5Acreate2(object, name, H5T_STD_I32LE, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  return attribute && H5Awrite(attribute, H5T_NATIVE_INT, &value) >= 0;
}

// No times of creation, so that a rerun gives the same bytes.
Hdf5Handle timeless() {
  Hdf5Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(properties, false);
  return properties;
}

// A dataset that grows along its first axis, one chunk at a time, each written at once: a disk that is full is noticed
// before anything on it refers to what did not fit.
Hdf5Handle growing(hid_t file, const char* name, std::vector<hsize_t> chunk) {
  const int rank = static_cast<int>(chunk.size());
  std::vector<hsize_t> now = chunk, most = chunk;
  now[0] = 0;
  most[0] = H5S_UNLIMITED;
  if (rank > 1) chunk[1] = std::min<hsize_t>(chunk[1], 1 << 20);
  const Hdf5Handle space(H5Screate_simple(rank, now.data(), most.data()), H5Sclose);
  const Hdf5Handle properties = timeless();
  H5Pset_chunk(properties, rank, chunk.data());
  H5Pset_fletcher32(properties);  // a damaged block is noticed when it is read
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  H5Pset_fill_value(properties, H5T_NATIVE_DOUBLE, &nothing);  // and a row that a failed write has lost
  const Hdf5Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  H5Pset_chunk_cache(access, 1, 0, H5D_CHUNK_CACHE_W0_DEFAULT);
  return {H5Dcreate2(file, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, properties, access), H5Dclose};
}

hsize_t frames_of_a_chunk(hid_t dataset) {
  const Hdf5Handle properties(H5Dget_create_plist(dataset), H5Pclose);
  std::array<hsize_t, H5S_MAX_RANK> chunk{};
  return H5Pget_layout(properties) == H5D_CHUNKED && H5Pget_chunk(properties, H5S_MAX_RANK, chunk.data()) > 0
             ? std::max<hsize_t>(1, chunk[0])
             : 1;
}

// {frames, sites, …}
std::vector<hsize_t> block_of(hsize_t frames, const std::vector<hsize_t>& shape) {
  std::vector<hsize_t> block{frames};
  block.insert(block.end(), shape.begin(), shape.end());
  return block;
}

bool append_block(hid_t dataset, hsize_t old, const std::vector<hsize_t>& block, const double* data) {
  const int rank = static_cast<int>(block.size());
  std::vector<hsize_t> now = block, offset(block.size());
  now[0] = old + block[0];
  offset[0] = old;
  if (H5Dset_extent(dataset, now.data()) < 0) return false;
  const Hdf5Handle target(H5Dget_space(dataset), H5Sclose),
      source(H5Screate_simple(rank, block.data(), nullptr), H5Sclose);
  return H5Sselect_hyperslab(target, H5S_SELECT_SET, offset.data(), nullptr, block.data(), nullptr) >= 0 &&
         H5Dwrite(dataset, H5T_NATIVE_DOUBLE, source, target, H5P_DEFAULT, data) >= 0;
}

}  // namespace

FieldsFile::FieldsFile(const std::filesystem::path& path, std::span<const double> space, std::int64_t expected_frames,
                       const std::string& scene, int winding, const RowNames& names, const MeshOfFile& mesh,
                       const WrittenPart& kept)
    : path_(path), sites_(space.size() / at(mesh.coordinates)), names_(names) {
  constexpr std::size_t block = 1 << 17;  // doubles: 1 MiB
  std::size_t columns = 0;
  for (const Role role : all_roles) columns = std::max(columns, names.of[role].size());
  for (const auto& dataset : names.datasets) columns = std::max(columns, dataset.components.size());
  frames_per_block_ = std::clamp<std::size_t>(block / (sites_ * columns), 1, 1024);
  frames_per_block_ = std::min(frames_per_block_, at(std::max<std::int64_t>(1, expected_frames)));
  quiet_hdf5();
  const std::filesystem::path made = kept.size > 0 ? std::filesystem::path(path.string() + ".part") : path;
  written_to_ = made;
  const Hdf5Handle format(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_libver_bounds(format, H5F_LIBVER_V110, H5F_LIBVER_V110);
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  H5Pset_obj_track_times(creation, false);
  file_ = {H5Fcreate(made.c_str(), H5F_ACC_TRUNC, creation, format), H5Fclose};
  require(static_cast<bool>(file_), "cannot be created");

  const hsize_t sites = sites_;
  const std::array<hsize_t, 2> extents{sites, static_cast<hsize_t>(mesh.coordinates)};
  const Hdf5Handle extent(H5Screate_simple(mesh.cells.empty() ? 1 : 2, extents.data(), nullptr), H5Sclose),
      properties = timeless();
  const Hdf5Handle positions(H5Dcreate2(file_, "space", H5T_IEEE_F64LE, extent, H5P_DEFAULT, properties, H5P_DEFAULT),
                             H5Dclose);
  time_ = growing(file_, "time", {frames_per_block_});
  for (const Role role : all_roles)
    if (!names.of[role].empty()) rows_[role] = rows(to_string(role), {sites, names.of[role].size()});
  const Rows& field = rows_[Role::field];
  if (names.mesh) mesh_ = rows("mesh", {sites});
  if (mesh.node_times) node_times_ = rows("node_time", {sites});
  Hdf5Handle cells;
  if (!mesh.cells.empty()) {
    const auto corners = static_cast<hsize_t>(mesh.corners);
    const std::array<hsize_t, 2> shape{mesh.cells.size() / corners, corners};
    const Hdf5Handle of_cells(H5Screate_simple(2, shape.data(), nullptr), H5Sclose);
    cells = {H5Dcreate2(file_, "cells", H5T_STD_I32LE, of_cells, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose};
    require(cells && H5Dwrite(cells, H5T_NATIVE_INT32, H5S_ALL, H5S_ALL, H5P_DEFAULT, mesh.cells.data()) >= 0,
            "cannot be written");
  }
  require(positions && time_ && field.dataset &&
              H5Dwrite(positions, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, space.data()) >= 0 &&
              write_text(positions, "units", "dimensionless") && write_text(time_, "units", "dimensionless") &&
              write_text(field.dataset, "units", "dimensionless") && write_text(file_, "scene", scene) &&
              write_text(file_, "version", DELF_VERSION) && write_integer(file_, "winding", winding),
          "cannot be written");
  const auto describe = [&](const Rows& of, const std::vector<std::string>& components) {
    if (!of.dataset) return;
    const bool units = &of == &field || write_text(of.dataset, "units", "dimensionless");
    require(units && write_text(of.dataset, "components", fmt::format("{}", fmt::join(components, ","))),
            "cannot be written");
  };
  if (!names.plain()) {
    for (const Role role : all_roles) describe(rows_[role], names.of[role]);
    if (names.mesh) describe(mesh_, {names.of[names.mesh->role][names.mesh->index]});
  }
  for (const auto& [name, meaning, components] : names.datasets) {
    datasets_.push_back(rows(name.c_str(), {sites, components.size()}));
    describe(datasets_.back(), components);
    require(datasets_.back().dataset && write_text(datasets_.back().dataset, "meaning", meaning), "cannot be written");
  }
  name_axes(positions, cells, mesh);
  // Every write leaves, from here on (single writer, multiple readers), a file that can be read whenever a run ends.
  require(H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0 && H5Fstart_swmr_write(file_) >= 0, "cannot be written");
  times_.reserve(frames_per_block_);
  if (kept.size == 0) return;
  std::error_code error;
  try {
    copy_frames(path, kept);
  } catch (const std::exception&) {
    std::filesystem::remove(made, error);
    throw;
  }
  std::filesystem::rename(made, path, error);
  require(!error, "cannot be replaced");
  written_to_ = path;
}

/// frames × sites × components: /time and, of a lattice, /space are the scales of the first two axes.
void FieldsFile::name_axes(hid_t positions, hid_t cells, const MeshOfFile& mesh) {
  const auto attach = [&](hid_t dataset, unsigned axis, hid_t scale, const char* label) {
    require(name_axis(dataset, axis, scale, label), "cannot be written");
  };
  require(make_scale(time_, "time"), "cannot be written");
  const bool is_mesh = !mesh.cells.empty();
  const char* const of_sites = is_mesh ? "site" : "space";
  Hdf5Handle sites;
  if (is_mesh) {
    sites = scale_without_values(file_, of_sites, sites_);
    const auto corners = static_cast<hsize_t>(mesh.corners);
    attach(positions, 0, sites, of_sites);
    attach(positions, 1, scale_without_values(file_, "coordinate", static_cast<hsize_t>(mesh.coordinates)),
           "coordinate");
    attach(cells, 0, scale_without_values(file_, "cell", mesh.cells.size() / corners), "cell");
    attach(cells, 1, scale_without_values(file_, "corner", corners), "corner");
  } else {
    require(make_scale(positions, of_sites), "cannot be written");
  }
  for (const Rows* rows : all_rows()) {
    if (!rows->dataset) continue;
    attach(rows->dataset, 0, time_, "time");
    attach(rows->dataset, 1, is_mesh ? static_cast<hid_t>(sites) : positions, of_sites);
    if (rows->shape.size() < 2) continue;
    const std::string components = rows->name + "_component";
    attach(rows->dataset, 2, scale_without_values(file_, components.c_str(), rows->shape[1]), components.c_str());
  }
}

void FieldsFile::copy_frames(const std::filesystem::path& from, const WrittenPart& kept) {
  const hsize_t frames = kept.size;
  const Hdf5Handle old = open_to_read(from);
  // A kill in the midst of the last block leaves a wrong checksum there; its rows before the checkpoint are written again
  // the same. Blocks that were full at the checkpoint are written once, and must be whole. What the rows are, its checksum
  // tells.
  const Hdf5Handle trusting(H5Pcreate(H5P_DATASET_XFER), H5Pclose);
  H5Pset_edc_check(trusting, H5Z_DISABLE_EDC);
  const auto read = [&](const char* name, hsize_t first, const std::vector<hsize_t>& block, double* to) {
    const Hdf5Handle dataset(H5Dopen2(old, name, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle source(H5Dget_space(dataset), H5Sclose);
    const int rank = static_cast<int>(block.size());
    if (H5Sget_simple_extent_ndims(source) != rank) return false;
    const Hdf5Handle target(H5Screate_simple(rank, block.data(), nullptr), H5Sclose);
    std::vector<hsize_t> offset(block.size());
    offset[0] = first;
    return H5Sselect_hyperslab(source, H5S_SELECT_SET, offset.data(), nullptr, block.data(), nullptr) >= 0 &&
           (H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, H5P_DEFAULT, to) >= 0 ||
            (first + block[0] > frames - frames % frames_of_a_chunk(dataset) &&
             H5Dread(dataset, H5T_NATIVE_DOUBLE, target, source, trusting, to) >= 0));
  };
  bool there = static_cast<bool>(old);
  for (hsize_t first = 0; there && first < frames; first += frames_per_block_) {
    const hsize_t count = std::min<hsize_t>(frames_per_block_, frames - first);
    times_.resize(count);
    there = read("time", first, {count}, times_.data());
    for (Rows* rows : all_rows()) {
      if (!rows->dataset || !there) continue;
      const std::vector<hsize_t> block = block_of(count, rows->shape);
      hsize_t values = 1;
      for (const hsize_t n : block) values *= n;
      rows->waiting.resize(values);
      there = read(rows->name.c_str(), first, block, rows->waiting.data());
    }
    if (there) write_block();
  }
  if (there && written_.sum == kept.sum) return;
  abandon();
  if (there)
    throw BadScene(fmt::format(
        "{}: is damaged: its rows are not those that the checkpoint counts on; begin the run anew", from.string()));
  throw BadScene(fmt::format("{}: the {} rows that the checkpoint counts on {}; begin the run anew", from.string(),
                             frames, old ? "cannot be read" : "are gone, or the file is damaged"));
}

const WrittenPart& FieldsFile::flush(bool sync) {
  write_block();
  void* descriptor = nullptr;
  if (sync)
    require(H5Fget_vfd_handle(file_, H5P_DEFAULT, &descriptor) >= 0 && fsync(*static_cast<int*>(descriptor)) == 0,
            "cannot be written");
  return written_;
}

FieldsFile::Rows FieldsFile::rows(const char* name, std::vector<hsize_t> shape) const {
  Rows made{growing(file_, name, block_of(frames_per_block_, shape)), std::move(shape), {}, name};
  hsize_t values = frames_per_block_;
  for (const hsize_t n : made.shape) values *= n;
  made.waiting.reserve(values);
  return made;
}

FieldsFile::~FieldsFile() = default;

std::vector<FieldsFile::Rows*> FieldsFile::all_rows() {
  std::vector<Rows*> all;
  for (const Role role : all_roles) all.push_back(&rows_[role]);
  all.push_back(&mesh_);
  all.push_back(&node_times_);
  for (Rows& rows : datasets_) all.push_back(&rows);
  return all;
}

void FieldsFile::append(double time, const RecordedRow& row, const RecordedDatasets& datasets,
                        std::span<const double> node_times) {
  times_.push_back(time);
  const auto add = [](Rows& to, std::span<const double> values) {
    to.waiting.insert(to.waiting.end(), values.begin(), values.end());
  };
  for (const Role role : all_roles)
    if (rows_[role].dataset) add(rows_[role], row[role]);
  if (const auto& mesh = names_.mesh)
    for (std::size_t i = mesh->index; i < row[mesh->role].size(); i += names_.of[mesh->role].size())
      mesh_.waiting.push_back(row[mesh->role][i]);
  if (node_times_.dataset) add(node_times_, node_times);
  for (std::size_t d = 0; d < datasets_.size(); ++d) add(datasets_[d], datasets[d]);
  // blocks end where chunks do
  if ((written_.size + times_.size()) % frames_per_block_ == 0) write_block();
}

/// Reserves the disk for a block of rows. Where there is no room nothing is begun, and the file can be closed as it is.
bool FieldsFile::has_room() {
#ifdef __linux__
  constexpr std::size_t metadata = 1 << 16;
  std::size_t values = 1;
  for (const Rows* rows : all_rows()) {
    if (!rows->dataset) continue;
    std::size_t of_frame = 1;
    for (const hsize_t n : rows->shape) of_frame *= n;
    values += of_frame;
  }
  void* descriptor = nullptr;
  struct stat now {};
  if (H5Fget_vfd_handle(file_, H5P_DEFAULT, &descriptor) < 0 || fstat(*static_cast<int*>(descriptor), &now) != 0)
    return true;
  const auto bytes = static_cast<off_t>(sizeof(double) * frames_per_block_ * values + metadata);
  rlimit most{};
  if (getrlimit(RLIMIT_FSIZE, &most) == 0 && most.rlim_cur != RLIM_INFINITY &&
      static_cast<rlim_t>(now.st_size + bytes) > most.rlim_cur)
    return false;
  return fallocate(*static_cast<int*>(descriptor), FALLOC_FL_KEEP_SIZE, now.st_size, bytes) == 0 ||
         (errno != ENOSPC && errno != EFBIG && errno != EDQUOT);
#else
  return true;
#endif
}

bool FieldsFile::close_all() {
  bool closed = time_.close();
  for (Rows* rows : all_rows()) closed = rows->dataset.close() && closed;
  return file_.close() && closed;
}

void FieldsFile::write_block() {
  if (times_.empty()) return;
  const hsize_t frames = times_.size();
  if (!has_room()) {
    close_all();
    require(false, "cannot be written");
  }
  bool written = append_block(time_, written_.size, {frames}, times_.data());
  for (Rows* rows : all_rows())
    if (rows->dataset)
      written =
          written && append_block(rows->dataset, written_.size, block_of(frames, rows->shape), rows->waiting.data());
  require(written && H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0, "cannot be written");
  for (std::size_t frame = 0; frame < frames; ++frame) {
    written_.sum.add(std::span(times_).subspan(frame, 1));
    for (const Rows* rows : all_rows()) {
      const std::size_t values = rows->waiting.size() / frames;
      written_.sum.add(std::span(rows->waiting).subspan(frame * values, values));
    }
  }
  written_.size += frames;
  times_.clear();
  for (Rows* rows : all_rows()) rows->waiting.clear();
}

void FieldsFile::close() {
  if (!file_) return;
  write_block();
  require(close_all(), "cannot be closed");
}

// Closing would write a header that promises more than there is; without it the last flush stays readable.
void FieldsFile::abandon() {
  for (Rows* rows : all_rows()) rows->dataset.abandon();
  time_.abandon();
  file_.abandon();
}

void FieldsFile::require(bool went_well, const char* what) {
  if (went_well) return;
  abandon();
  mark_closed(written_to_);
  throw SystemFailure(fmt::format("{}: {}; check that its disk has room and may be written to", path_.string(), what));
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/files/plain_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string_view>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/read_number.hpp"
#include "tools/files/hdf5_handle.hpp"
#include "tools/files/read_apart.hpp"
#include "tools/files/written_storage.hpp"

namespace delf {
namespace {

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view separators = ",; \t\r";
  std::vector<std::string_view> words;
  for (std::size_t begin = 0; (begin = line.find_first_not_of(separators, begin)) != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(separators, begin), line.size());
    words.push_back(line.substr(begin, end - begin));
    begin = end;
  }
  return words;
}

std::optional<double> number(std::string_view word) {
  if (word.starts_with('+')) word.remove_prefix(1);
  return read_number<double>(word);
}

std::string plain_name(std::string_view name) {
  std::string lower;
  for (const char c : name)
    if (c != '"') lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower;
}

bool is_time(std::string_view name) { return plain_name(name) == "t" || plain_name(name) == "time"; }

/// "p", "p1", "p2", …
bool is_momentum(std::string_view name) {
  const std::string plain = plain_name(name);
  return plain.starts_with('p') && std::ranges::all_of(plain.substr(1), [](char c) { return c >= '0' && c <= '9'; });
}

}  // namespace

PlainRows::PlainRows(PlainArray array, int sites, int components)
    : sites_(sites), components_(components), array_(std::move(array)) {
  const auto wanted = delf::at(sites) * delf::at(components);
  std::vector<std::size_t>& shape = array_.shape;
  if (shape.size() == 3) shape = {shape[0], shape[1] * shape[2]};
  if (shape.size() == 1)
    shape = wanted == 1 ? std::vector<std::size_t>{shape[0], 1} : std::vector<std::size_t>{1, shape[0]};
  columns_ = shape[1] != wanted && shape[0] == wanted;
  if (!columns_ && shape[1] != wanted)
    throw bad_file(
        fmt::format("holds {} x {} numbers, and a row of the scheme has {} ({} sites, {} fields); give a line, or a "
                    "column, for every row, or correct lattice.sites",
                    shape[0], shape[1], wanted, sites, components));
  frames_ = static_cast<int>(columns_ ? shape[1] : shape[0]);
}

std::optional<double> PlainRows::time(int frame) const {
  if (array_.times.size() != delf::at(frames_)) return std::nullopt;
  return array_.times[frame];
}

std::vector<double> PlainRows::frame_of(const std::vector<double>& values, int frame) const {
  const std::size_t j = frame, width = array_.shape[1];
  std::vector<double> row;
  for (std::size_t n = 0; n < (columns_ ? array_.shape[0] : width); ++n)
    row.push_back(values[columns_ ? n * width + j : j * width + n]);
  return row;
}

std::vector<double> PlainRows::row(int frame) const {
  if (frame >= frames_)
    throw BadInput("initial.frame",
                   fmt::format("row {} is needed, and the file has {} of them; give it more", frame, frames_));
  return frame_of(array_.values, frame);
}

std::optional<std::vector<double>> PlainRows::momenta(int frame) const {
  if (array_.momenta.empty()) return std::nullopt;
  return frame_of(array_.momenta, frame);
}

PlainArray read_table(const std::filesystem::path& path, std::size_t row_size) {
  std::ifstream in(path);
  if (!in) throw bad_file("cannot be read; check its permissions");
  PlainArray array;
  std::size_t lines = 0, columns = 0;
  int at = 0;
  bool time_first = false;
  std::vector<bool> of_momenta;  // columns after the time
  for (std::string line; std::getline(in, line);) {
    ++at;
    if (at == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    const auto words = words_of(line);
    if (words.empty() || words[0][0] == '#' || words[0][0] == '%') continue;
    if (lines == 0 && columns == 0 && !number(words[0])) {  // names
      columns = words.size();
      time_first = is_time(words[0]);
      for (std::size_t n = time_first ? 1 : 0; n < columns; ++n) of_momenta.push_back(is_momentum(words[n]));
      continue;
    }
    if (columns == 0) columns = words.size();
    if (words.size() != columns)
      throw bad_file(
          fmt::format("line {} has {} columns, and others have {}; give as many", at, words.size(), columns));
    for (const std::string_view word : words) {
      const auto value = number(word);
      if (!value)
        throw bad_file(fmt::format("line {}: \"{}\" is no number; write one like 0.125", at, word.substr(0, 30)));
      array.values.push_back(*value);
    }
    ++lines;
  }
  if (lines == 0) throw bad_file("holds no numbers; give a line for every row");
  // One unknown in one line is a row of frames.
  const bool one_line = lines == 1 && row_size == 1;
  if (!one_line && (time_first || (columns == row_size + 1 && lines != row_size))) {
    std::vector<double> fields;
    for (std::size_t n = 0; n < array.values.size(); ++n)
      (n % columns == 0 ? array.times : fields).push_back(array.values[n]);
    array.values = std::move(fields);
    --columns;
  }
  if (const std::size_t momenta = std::ranges::count(of_momenta, true);
      momenta == row_size && columns == 2 * row_size && of_momenta.size() == columns) {
    std::vector<double> fields;
    for (std::size_t n = 0; n < array.values.size(); ++n)
      (of_momenta[n % columns] ? array.momenta : fields).push_back(array.values[n]);
    array.values = std::move(fields);
    columns = row_size;
  }
  array.shape = {lines, columns};
  return array;
}

namespace {

PlainArray dataset_of(const std::filesystem::path& path, const std::string& name) {
  const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file) throw bad_file("is not an HDF5 file that can be read");
  const Hdf5Handle dataset(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!dataset) throw bad_file(fmt::format("has no dataset {}; name another by --dataset", name));
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  if (rank < 1 || rank > 3)
    throw bad_file(fmt::format("{} has {} axes; give frames x sites, or frames x sites x fields", name, rank));
  hsize_t extent[3] = {};
  H5Sget_simple_extent_dims(space, extent, nullptr);
  if (!was_written(dataset)) throw bad_file(fmt::format("not all of {} was ever written; write it whole", name));
  PlainArray array;
  array.shape.assign(extent, extent + rank);
  array.values.resize(array.count());
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) < 0)
    throw bad_file(fmt::format("{} cannot be read as numbers", name));
  for (const char* beside : {"momentum", "p", "pi"}) {
    if (name == beside || H5Lexists(file, beside, H5P_DEFAULT) <= 0) continue;
    const Hdf5Handle momenta(H5Dopen2(file, beside, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle shape(momenta ? H5Dget_space(momenta) : H5I_INVALID_HID, H5Sclose);
    hsize_t other[3] = {};
    if (!momenta || H5Sget_simple_extent_ndims(shape) != rank ||
        H5Sget_simple_extent_dims(shape, other, nullptr) != rank || !std::equal(other, other + rank, extent) ||
        !was_written(momenta))
      continue;
    array.momenta.resize(array.values.size());
    if (H5Dread(momenta, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.momenta.data()) < 0)
      throw bad_file(fmt::format("{} cannot be read as numbers", beside));
    break;
  }
  return array;
}

}  // namespace

PlainArray read_dataset(const std::filesystem::path& path, const std::string& name) {
  quiet_hdf5();
  read_apart(path, [&] { dataset_of(path, name); });
  return dataset_of(path, name);
}

std::filesystem::path file_of_rows(const std::filesystem::path& path) {
  const std::string text = path.string();
  return std::filesystem::exists(path) ? path : std::filesystem::path(text.substr(0, text.rfind(":/")));
}

std::unique_ptr<RowsFile> open_plain_rows(const std::filesystem::path& path, int sites, int components) {
  const std::string text = path.string(), ending = path.extension().string();
  const auto wanted = delf::at(sites) * delf::at(components);
  if (const std::size_t colon = text.rfind(":/"); colon != std::string::npos && !std::filesystem::exists(path)) {
    const std::string file = text.substr(0, colon), name = text.substr(colon + 1);
    return std::make_unique<PlainRows>(
        file.ends_with(".npz") ? read_npz(file, name.substr(1)) : read_dataset(file, name), sites, components);
  }
  if (ending == ".npz") return std::make_unique<PlainRows>(read_npz(path, ""), sites, components);
  if (ending == ".npy") return std::make_unique<PlainRows>(read_npy(path), sites, components);
  if (ending == ".csv" || ending == ".txt" || ending == ".dat") {
    if (ending == ".csv") {
      std::ifstream in(path);
      std::string line;
      while (std::getline(in, line) && (line.empty() || line[0] == '#')) continue;
      if (line.find("row,site") != std::string::npos) return open_rows(path);
    }
    return std::make_unique<PlainRows>(read_table(path, wanted), sites, components);
  }
  return nullptr;
}

}  // namespace delf

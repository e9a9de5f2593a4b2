// SPDX-License-Identifier: MIT
#include "tools/files/plain_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "lattice/error.hpp"
#include "tools/files/hdf5_handle.hpp"

namespace delf {
namespace {

BadInput bad_file(const std::string& what) { return {"initial.file", what}; }

std::size_t product(const std::vector<std::size_t>& shape) {
  std::size_t all = 1;
  for (const std::size_t n : shape) all *= n;
  return all;
}

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
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && end == word.data() + word.size() ? std::optional(value) : std::nullopt;
}

bool is_time(std::string_view name) {
  std::string lower;
  for (const char c : name)
    if (c != '"') lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return lower == "t" || lower == "time";
}

}  // namespace

PlainRows::PlainRows(PlainArray array, int sites, int components)
    : sites_(sites), components_(components), array_(std::move(array)) {
  const auto wanted = static_cast<std::size_t>(sites) * static_cast<std::size_t>(components);
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
  if (array_.times.size() != static_cast<std::size_t>(frames_)) return std::nullopt;
  return array_.times[static_cast<std::size_t>(frame)];
}

std::vector<double> PlainRows::row(int frame) const {
  const auto j = static_cast<std::size_t>(frame), width = array_.shape[1];
  std::vector<double> row;
  for (std::size_t n = 0; n < (columns_ ? array_.shape[0] : width); ++n)
    row.push_back(array_.values[columns_ ? n * width + j : j * width + n]);
  return row;
}

PlainArray read_table(const std::filesystem::path& path, std::size_t row_size) {
  std::ifstream in(path);
  if (!in) throw bad_file("cannot be read; check its permissions");
  PlainArray array;
  std::size_t lines = 0, columns = 0;
  int at = 0;
  bool time_first = false;
  for (std::string line; std::getline(in, line);) {
    ++at;
    if (at == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);
    const auto words = words_of(line);
    if (words.empty() || words[0][0] == '#' || words[0][0] == '%') continue;
    if (lines == 0 && columns == 0 && !number(words[0])) {  // names
      columns = words.size();
      time_first = is_time(words[0]);
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
  array.shape = {lines, columns};
  return array;
}

PlainArray read_npy(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  const std::string all((std::istreambuf_iterator<char>(in)), std::istreambuf_iterator<char>());
  const auto refuse = [](const char* why) {
    return bad_file(std::string(why) + "; write it by numpy.save, of float64");
  };
  // "\x93NUMPY", version, length of the header, header, data
  if (all.size() < 12 || all.compare(0, 6, "\x93NUMPY") != 0) throw refuse("is no .npy file");
  const auto byte = [&](std::size_t n) { return static_cast<std::size_t>(static_cast<unsigned char>(all[n])); };
  const bool long_header = byte(6) > 1;
  const std::size_t begin = long_header ? 12 : 10;
  const std::size_t length =
      long_header ? byte(8) | byte(9) << 8 | byte(10) << 16 | byte(11) << 24 : byte(8) | byte(9) << 8;
  if (all.size() < begin + length) throw refuse("is cut short");
  const std::string header = all.substr(begin, length);
  const bool doubles = header.find("'<f8'") != std::string::npos, singles = header.find("'<f4'") != std::string::npos;
  if (!doubles && !singles) throw refuse("is not of float64 or float32");
  PlainArray array;
  const std::size_t open = header.find("'shape': ("), close = header.find(')', open);
  if (open == std::string::npos || close == std::string::npos) throw refuse("has no shape");
  for (const std::string_view word : words_of(std::string_view(header).substr(open + 10, close - open - 10)))
    array.shape.push_back(static_cast<std::size_t>(number(word).value_or(0)));
  if (array.shape.empty() || array.shape.size() > 3) throw refuse("has no axis, or more than three");
  const std::size_t count = product(array.shape), size = doubles ? sizeof(double) : sizeof(float);
  if (all.size() < begin + length + count * size) throw refuse("is cut short");
  array.values.resize(count);
  for (std::size_t n = 0; n < count; ++n) {
    const char* from = all.data() + begin + length + n * size;
    if (doubles) std::memcpy(&array.values[n], from, size);
    else {
      float value = 0;
      std::memcpy(&value, from, size);
      array.values[n] = static_cast<double>(value);
    }
  }
  if (header.find("'fortran_order': True") != std::string::npos) {
    if (array.shape.size() == 3) throw refuse("has three axes in Fortran's order");
    if (array.shape.size() == 2) {
      const std::size_t frames = array.shape[0], width = array.shape[1];
      std::vector<double> turned(count);
      for (std::size_t j = 0; j < frames; ++j)
        for (std::size_t n = 0; n < width; ++n) turned[j * width + n] = array.values[n * frames + j];
      array.values = std::move(turned);
    }
  }
  return array;
}

PlainArray read_dataset(const std::filesystem::path& path, const std::string& name) {
  quiet_hdf5();
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
  PlainArray array;
  array.shape.assign(extent, extent + rank);
  array.values.resize(product(array.shape));
  if (H5Dread(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, array.values.data()) < 0)
    throw bad_file(fmt::format("{} cannot be read as numbers", name));
  return array;
}

std::unique_ptr<RowsFile> open_plain_rows(const std::filesystem::path& path, int sites, int components) {
  const std::string text = path.string(), ending = path.extension().string();
  const auto wanted = static_cast<std::size_t>(sites) * static_cast<std::size_t>(components);
  if (const std::size_t colon = text.rfind(":/"); colon != std::string::npos && !std::filesystem::exists(path))
    return std::make_unique<PlainRows>(read_dataset(text.substr(0, colon), text.substr(colon + 1)), sites, components);
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

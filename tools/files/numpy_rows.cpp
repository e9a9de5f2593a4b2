// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <zlib.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"
#include "tools/files/plain_rows.hpp"

namespace delf {
namespace {

std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

PlainArray npy_of(const std::string& all) {
  const auto refuse = [](const char* why) {
    return bad_file(std::string(why) + "; write it by numpy.save, of float64");
  };
  // "\x93NUMPY", version, length of the header, header, data
  if (all.size() < 12 || all.compare(0, 6, "\x93NUMPY") != 0) throw refuse("is no .npy file");
  const auto byte = [&](std::size_t n) { return delf::at(static_cast<unsigned char>(all[n])); };
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
  const auto room = static_cast<double>(all.size());
  double values = 1;
  for (const std::string& axis : parts_of(header.substr(open + 10, close - open - 10))) {
    if (axis.empty()) continue;  // behind the comma of (n,)
    std::size_t length_of_axis = 0;
    const auto [end, wrong] = std::from_chars(axis.data(), axis.data() + axis.size(), length_of_axis);
    values *= static_cast<double>(length_of_axis);
    if (wrong != std::errc{} || end != axis.data() + axis.size() || static_cast<double>(length_of_axis) > room ||
        values > room)
      throw refuse("has a shape of which it does not hold the values");
    array.shape.push_back(length_of_axis);
  }
  if (array.shape.empty() || array.shape.size() > 3) throw refuse("has no axis, or more than three");
  const std::size_t count = array.count(), size = doubles ? sizeof(double) : sizeof(float);
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

/// The `size` bytes that zlib has packed; nothing if they are not whole.
std::optional<std::string> inflated(const std::string& packed, std::size_t size) {
  constexpr std::size_t most = 1032;  // times smaller, by its format
  if (size / most > packed.size()) return std::nullopt;
  std::string bytes(size, '\0');
  z_stream stream{};
  constexpr int without_header = -15;
  if (inflateInit2(&stream, without_header) != Z_OK) return std::nullopt;
  // zlib counts in 32 bits
  std::size_t read = 0, written = 0;
  int state = Z_OK;
  while (state == Z_OK) {
    constexpr std::size_t part = 1 << 30;
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data())) + read;
    stream.avail_in = static_cast<uInt>(std::min(part, packed.size() - read));
    stream.next_out = reinterpret_cast<Bytef*>(bytes.data()) + written;
    stream.avail_out = static_cast<uInt>(std::min(part, size - written));
    const uInt in = stream.avail_in, out = stream.avail_out;
    state = inflate(&stream, Z_NO_FLUSH);
    read += in - stream.avail_in, written += out - stream.avail_out;
    if (state == Z_OK && in == stream.avail_in && out == stream.avail_out) break;
  }
  inflateEnd(&stream);
  if (state != Z_STREAM_END || written != size) return std::nullopt;
  return bytes;
}

/// The files in a ZIP archive, by name: stored as they are, or deflated.
std::map<std::string, std::string> files_of(const std::string& all) {
  const auto refuse = [](const char* why) { return bad_file(std::string(why) + "; write it by numpy.savez"); };
  const auto number = [&](std::size_t at, int bytes) {
    if (at + delf::at(bytes) > all.size()) throw refuse("is cut short");
    std::size_t value = 0;
    for (int n = bytes; n-- > 0;) value = value << 8 | static_cast<unsigned char>(all[at + delf::at(n)]);
    return value;
  };
  // The directory is named by the record at the end: "PK\5\6", …, entries (10), …, offset (16).
  const std::size_t end = all.rfind("PK\5\6");
  if (end == std::string::npos) throw refuse("is no .npz file");
  std::map<std::string, std::string> files;
  std::size_t at = number(end + 16, 4);
  for (std::size_t n = number(end + 10, 2); n > 0; --n) {
    // "PK\1\2", …, method (10), …, bytes in the archive (20), size (24), lengths of name, extra, comment (28), …, offset of
    // the file (42), name (46)
    const std::size_t method = number(at + 10, 2), packed = number(at + 20, 4), size = number(at + 24, 4),
                      name = number(at + 28, 2), file = number(at + 42, 4);
    if (method != 0 && method != 8) throw refuse("is compressed in a way that zlib does not know");
    const std::size_t data = file + 30 + number(file + 26, 2) + number(file + 28, 2);
    const std::size_t stored = method == 0 ? size : packed;
    if (data + stored > all.size() || at + 46 + name > all.size()) throw refuse("is cut short");
    std::string bytes = all.substr(data, stored);
    if (method == 8) {
      auto whole = inflated(bytes, size);
      if (!whole) throw refuse("is damaged");
      bytes = std::move(*whole);
    }
    files[all.substr(at + 46, name)] = std::move(bytes);
    at += 46 + name + number(at + 30, 2) + number(at + 32, 2);
  }
  return files;
}

constexpr std::array field_names{"q", "phi", "u", "field"};
constexpr std::array momentum_names{"p", "pi", "v", "momentum"};

}  // namespace

PlainArray read_npy(const std::filesystem::path& path) { return npy_of(bytes_of(path)); }

PlainArray read_npz(const std::filesystem::path& path, const std::string& name) {
  const auto files = files_of(bytes_of(path));
  const auto find = [&](const auto& names) {
    for (const char* one : names)
      if (const auto at = files.find(std::string(one) + ".npy"); at != files.end()) return at;
    return files.end();
  };
  auto fields = name.empty() ? find(field_names) : files.find(name + ".npy");
  if (fields == files.end() && name.empty() && files.size() == 1) fields = files.begin();
  if (fields == files.end()) {
    std::string all;
    for (const auto& [file, bytes] : files) all += (all.empty() ? "" : ", ") + file.substr(0, file.find(".npy"));
    throw bad_file(fmt::format("has the arrays {}; name the one with the rows by --dataset", all));
  }
  PlainArray array = npy_of(fields->second);
  if (const auto momenta = find(momentum_names); momenta != files.end() && momenta != fields) {
    PlainArray p = npy_of(momenta->second);
    if (p.shape == array.shape) array.momenta = std::move(p.values);
  }
  if (const auto times = find(std::array{"t", "time"}); times != files.end() && times != fields)
    array.times = npy_of(times->second).values;
  return array;
}

}  // namespace delf

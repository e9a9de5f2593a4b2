// SPDX-License-Identifier: MIT
#include "tools/scene/scene_text.hpp"

#include <fmt/format.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>

#include "tools/report/failure.hpp"

namespace delf {

namespace {

constexpr std::size_t most_bytes = 1 << 20;

// RFC 3629, without asking for the shortest form
bool is_utf8(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto lead = static_cast<unsigned char>(text[i]);
    const int more = lead < 0x80 ? 0 : (lead >> 5) == 0x6 ? 1 : (lead >> 4) == 0xe ? 2 : (lead >> 3) == 0x1e ? 3 : -1;
    if (more < 0) return false;
    for (int m = 0; m < more; ++m)
      if (++i == text.size() || (static_cast<unsigned char>(text[i]) & 0xc0) != 0x80) return false;
  }
  return true;
}

}  // namespace

std::string read_scene_text(const std::filesystem::path& file) {
  const std::string name = file.string();
  std::error_code ignored;
  if (std::filesystem::is_directory(file, ignored))
    throw BadScene(fmt::format("{}: is a directory, not a scene; name the file in it", name));
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(name.c_str(), "rb"), std::fclose);
  if (!in) throw BadScene(fmt::format("{}: {}; check the name and the rights", name, std::strerror(errno)));
  std::string text;
  std::array<char, 4096> block;  // a scene is small: no room for the largest is kept
  for (std::size_t count = block.size(); count == block.size() && text.size() <= most_bytes;) {
    count = std::fread(block.data(), 1, block.size(), in.get());
    text.append(block.data(), count);
  }
  if (std::ferror(in.get())) throw BadScene(fmt::format("{}: cannot be read; check the file", name));
  if (text.size() > most_bytes)
    throw BadScene(fmt::format("{}: is too large for a scene; is it the right file?", name));
  if (text.find('\0') != std::string::npos || !is_utf8(text))
    throw BadScene(fmt::format("{}: is a binary file, not a scene; is it the right file?", name));
  if (text.find('\r') != std::string::npos && text.find('\n') == std::string::npos)
    throw BadScene(fmt::format("{}: its lines end in CR alone, which makes all of it one line; end them in LF", name));
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);
  return text;
}

}  // namespace delf

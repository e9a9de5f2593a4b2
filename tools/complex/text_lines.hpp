// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>

#include "tools/complex/mesh_text.hpp"

namespace delf {

/// Lines of a mesh's text, and the words of each; # begins a comment. Throws MeshError with the line.
class TextLines {
 public:
  explicit TextLines(std::string_view text) : rest_(text) {}

  int number() const { return number_; }
  /// The next line that has words; false at the end.
  bool next() {
    while (!rest_.empty()) {
      const auto end = std::min(rest_.find('\n'), rest_.size());
      line_ = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      ++number_;
      line_ = line_.substr(0, line_.find('#'));
      if (skip(); !line_.empty()) return true;
    }
    return false;
  }
  std::string_view word() {
    const auto end = std::min(line_.find_first_of(blanks), line_.size());
    const std::string_view first = line_.substr(0, end);
    line_.remove_prefix(end);
    skip();
    return first;
  }
  bool has_words() const { return !line_.empty(); }
  [[noreturn]] void refuse(const std::string& what) const { throw MeshError(number_, what); }

  template <class Number>
  Number read(const char* what) {
    return number_of<Number>(word(), what);
  }
  /// A word of this line as a number.
  template <class Number>
  Number number_of(std::string_view text, const char* what) const {
    Number value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size() || text.empty())
      refuse(fmt::format("\"{}\" is not {}; correct it", text.substr(0, 40), what));
    if constexpr (std::is_floating_point_v<Number>)
      if (!std::isfinite(value)) refuse(fmt::format("\"{}\" is not finite; correct it", text.substr(0, 40)));
    return value;
  }
  void need_next(const char* what) {
    if (!next()) refuse(fmt::format("the file ends before {}; it is cut short", what));
  }
  void need_section(std::string_view name) {
    need_next(std::string(name).c_str());
    if (word() != name) refuse(fmt::format("{} is missing here; correct the count above it", name));
  }

 private:
  static constexpr auto blanks = " \t\r\v\f";
  void skip() { line_.remove_prefix(std::min(line_.find_first_not_of(blanks), line_.size())); }

  std::string_view rest_, line_;
  int number_ = 0;
};

}  // namespace delf

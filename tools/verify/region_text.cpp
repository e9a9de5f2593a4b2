// SPDX-License-Identifier: MIT
#include "tools/verify/region_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <set>

#include "lattice/error.hpp"
#include "lattice/region.hpp"

namespace delf {

namespace {

constexpr int most_rows = 10000;
constexpr std::int64_t most_sites = 100000;  // a projection onto first variations takes minutes there

// "2:5" or "7", which is 7:7
bool read_range(std::string_view text, Range& range) {
  const auto integer = [](std::string_view t, int& value) {
    const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), value);
    return error == std::errc() && end == t.data() + t.size();
  };
  const std::size_t colon = text.find(':');
  if (colon == std::string_view::npos) return integer(text, range.first) && integer(text, range.last);
  return integer(text.substr(0, colon), range.first) && integer(text.substr(colon + 1), range.last) &&
         range.first <= range.last;
}

}  // namespace

std::vector<Site> sites_of_region(std::string_view text, const Lattice& lattice) {
  std::set<Site> sites;
  std::int64_t count = 0;  // of all rectangles
  for (std::size_t begin = 0; begin < text.size();) {
    const bool away = begin > 0 && text[begin] == '-';  // there is nothing yet that the first could be taken from
    if (begin > 0) ++begin;
    const std::size_t end = std::min(text.find_first_of("+-", begin), text.size()), cross = text.find('x', begin);
    Range rows, columns;
    if (cross >= end || !read_range(text.substr(begin, cross - begin), rows) ||
        !read_range(text.substr(cross + 1, end - cross - 1), columns) || rows.first < 0 || rows.last > most_rows ||
        columns.first < 0 || columns.last / 2 >= lattice.sites())
      throw BadInput("verify.regions",
                     fmt::format("\"{}\" is no region; write a kind, such as hole, or ROWSxSITES, such as "
                                 "0:8x10:30, with more added by + or taken away by -",
                                 text));
    count += std::int64_t{rows.last - rows.first + 1} * (columns.last - columns.first + 1);
    if (count > most_sites)
      throw BadInput("verify.regions",
                     fmt::format("\"{}\" has rectangles of more than {} sites; take smaller ones", text, most_sites));
    for (int j = rows.first; j <= rows.last; ++j)
      for (int i = columns.first; i <= columns.last; ++i) {
        const Site site{j, lattice.is_circle() ? lattice.wrapped(i) : i};
        if (away) sites.erase(site);
        else sites.insert(site);
      }
    begin = end;
  }
  return {sites.begin(), sites.end()};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/verify/region_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <set>

#include "lattice/error.hpp"
#include "lattice/read_number.hpp"
#include "lattice/region.hpp"

namespace delf {

namespace {

constexpr int most_rows = 10000;
constexpr std::int64_t most_sites = 100000;  // a projection onto first variations takes minutes there

// "2:5" or "7", which is 7:7
bool read_range(std::string_view text, Range& range) {
  const std::size_t colon = text.find(':');
  const auto first = read_number<int>(text.substr(0, colon));
  const auto last = colon == std::string_view::npos ? first : read_number<int>(text.substr(colon + 1));
  if (!first || !last) return false;
  range.first = *first, range.last = *last;
  return range.first <= range.last;
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

// SPDX-License-Identifier: MIT
#include "tools/complex/stencil_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "lattice/index.hpp"
#include "lattice/nearest_name.hpp"
#include "tools/complex/text_lines.hpp"

namespace delf {
namespace {

constexpr std::string_view head = "complex", site_word = "site", stencil_word = "stencil", share_word = "share",
                           circle_word = "circle";
/// In the order of SiteRole.
constexpr std::array<std::string_view, 4> roles{"free", "given", "initial", "final"};

bool is_number(std::string_view word) { return !word.empty() && word.find_first_of("0123456789.") != word.npos; }

StencilList::Site read_site(TextLines& lines) {
  StencilList::Site site{.line = lines.number()};
  std::string_view word;
  for (std::size_t c = 0; c < 4 && (c < 2 || lines.has_words()); ++c) {
    word = lines.word();
    if (c >= 2 && !is_number(word)) break;
    site.position[c] = lines.number_of<double>(word, "a coordinate");
    word = {};
  }
  if (word.empty() && lines.has_words()) word = lines.word();
  if (!word.empty()) {
    const auto role = std::ranges::find(roles, word);
    if (role == roles.end())
      lines.refuse(
          fmt::format("\"{}\" is neither a coordinate nor {}; correct it", word.substr(0, 40), fmt::join(roles, ", ")));
    site.role = static_cast<SiteRole>(role - roles.begin());
  }
  if (lines.has_words()) lines.refuse("a site has t, x, y, z and one role at most; remove the rest");
  return site;
}

StencilList::Entry read_stencil(TextLines& lines) {
  StencilList::Entry entry{.shape = std::string(lines.word()), .sites = {}, .line = lines.number()};
  if (!stencil_shape(entry.shape)) {
    const auto near = nearest(entry.shape, stencil_shape_names());
    lines.refuse(fmt::format("\"{}\" is no shape of stencils; {}", entry.shape.substr(0, 40),
                             near ? fmt::format("did you mean {}?", *near)
                                  : fmt::format("there are {}", fmt::join(stencil_shape_names(), ", "))));
  }
  while (lines.has_words()) {
    const std::string_view word = lines.word();
    if (word == share_word) {
      entry.share = lines.read<double>("a share");
      if (lines.has_words()) lines.refuse("a stencil ends with its share; remove the rest");
    } else {
      entry.sites.push_back(lines.number_of<int>(word, "the number of a site"));
    }
  }
  return entry;
}

}  // namespace

bool is_stencil_text(std::string_view text) {
  TextLines lines(text);
  return lines.next() && lines.word() == head && !lines.has_words();
}

StencilList parse_stencils(std::string_view text) {
  TextLines lines(text);
  if (!lines.next() || lines.word() != head) lines.refuse("a finite complex begins with the line complex; add it");
  StencilList list;
  while (lines.next()) {
    const std::string_view kind = lines.word();
    if (kind == site_word) list.sites.push_back(read_site(lines));
    else if (kind == stencil_word) list.stencils.push_back(read_stencil(lines));
    else if (kind == circle_word) {
      list.circumference = lines.read<double>("a length");
      if (!(list.circumference > 0) || lines.has_words()) lines.refuse("circle takes one length above 0; correct it");
    } else
      lines.refuse(
          fmt::format("\"{}\" is neither site nor stencil; correct it, or begin the line with #", kind.substr(0, 40)));
  }
  if (const auto fault = find_fault(list)) throw MeshError(fault->line, fault->what);
  return list;
}

std::string stencil_text(const StencilList& list) {
  std::string text = fmt::format("{}\n", head);
  if (list.circumference > 0) text += fmt::format("{} {}\n", circle_word, list.circumference);
  const int coordinates = list.coordinates();
  for (const StencilList::Site& s : list.sites)
    text += fmt::format("{} {}{}\n", site_word, fmt::join(s.position.begin(), s.position.begin() + coordinates, " "),
                        s.role == SiteRole::free ? "" : fmt::format(" {}", roles[at(s.role)]));
  for (const StencilList::Entry& e : list.stencils)
    text += fmt::format("{} {} {}{}\n", stencil_word, e.shape, fmt::join(e.sites, " "),
                        e.share ? fmt::format(" {} {}", share_word, *e.share) : "");
  return text;
}

}  // namespace delf

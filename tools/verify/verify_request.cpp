// SPDX-License-Identifier: MIT
#include "tools/verify/verify_request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace {

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of(", \t", begin), text.size());
    if (end > begin) words.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

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

// Rectangles ROWSxSITES, added and taken away: "0:8x10:30-3:5x18:22"
RegionRequest read_region(const Scene& scene, const std::string& word) {
  constexpr int most_rows = 10000;
  RegionRequest request{"given " + word, std::nullopt, {}};
  for (std::size_t begin = 0; begin < word.size();) {
    const bool away = begin > 0 && word[begin] == '-';  // there is nothing yet that the first could be taken from
    if (begin > 0) ++begin;
    const std::size_t end = std::min(word.find_first_of("+-", begin), word.size()), cross = word.find('x', begin);
    Range rows, sites;
    if (cross >= end || !read_range(std::string_view(word).substr(begin, cross - begin), rows) ||
        !read_range(std::string_view(word).substr(cross + 1, end - cross - 1), sites) || rows.first < 0 ||
        rows.last > most_rows || sites.first < 0 || sites.last >= 2 * scene.problem.lattice.sites())
      throw scene.settings.error("verify.regions",
                                 fmt::format("\"{}\" is no region; write a kind, such as hole, or ROWSxSITES, such as "
                                             "0:8x10:30, with more added by + or taken away by -",
                                             word));
    for (int j = rows.first; j <= rows.last; ++j)
      for (int i = sites.first; i <= sites.last; ++i) {
        const Site site{j, scene.problem.lattice.is_circle() ? scene.problem.lattice.wrapped(i) : i};
        if (away) std::erase(request.sites, site);
        else request.sites.push_back(site);
      }
    begin = end;
  }
  return request;
}

}  // namespace

bool VerifyRequest::wants(std::string_view check) const { return std::ranges::find(checks, check) != checks.end(); }

const std::vector<std::string>& verify_checks() {
  static const std::vector<std::string> all{"equations", "forms",       "noether", "balance",
                                            "reversal",  "derivatives", "newton"};
  return all;
}

const std::vector<std::string>& verify_faults() {
  static const std::vector<std::string> all{"none", "variation", "sign", "field"};
  return all;
}

VerifyRequest read_verify_request(const Scene& scene) {
  const Values values(scene.settings);
  VerifyRequest request;
  for (const std::string& word : words_of(values.text("verify.regions").value_or(""))) {
    const auto& kinds = region_kinds();
    const auto kind = std::ranges::find_if(kinds, [&](RegionKind k) { return word == to_string(k); });
    if (kind != kinds.end()) request.regions.push_back({word, *kind, {}});
    else if (word.find_first_of("0123456789") != std::string::npos) request.regions.push_back(read_region(scene, word));
    else {
      std::vector<std::string> names;
      for (const RegionKind k : kinds) names.emplace_back(to_string(k));
      throw scene.settings.error("verify.regions",
                                 fmt::format("{} is no kind of region{}; or write ROWSxSITES, such as "
                                             "0:8x10:30",
                                             word, suggestion(word, names)));
    }
  }
  if (request.regions.empty())
    for (const RegionKind kind : region_kinds()) request.regions.push_back({to_string(kind), kind, {}});

  request.checks = words_of(values.text("verify.checks").value_or(""));
  request.chosen = !request.checks.empty();
  for (const std::string& check : request.checks)
    if (std::ranges::find(verify_checks(), check) == verify_checks().end())
      throw scene.settings.error("verify.checks",
                                 fmt::format("{} is no check{}", check, suggestion(check, verify_checks())));
  if (!request.chosen) request.checks = verify_checks();
  request.variations = static_cast<int>(values.integer("verify.variations"));
  request.moments = static_cast<int>(values.integer("verify.moments"));
  request.tolerance = values.real("verify.tolerance");
  request.generator = values.text("verify.generator").value_or("");
  request.force = values.toggle("verify.force");
  request.identify = values.toggle("verify.identify");
  request.unwrap = values.toggle("verify.unwrap");
  request.fault = values.choice("verify.fault");
  return request;
}

}  // namespace delf

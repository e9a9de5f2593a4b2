// SPDX-License-Identifier: MIT
#include "tools/results/same_scene.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <map>

namespace delf {
namespace {

/// The same text, or the same number.
bool same(const std::string& one, const std::string& other) {
  if (one == other) return true;
  char *end = nullptr, *other_end = nullptr;
  const double a = std::strtod(one.c_str(), &end), b = std::strtod(other.c_str(), &other_end);
  return !one.empty() && !other.empty() && *end == '\0' && *other_end == '\0' && std::abs(a - b) <= 1e-12 * std::abs(a);
}

/// The keys that were verified; of a verify.json without them, what its head tells.
std::map<std::string, std::string> verified_keys(const Json* verify) {
  std::map<std::string, std::string> keys;
  if (const auto settings = verify->find("settings"); settings != verify->end() && settings->is_object())
    for (const auto& [key, value] : settings->items()) keys[key] = text_in(&*settings, key);
  if (!keys.empty()) return keys;
  for (const auto& [key, in_head] : {std::pair("theory.name", "theory"), std::pair("lattice.stencil", "stencil"),
                                     std::pair("scheme.method", "method")})
    keys[key] = text_in(verify, in_head);
  for (const auto& [key, in_head] : {std::pair("lattice.sites", "sites"), std::pair("lattice.time_step", "time_step")})
    if (const auto number = number_in(verify, in_head)) keys[key] = fmt::format("{}", *number);
  return keys;
}

}  // namespace

std::vector<std::string> other_scene(const ResultFolder& folder) {
  const Json* verify = folder.result("verify");
  std::vector<std::string> words;
  if (!verify) return words;
  const bool stepped = text_in(verify, "subject") == "rows computed here";
  for (const auto& [key, there] : verified_keys(verify)) {
    const auto here = folder.keys.find(key);
    const bool of_rows = key.starts_with("initial.") || key.starts_with("run.");
    if (here == folder.keys.end() || there.empty() || same(there, here->second) || (of_rows && !stepped)) continue;
    words.push_back(fmt::format("{} is {} in verify.json, and {} in scene.ini", key, there, here->second));
  }
  return words;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "schemes/methods/method_registry.hpp"
#include "tools/diagnosis/findings.hpp"

namespace delf {

std::string keys_of(const Problem& scheme, const Problem& scene) {
  std::vector<std::string> keys;
  if (scheme.method != scene.method) keys.push_back("scheme.method = " + scheme.method);
  if (find_method(scheme.method).reads_stencil && (scheme.stencil != scene.stencil || scheme.method != scene.method))
    keys.push_back("lattice.stencil = " + scheme.stencil);
  for (const auto& [key, value] : scheme.parameters)
    if (const int* number = std::get_if<int>(&value); number && scene.parameters.maybe<int>(key) != *number)
      keys.push_back(fmt::format("{} = {}", key, *number));
    else if (const std::string* word = std::get_if<std::string>(&value);
             word && scene.parameters.maybe<std::string>(key) != *word)
      keys.push_back(fmt::format("{} = {}", key, *word));
  return fmt::format("{}", fmt::join(keys, ", "));
}

namespace {

// Brick walls are laid in two ways.
bool holds(const Sample& sample, const Problem& p, Sample::Stride stride, double tolerance, bool& shifted) {
  for (const int shift : {0, 1}) {
    const auto found = sample.equations(p, stride, shift);
    if (found && found->hold(tolerance)) {
      shifted = shift != 0;
      return true;
    }
  }
  return false;
}

struct Part {
  Sample::Stride stride;
  const char* words;
};
constexpr std::array parts{Part{{1, 1}, ""},
                           Part{{1, 2},
                                " on every second site: their space step is 2k; take lattice.sites = N/2, or leave "
                                "every second site out"},
                           Part{{2, 1}, " of every second row: rows are half a step apart, and the time step is 2h"},
                           Part{{2, 2}, " on every second site of every second row: the steps are 2h and 2k"}};

}  // namespace

std::optional<Finding> find_scheme(const Evidence& evidence, const Sample& sample) {
  const auto& schemes = sample.schemes();
  bool shifted = false;
  for (const Part& part : parts) {
    std::vector<std::string> same;  // linear rows solve the equations of several schemes
    const NamedScheme* first = nullptr;
    for (const NamedScheme& scheme : schemes) {
      if (!holds(sample, scheme.problem, part.stride, evidence.tolerance, shifted)) continue;
      if (!first) first = &scheme;
      else if (scheme.name != first->name && same.size() < 3) same.push_back(scheme.name);
    }
    if (!first) continue;
    const std::string keys = keys_of(first->problem, evidence.problem);
    const bool own = first == &schemes.front() && part.stride.rows == 1 && part.stride.sites == 1;
    // The scene's own scheme holds in the sample, and fails elsewhere.
    if (own && evidence.failed.failed() > 0 && !shifted) continue;
    return Finding{
        "scheme", fmt::format("The rows solve the equations of {}{}{}.{}{}", first->name,
                              keys.empty() ? "" : " (" + keys + ")", part.words,
                              shifted && own ? " Its bricks begin one site further on: leave out the first frame." : "",
                              same.empty() ? "" : fmt::format(" So do those of {}.", fmt::join(same, ", ")))};
  }
  return std::nullopt;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/declared.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "lattice/error.hpp"

namespace delf {
namespace {

void check_range(const Parameter& p, double value) {
  const auto refuse = [&](const char* bound, double end, const char* remedy) {
    throw BadInput(p.key, fmt::format("{} = {}: must be {} {}; {} {}", p.key, value, bound, end, remedy, p.key));
  };
  if (!(value >= p.range.low) || (p.range.open && value == p.range.low))
    refuse(p.range.open ? "above" : "at least", p.range.low, "raise");
  if (value > p.range.high) refuse("at most", p.range.high, "lower");
}

void check(const Parameter& p, const ParameterValue& value) {
  const bool widened = std::holds_alternative<double>(p.fallback) && std::holds_alternative<int>(value);
  if (value.index() != p.fallback.index() && !widened)
    throw BadInput(p.key,
                   fmt::format("{} = {}: is of another type than {}", p.key, to_text(value), to_text(p.fallback)));
  if (const double* number = std::get_if<double>(&value)) check_range(p, *number);
  if (const int* number = std::get_if<int>(&value)) check_range(p, *number);
  if (const std::string* text = std::get_if<std::string>(&value))
    if (!p.choices.empty() && std::ranges::find(p.choices, *text) == p.choices.end())
      throw BadInput(p.key, fmt::format("{} = {}: is {}; choose one", p.key, *text, fmt::join(p.choices, " or ")));
}

}  // namespace

void complete(ParameterValues& values, const std::vector<Parameter>& declared) {
  for (const Parameter& p : declared)
    if (values.has(p.key)) check(p, values[p.key]);
    else if (p.otherwise.empty()) values[p.key] = p.fallback;
}

const Parameter* find_parameter(const std::vector<Parameter>& declared, std::string_view key) {
  const auto at = std::ranges::find(declared, key, &Parameter::key);
  return at == declared.end() ? nullptr : &*at;
}

std::string to_text(const ParameterValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

}  // namespace delf

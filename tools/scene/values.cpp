// SPDX-License-Identifier: MIT
#include "tools/scene/values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "jets/expressions/expression.hpp"
#include "lattice/text_parts.hpp"
#include "tools/scene/program_keys.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace {

std::string_view unsigned_part(std::string_view text) {
  return text.size() > 1 && text[0] == '+' && text[1] != '-' ? text.substr(1) : text;
}

// reads all of `text`, or says how far it is from a number
template <class Number>
std::errc read(std::string_view text, Number& value) {
  text = unsigned_part(text);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end != text.data() + text.size() ? std::errc::invalid_argument : error;
}

constexpr std::string_view of_theory = "theory.";

std::string below(std::string_view key, const Limits& range, auto low) {
  return fmt::format("must be {} {}; raise {}", range.open ? "above" : "at least", low, key);
}
std::string above(std::string_view key, auto high) { return fmt::format("must be at most {}; lower {}", high, key); }

}  // namespace

std::optional<std::string> Values::text(std::string_view key) const {
  if (const Setting* s = settings_.find(key)) {
    if (s->value.empty()) throw settings_.error(key, "no value is given; give one, or remove the key");
    return s->value;
  }
  const std::string fallback = fallback_of(known(key));
  return fallback.empty() ? std::nullopt : std::optional(fallback);
}

Parameter Values::known(std::string_view name) const {
  for (const Declaration& declaration : declarations()) {
    const auto p = std::ranges::find(declaration.parameters, name, &Parameter::key);
    if (p == declaration.parameters.end()) continue;
    const std::string_view by = chosen_by(declaration.kind);
    const Setting* chosen = settings_.find(by);
    if (declaration.name == (chosen ? chosen->value : fallback_of(*find_key(by)))) return *p;
  }
  return *settings_.key(name);
}

std::string Values::required(std::string_view key) const {
  if (auto value = text(key)) return *value;
  throw settings_.error(key, fmt::format("must be given ({})", known(key).help));
}

// 2*pi, 10*sqrt(2), m/2: anything with an operator or a bracket behind its first character, and names of numbers
std::optional<double> Values::formula(std::string_view key, std::string_view text) const {
  std::vector<std::pair<std::string, double>> parameters;
  if (!key.starts_with(of_theory))
    for (const DeclaredKey& own : settings_.declared())
      if (own.kind == DeclaredBy::theory && type_of(own.parameter) == KeyType::real)
        parameters.emplace_back(own.parameter.key.substr(of_theory.size()), real(own.parameter.key));
  const std::string_view name = text.starts_with('-') ? text.substr(1) : text;
  const bool is_name = name == "pi" || std::ranges::count(parameters, name, &std::pair<std::string, double>::first) > 0;
  if (!is_name && text.find_first_of("+-*/^(", 1) == std::string_view::npos) return std::nullopt;
  try {
    return number_of(text, std::string(key), parameters);
  } catch (const BadInput& bad) {
    throw settings_.located(bad);
  }
}

double Values::number(const Parameter& key, std::string_view text) const {
  double value = 0;
  std::errc error = read(text, value);
  if (error == std::errc::invalid_argument)
    if (const auto result = formula(key.key, text)) value = *result, error = {};
  if (error == std::errc::result_out_of_range)
    throw settings_.error(key.key, "is outside the range of double precision; use a number that is in it");
  if (error != std::errc())
    throw settings_.error(key.key, "is not a number; write one like 0.125 or 1e-6, or a formula like 2*pi");
  if (!std::isfinite(value)) throw settings_.error(key.key, "is not a finite number; give one");
  if (value < key.range.low || (key.range.open && value == key.range.low))
    throw settings_.error(key.key, below(key.key, key.range, key.range.low));
  if (value > key.range.high) throw settings_.error(key.key, above(key.key, key.range.high));
  return value;
}

double Values::real(std::string_view key) const { return number(known(key), required(key)); }

std::optional<double> Values::maybe_real(std::string_view key) const {
  return given(key) ? std::optional(real(key)) : std::nullopt;
}

std::int64_t Values::integer(std::string_view key) const {
  const std::string value = required(key);
  std::int64_t number = 0;
  std::errc error = read(value, number);
  if (error == std::errc::invalid_argument)
    if (const auto result = formula(key, value); result && *result == std::round(*result) && std::abs(*result) < 9e15)
      number = static_cast<std::int64_t>(*result), error = {};
  if (error == std::errc::result_out_of_range) throw settings_.error(key, "is too large; use a smaller integer");
  if (error != std::errc()) throw settings_.error(key, "is not an integer; write one like 255");
  const Limits range = known(key).range;
  constexpr int most = std::numeric_limits<int>::max();
  const std::int64_t low = std::isfinite(range.low) ? static_cast<std::int64_t>(range.low) : -most;
  const std::int64_t high = std::isfinite(range.high) ? static_cast<std::int64_t>(range.high) : most;
  if (number < low) throw settings_.error(key, below(key, range, low));
  if (number > high) throw settings_.error(key, above(key, high));
  return number;
}

std::optional<std::int64_t> Values::maybe_integer(std::string_view key) const {
  return given(key) ? std::optional(integer(key)) : std::nullopt;
}

bool Values::toggle(std::string_view key) const {
  const std::string value = required(key);
  for (const char* yes : {"on", "true", "yes", "1"})
    if (value == yes) return true;
  for (const char* no : {"off", "false", "no", "0"})
    if (value == no) return false;
  throw settings_.error(key, "must be on or off");
}

std::string Values::choice(std::string_view key) const {
  const std::string value = required(key);
  const auto choices = known(key).choices;
  const auto has = [&](const std::string& name) {
    return std::find(choices.begin(), choices.end(), name) != choices.end();
  };
  if (!has(value) && !has(formula_choice)) throw settings_.error(key, "is not known" + suggestion(value, choices));
  return value;
}

std::vector<double> Values::times(std::string_view key) const {
  std::vector<double> numbers;
  const std::string list = text(key).value_or("");
  for (std::size_t begin = 0; begin < list.size();) {
    const std::size_t end = std::min(list.find(',', begin), list.size());
    numbers.push_back(number(known(key), trimmed(std::string_view(list).substr(begin, end - begin))));
    begin = end + 1;
  }
  return numbers;
}

ParameterValue Values::parameter(const Parameter& p) const {
  if (std::holds_alternative<double>(p.fallback)) return real(p.key);
  if (std::holds_alternative<int>(p.fallback)) return static_cast<int>(integer(p.key));
  if (type_of(p) == KeyType::toggle) return toggle(p.key) ? "on" : "off";
  return p.choices.empty() ? required(p.key) : choice(p.key);
}

void Values::check(const Parameter& key) const {
  if (!given(key.key)) return;
  switch (type_of(known(key.key))) {
    case KeyType::real:
      real(key.key);
      break;
    case KeyType::integer:
      integer(key.key);
      break;
    case KeyType::toggle:
      toggle(key.key);
      break;
    case KeyType::choice:
      choice(key.key);
      break;
    case KeyType::text:
      text(key.key);
      break;
  }
}

}  // namespace delf

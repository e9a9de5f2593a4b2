// SPDX-License-Identifier: MIT
#include "tools/measure/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "jets/expressions/expression.hpp"
#include "schemes/text_parts.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/scene/suggestion.hpp"

namespace delf {

namespace {

using Constants = std::vector<std::pair<std::string, double>>;
constexpr std::string_view section = "measure.";

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool in_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)); }

const MeasurementEntry* find_measurement(std::string_view name) {
  const auto found = std::ranges::find(measurements(), name, &MeasurementEntry::name);
  return found == measurements().end() ? nullptr : &*found;
}

std::string usage(const MeasurementEntry& entry) {
  return *entry.arguments ? fmt::format("{}({})", entry.name, entry.arguments) : entry.name;
}

// theory.NAME as NAME, and the length of space
Constants constants_of(const Scene& scene) {
  Constants constants;
  constexpr std::string_view of_theory = "theory.";
  for (const auto& [key, value] : scene.problem.parameters)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with(of_theory))
      constants.emplace_back(key.substr(of_theory.size()), *number);
  if (scene.problem.lattice.space() != Space::point) constants.emplace_back("L", scene.problem.lattice.length());
  return constants;
}

// The end of the bracket that opens at `open`, or npos.
std::size_t closing(std::string_view text, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < text.size(); ++i) {
    if (text[i] == '(') ++depth;
    if (text[i] == ')' && --depth == 0) return i;
  }
  return std::string_view::npos;
}

std::vector<std::string> arguments_of(std::string_view text) {
  std::vector<std::string> all;
  int depth = 0;
  std::string now;
  for (const char c : text) {
    depth += (c == '(') - (c == ')');
    if (c == ',' && depth == 0) all.push_back(trimmed(now)), now.clear();
    else now += c;
  }
  if (!all.empty() || !trimmed(now).empty()) all.push_back(trimmed(now));
  return all;
}

}  // namespace

struct Measures::Expression {
  std::string name, key, arithmetic;  ///< arithmetic: with the names of quantities in place of measurements
  Constants constants;
  struct Quantity {
    std::string name;
    std::unique_ptr<Measurement> measurement;
  };
  std::vector<Quantity> quantities;

  // Measurements become quantities, which the arithmetic names.
  void read(std::string_view text, const MeasuredField& field) {
    for (std::size_t i = 0; i < text.size();) {
      if (std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.') {  // 1e5 has no name in it
        do arithmetic += text[i++];
        while (i < text.size() && (in_name(text[i]) || text[i] == '.'));
        continue;
      }
      if (!begins_name(text[i])) {
        arithmetic += text[i++];
        continue;
      }
      std::size_t end = i;
      while (end < text.size() && in_name(text[end])) ++end;
      const std::string_view word = text.substr(i, end - i);
      i = end;
      if (const MeasurementEntry* entry = find_measurement(word)) i = read_measurement(*entry, text, end, field);
      else if (word == "x") throw BadInput(key, "x is no number here; give a place, as value(10)");
      else arithmetic += word;
    }
    evaluate(0, [](const Measurement&) { return 1.0; });  // for its errors
  }

  std::size_t read_measurement(const MeasurementEntry& entry, std::string_view text, std::size_t at,
                               const MeasuredField& field) {
    std::vector<double> numbers;
    while (at < text.size() && text[at] == ' ') ++at;
    if (at < text.size() && text[at] == '(') {
      const std::size_t end = closing(text, at);
      if (end == std::string_view::npos)
        throw BadInput(key, fmt::format("{}: the bracket is not closed; write {}", entry.name, usage(entry)));
      for (const std::string& argument : arguments_of(text.substr(at + 1, end - at - 1)))
        numbers.push_back(Formula(argument, constants, key)(0, 0));
      at = end + 1;
    }
    if (numbers.size() < entry.least || numbers.size() > entry.most)
      throw BadInput(key, fmt::format("{}: {} numbers are given; write {}", entry.name, numbers.size(), usage(entry)));
    quantities.push_back({fmt::format("q{}", quantities.size() + 1), entry.make(field, numbers)});
    arithmetic += quantities.back().name;
    return at;
  }

  double evaluate(double time, auto&& value_of) const {
    Constants all = constants;
    for (const Quantity& q : quantities) all.emplace_back(q.name, value_of(*q.measurement));
    return Formula(arithmetic, all, key)(time, 0);
  }
};

Measures::Measures(const Scene& scene, int winding, const Simulation& simulation) {
  const std::vector<std::string> names = measure_names(scene.settings);
  if (names.empty()) return;
  const Problem& p = scene.problem;
  const auto& components = simulation.components();
  const MeasuredField field{p.lattice,
                            p.time_step,
                            2 * std::numbers::pi * winding,
                            p.circle_valued || find_theory(p.theory).angle,
                            simulation.count(Role::field),
                            make_theory(find_theory(p.theory), p.parameters)};
  for (const std::string& name : names) {
    Expression expression{name, std::string(section) + name, {}, constants_of(scene), {}};
    try {
      if (std::ranges::any_of(components, &Component::position))
        throw BadInput(expression.key, "the sites of this scheme move; measurements need sites that stay; remove it");
      expression.read(scene.settings.find(expression.key)->value, field);
    } catch (const BadInput& bad) {
      throw scene.settings.located(bad);
    }
    all_.push_back(std::move(expression));
  }
}

Measures::~Measures() = default;

void Measures::see(const MeasuredRow& row) {
  time_ = row.time;
  for (Expression& expression : all_)
    for (auto& q : expression.quantities) q.measurement->see(row);
}

std::vector<NamedNumber> Measures::results() const {
  std::vector<NamedNumber> all;
  for (const Expression& e : all_)
    all.push_back({e.name, e.evaluate(time_, [](const Measurement& m) { return m.value(); })});
  return all;
}

std::vector<std::string> measure_names(const Settings& settings) {
  std::vector<std::string> names;
  for (const DeclaredKey& own : settings.declared())
    if (own.key.name.starts_with(section)) names.push_back(own.key.name.substr(section.size()));
  return names;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/measure/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <numbers>

#include "jets/expressions/expression.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/theories/angles.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/measure/measure_names.hpp"

namespace delf {

namespace {

using Constants = std::vector<std::pair<std::string, double>>;
constexpr std::string_view reserved = "__";  ///< begins the names of quantities, which no scene can write

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool in_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)); }

const MeasurementEntry* find_measurement(std::string_view name) {
  const auto found = std::ranges::find(measurements(), name, &MeasurementEntry::name);
  return found == measurements().end() ? nullptr : &*found;
}

std::string usage(const MeasurementEntry& entry) {
  return *entry.arguments ? fmt::format("{}({})", entry.name, entry.arguments) : entry.name;
}

// The length of space, and theory.NAME as NAME; of two with one name the first counts.
Constants constants_of(const Scene& scene) {
  Constants constants;
  if (scene.problem.lattice.space() != Space::point) constants.emplace_back("L", scene.problem.lattice.length());
  constexpr std::string_view of_theory = "theory.";
  for (const auto& [key, value] : scene.problem.parameters)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with(of_theory))
      constants.emplace_back(key.substr(of_theory.size()), *number);
  return constants;
}

// The text with its words, but not the letters of numbers as 1e5, handed to `word`, and all else to `other`. `word` is
// given where the word begins and ends, and says where to go on.
void walk(std::string_view text, auto&& word, auto&& other) {
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i + 1;
    const bool number = std::isdigit(static_cast<unsigned char>(text[i])) || text[i] == '.';
    if (number || begins_name(text[i]))
      while (end < text.size() && (in_name(text[end]) || (number && text[end] == '.'))) ++end;
    if (begins_name(text[i])) i = word(i, end);
    else other(text.substr(i, end - i)), i = end;
  }
}

// Refuses words that could be taken for something else.
void check_words(std::string_view text, const std::string& key) {
  const auto check = [&](std::size_t begin, std::size_t end) {
    const std::string_view word = text.substr(begin, end - begin);
    if (word.starts_with(reserved))
      throw BadInput(
          key, fmt::format("{}: names that begin with {} are kept for measurements; use another", word, reserved));
    return end;
  };
  walk(text, check, [](std::string_view) {});
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
  bool sites_move = false;

  // Measurements become quantities, which the arithmetic names.
  void read(std::string_view text, const MeasuredField& field) {
    check_words(text, key);
    const auto word = [&](std::size_t begin, std::size_t end) {
      const std::string_view found = text.substr(begin, end - begin);
      if (const MeasurementEntry* entry = find_measurement(found)) return read_measurement(*entry, text, end, field);
      if (found == "x") throw BadInput(key, "x is no number here; give a place, as value(10)");
      arithmetic += found;
      return end;
    };
    walk(text, word, [&](std::string_view other) { arithmetic += other; });
    check_text();
  }

  // Compiles the text for its errors. A number that a run may have, such as log(value(1) - value(2)) or 1/(kinks - 1),
  // may be none at the first of the trial values.
  void check_text() const {
    for (const double step : {0.0, 0.1, -0.1}) try {
        double trial = 1;
        evaluate(0, [&](const Measurement&) { return trial += step; });
        return;
      } catch (const BadInput&) {
        if (step < 0) throw;
      }
  }

  std::size_t read_measurement(const MeasurementEntry& entry, std::string_view text, std::size_t at,
                               const MeasuredField& field) {
    if (sites_move && entry.reads_field)
      throw BadInput(key,
                     fmt::format("the sites of this scheme move, and {} needs sites that stay; remove it", entry.name));
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
    try {
      quantities.push_back({fmt::format("{}{}", reserved, quantities.size() + 1), entry.make(field, numbers)});
    } catch (const BadInput& bad) {
      throw BadInput(key, fmt::format("{}: {}", entry.name, bad.what()));
    }
    arithmetic += quantities.back().name;
    return at;
  }

  double evaluate(double time, auto&& value_of) const {
    Constants all;  // quantities first: no parameter hides one
    for (const Quantity& q : quantities) all.emplace_back(q.name, value_of(*q.measurement));
    all.insert(all.end(), constants.begin(), constants.end());
    return Formula(arithmetic, all, key)(time, 0);
  }

  // The text has been read: what is refused now has no value, such as 1/kinks without kinks.
  double result(double time) const {
    try {
      return evaluate(time, [](const Measurement& m) { return m.value(); });
    } catch (const BadInput&) {
      return Measurement::unknown;
    }
  }
};

Measures::Measures(const Scene& scene, int winding, const Simulation& simulation) {
  const std::vector<std::string> names = measure_names(scene.settings);
  if (names.empty()) return;
  check_measure_names(scene);
  const Problem& p = scene.problem;
  const auto& components = simulation.components();
  std::shared_ptr<const FieldTheory> theory = make_theory(find_theory(p.theory), p.parameters);
  const bool angle = p.circle_valued || std::ranges::count(angles_of(p.theory, *theory, p.parameters), 0) > 0;
  const MeasuredField field{p.lattice,
                            p.time_step,
                            2 * std::numbers::pi * winding + gain_of(p.parameters),
                            angle,
                            simulation.count(Role::field),
                            std::move(theory)};
  for (const std::string& name : names) {
    Expression expression{name, key_of_measure(name), {}, constants_of(scene), {}};
    expression.sites_move = std::ranges::any_of(components, &Component::position);
    try {
      expression.read(scene.settings.find(expression.key)->value, field);
    } catch (const BadInput& bad) {
      throw scene.settings.located(bad);
    }
    for (const auto& q : expression.quantities) sees_steps_ = sees_steps_ || q.measurement->sees_steps();
    all_.push_back(std::move(expression));
  }
}

Measures::~Measures() = default;

void Measures::see(const MeasuredRow& row) {
  time_ = row.time;
  for (Expression& expression : all_)
    for (auto& q : expression.quantities)
      if (!q.measurement->sees_steps()) q.measurement->see(row);
}

void Measures::see_step(const MeasuredRow& row) {
  for (Expression& expression : all_)
    for (auto& q : expression.quantities)
      if (q.measurement->sees_steps()) q.measurement->see(row);
}

void Measures::visit(SavedState& state) {
  state("time of measures", time_);
  for (Expression& expression : all_)
    for (auto& q : expression.quantities) q.measurement->visit(state);
}

std::vector<NamedNumber> Measures::results() const {
  std::vector<NamedNumber> all;
  for (const Expression& e : all_) all.push_back({e.name, e.result(time_)});
  return all;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/reproduce/discrete_equation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <sstream>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"

namespace delf {

namespace {

using Place = std::pair<int, int>;  ///< of phi(j+a,i+b)
using Numbers = std::map<std::string, double>;
using Coefficients = std::map<Place, double>;

constexpr std::string_view value_begins = "phi(";

std::string words_of(const Place& p) {
  const auto index = [](char name, int by) { return by == 0 ? std::string(1, name) : fmt::format("{}{:+}", name, by); };
  return fmt::format("phi({},{})", index('j', p.first), index('i', p.second));
}

int offset_of(std::string_view index, char name) {
  const std::string text = trimmed(index);
  const auto by = text.size() > 1 ? read_finite(text[1] == '+' ? text.substr(2) : text.substr(1)) : 0.0;
  if (text.empty() || text[0] != name || !by) throw BadInput("", fmt::format("{} is no index; write {}+1", text, name));
  return static_cast<int>(*by);
}

/// An equation as text, with a name in place of each value: f_0 and so on.
struct EquationText {
  std::string text;
  std::vector<Place> places;

  explicit EquationText(std::string_view all) {
    const std::string_view left = all.substr(0, all.rfind("= 0"));
    for (std::size_t i = 0; i < left.size();) {
      const bool begins = left.substr(i).starts_with(value_begins) && left.find(',', i) < left.find(')', i);
      if (!begins) {
        text += left[i] == '\n' ? ' ' : left[i], ++i;
        continue;
      }
      const std::size_t begin = i + value_begins.size(), comma = left.find(',', i), end = left.find(')', i);
      if (end == left.npos) throw BadInput("", "a bracket of phi( is not closed");
      const Place place{offset_of(left.substr(begin, comma - begin), 'j'),
                        offset_of(left.substr(comma + 1, end - comma - 1), 'i')};
      auto known = std::ranges::find(places, place);
      if (known == places.end()) places.push_back(place), known = places.end() - 1;
      text += fmt::format("f_{}", known - places.begin());
      i = end + 1;
    }
  }

  /// ∂/∂phi(j+a,i+b) for each value: by t, of which f = its number + t.
  Coefficients coefficients(const std::map<Place, double>& values, const Numbers& numbers) const {
    Coefficients all;
    std::vector<std::pair<std::string, double>> parameters(numbers.begin(), numbers.end());
    for (std::size_t n = 0; n < places.size(); ++n)
      parameters.emplace_back(fmt::format("v_{}", n), values.at(places[n]));
    for (std::size_t of = 0; of < places.size(); ++of) {
      std::string names;
      for (std::size_t n = 0; n < places.size(); ++n)
        names += fmt::format("let f_{} = v_{}{}; ", n, n, n == of ? " + t" : "");
      all[places[of]] = Formula(names + text, parameters, "printed").by_t(0, 0);
    }
    return all;
  }
};

/// The equation of the plan: what follows `at (j,i)`, as far as lines are indented below it.
std::string equation_in(const std::string& plan) {
  constexpr std::string_view head = "  at (j,i)   ";
  std::istringstream in(plan);
  std::string line, equation;
  bool inside = false;
  while (std::getline(in, line)) {
    if (line.starts_with(head)) inside = true, equation = line.substr(head.size());
    else if (inside && line.starts_with(std::string(head.size(), ' '))) equation += "\n" + trimmed(line);
    else inside = false;
  }
  return equation;
}

/// The table of coefficients, with the steps that its numbers hold for.
Coefficients table_in(const std::string& plan, Numbers& numbers) {
  Coefficients all;
  std::istringstream in(plan);
  std::string line;
  std::vector<int> columns;
  while (std::getline(in, line)) {
    for (const std::string name : {" k", " h"})
      if (const auto at = line.find(name + " = "); line.starts_with("lattice") && at != line.npos)
        numbers[name.substr(1)] = *read_finite(line.substr(at + 5, line.find(',', at) - at - 5));
    std::istringstream words(line);
    std::string word;
    words >> word;
    if (word == "i-1" && columns.empty()) {
      do columns.push_back(offset_of(word, 'i'));
      while (words >> word);
    } else if (!columns.empty() && word.starts_with("j") && word.size() > 1) {
      const int row = offset_of(word, 'j');
      for (std::size_t c = 0; c < columns.size() && words >> word;) {
        if (word == "n") throw BadInput("", "the plan's table leaves out a nonlinear part; take a linear theory");
        if (const auto number = read_finite(word)) all[{row, columns[c]}] = *number;
        ++c;
      }
    }
  }
  if (all.empty()) throw BadInput("", "the plan has neither an equation nor a table of coefficients");
  return all;
}

}  // namespace

EquationDifference equation_difference(const std::string& plan, const std::string& printed, double mass) {
  const EquationText paper(printed);
  std::mt19937_64 random(1);
  const auto draw = [&] { return 0.3 + static_cast<double>(random() >> 11) * 0x1p-53; };  // the same everywhere
  std::set<Place> places(paper.places.begin(), paper.places.end());
  Numbers numbers{{"h", draw()}, {"k", draw()}, {"m", mass}};
  Coefficients ours, theirs;
  std::map<Place, double> values;
  if (const std::string equation = equation_in(plan); !equation.empty()) {
    numbers["m"] = draw();
    const EquationText here(equation);
    places.insert(here.places.begin(), here.places.end());
    for (const Place& p : places) values[p] = 4 * draw();
    ours = here.coefficients(values, numbers);
  } else {
    ours = table_in(plan, numbers);
    for (const auto& [place, number] : ours) places.insert(place);
    for (const Place& p : places) values[p] = 4 * draw();
  }
  theirs = paper.coefficients(values, numbers);
  double product = 0, square = 0, size = 0;
  for (const Place& p : places) product += ours[p] * theirs[p], square += theirs[p] * theirs[p];
  for (const Place& p : places) size = std::max(size, std::abs(ours[p]));
  const double scale = product / square;
  EquationDifference difference{0, ""};
  for (const Place& p : places) {
    const double off = std::abs(ours[p] - scale * theirs[p]) / size;
    if (!(off <= difference.largest))
      difference = {off, fmt::format("{}: {:.6g} here, {:.6g} printed", words_of(p), ours[p], scale * theirs[p])};
  }
  return difference;
}

}  // namespace delf

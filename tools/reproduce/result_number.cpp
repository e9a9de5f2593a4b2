// SPDX-License-Identifier: MIT
#include "tools/reproduce/result_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>
#include <sstream>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "tools/outcome/findings_json.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

bool begins_name(char c) { return std::isalpha(static_cast<unsigned char>(c)) || c == '_'; }
bool in_name(char c) { return begins_name(c) || std::isdigit(static_cast<unsigned char>(c)); }

/// A step of a path: a key of an object, or an element of a list.
struct PathStep {
  std::string name;
  bool of_list;
};

std::vector<PathStep> steps_of(std::string_view path) {
  std::vector<PathStep> steps;
  for (std::size_t i = 0; i < path.size();) {
    if (path[i] == '.') ++i;
    const bool of_list = path[i] == '[';
    const std::size_t begin = i + (of_list ? 1 : 0),
                      end = std::min(path.find_first_of(of_list ? "]" : ".[", begin), path.size());
    steps.push_back({trimmed(path.substr(begin, end - begin)), of_list});
    i = end + (of_list ? 1 : 0);
  }
  return steps;
}

std::optional<std::size_t> index_of(const Json& list, const std::string& name) {
  const auto size = static_cast<std::ptrdiff_t>(list.size());
  if (const auto number = read_finite(name); number && *number == std::round(*number)) {
    const auto index = static_cast<std::ptrdiff_t>(*number);
    const std::ptrdiff_t at = index < 0 ? size + index : index;
    return at >= 0 && at < size ? std::optional(static_cast<std::size_t>(at)) : std::nullopt;
  }
  for (std::size_t i = 0; i < list.size(); ++i)
    for (const char* key : {"name", "scheme"})
      if (list[i].is_object() && list[i].value(key, Json()) == name) return i;
  return std::nullopt;
}

/// Every number that the path leads to from here.
void follow(const Json& from, const std::vector<PathStep>& steps, std::size_t at, std::vector<double>& found) {
  if (at == steps.size()) {
    if (from.is_number()) found.push_back(from.get<double>());
    else if (from.is_boolean()) found.push_back(from.get<bool>() ? 1 : 0);
    return;
  }
  const auto& [name, of_list] = steps[at];
  if (of_list && from.is_array()) {
    for (std::size_t i = 0; name == "*" && i < from.size(); ++i) follow(from[i], steps, at + 1, found);
    if (const auto index = name == "*" ? std::nullopt : index_of(from, name))
      follow(from[*index], steps, at + 1, found);
  } else if (!of_list && from.is_object() && from.contains(name)) {
    follow(from[name], steps, at + 1, found);
  }
}

/// A table of text as a list of objects, each with the numbers of a line by the names of their columns.
Json table_as_list(const fs::path& file) {
  Json list = Json::array();
  std::ifstream in(file);
  std::string line;
  if (!std::getline(in, line)) return list;
  const std::vector<std::string> names = parts_of(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> cells = parts_of(line);
    Json row = Json::object();
    for (std::size_t c = 0; c < std::min(names.size(), cells.size()); ++c)
      if (const auto number = read_finite(cells[c])) row[names[c]] = *number;
    list.push_back(row);
  }
  return list;
}

/// All results of a folder in one object; its tables are lists by their names without ending, such as `section`.
Json results_in(const fs::path& folder) {
  Json all = Json::object();
  std::error_code none;
  for (const auto& entry : fs::directory_iterator(folder, none)) {
    if (entry.path().extension() == ".csv") all[entry.path().stem().string()] = table_as_list(entry.path());
    if (entry.path().extension() != ".json") continue;
    std::ifstream in(entry.path());
    const Json one = Json::parse(in, nullptr, false);
    if (one.is_object()) all.update(one);
  }
  const Json measures = all.value("measures", Json::object());
  for (const auto& [name, value] : measures.items()) all[name] = value;
  return all;
}

}  // namespace

double result_number(const std::string& formula, const fs::path& folder) {
  const Json all = results_in(folder);
  std::string numbers;
  for (std::size_t i = 0; i < formula.size();) {
    std::size_t end = i + 1;
    if (begins_name(formula[i])) {
      int depth = 0;
      while (end < formula.size() && (depth > 0 || in_name(formula[end]) || formula[end] == '.' || formula[end] == '['))
        depth += (formula[end] == '[') - (formula[end] == ']'), ++end;
      const std::string path = formula.substr(i, end - i);
      const std::vector<PathStep> steps = steps_of(path);
      if (all.contains(steps[0].name)) {
        std::vector<double> found;
        follow(all, steps, 0, found);
        if (found.empty()) throw BadInput("", fmt::format("{} has no value in the results", path));
        numbers += fmt::format("({:.17g})", *std::ranges::max_element(found));
      } else {
        numbers += path;
      }
    } else {
      while (end < formula.size() && !begins_name(formula[end]) && (in_name(formula[i]) || formula[i] == '.') &&
             (in_name(formula[end]) || formula[end] == '.'))
        ++end;
      numbers += formula.substr(i, end - i);
    }
    i = end;
  }
  return number_of(numbers, "number");
}

}  // namespace delf

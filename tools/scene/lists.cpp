// SPDX-License-Identifier: MIT
#include "tools/scene/lists.hpp"

#include <fmt/format.h>

#include "lattice/read_number.hpp"
#include "lattice/text_parts.hpp"
#include "tools/scene/values.hpp"

namespace delf {

std::vector<std::string> names_in(std::string_view text) {
  std::vector<std::string> names(1);
  int depth = 0;
  for (const char c : text) {
    depth += (c == '(') - (c == ')');
    if (c == ',' && depth <= 0) names.emplace_back();
    else names.back() += c;
  }
  for (std::string& name : names) name = trimmed(name);
  std::erase(names, "");
  return names;
}

std::vector<std::string> words_in(std::string_view text) {
  std::vector<std::string> words(1);
  for (const char c : text)
    if (c == ',' || c == ' ' || c == '\t') words.emplace_back();
    else words.back() += c;
  std::erase(words, "");
  return words;
}

std::vector<double> positive_numbers(const Settings& settings, std::string_view key) {
  const auto text = Values(settings).text(key);
  std::vector<double> numbers;
  for (const std::string& word : words_in(text.value_or(""))) {
    const auto number = read_finite(word);
    if (!number || !(*number > 0))
      throw settings.error(
          key, fmt::format("\"{}\" is no positive number; write numbers separated by commas: 0.1, 1, 2.3", word));
    numbers.push_back(*number);
  }
  if (text && numbers.empty()) throw settings.error(key, "names no number; write numbers separated by commas");
  return numbers;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theory_numbers.hpp"

#include <string_view>
#include <variant>

namespace delf {

std::vector<std::pair<std::string, double>> theory_numbers(const ParameterValues& values) {
  constexpr std::string_view of_theory = "theory.";
  std::vector<std::pair<std::string, double>> numbers;
  for (const auto& [key, value] : values)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with(of_theory))
      numbers.emplace_back(key.substr(of_theory.size()), *number);
  return numbers;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/report/field_symbol.hpp"

#include <array>

#include "lattice/index.hpp"

namespace delf {

std::string field_symbol(const std::string& name) {
  constexpr std::array digits{"₀", "₁", "₂", "₃", "₄", "₅", "₆", "₇", "₈", "₉"};
  if (!name.starts_with("phi")) return name;
  std::string symbol = "φ";
  for (const char digit : name.substr(3)) {
    if (digit < '0' || digit > '9') return name;  // a name of its own, such as phi_left
    symbol += digits[at(digit - '0')];
  }
  return symbol;
}

}  // namespace delf

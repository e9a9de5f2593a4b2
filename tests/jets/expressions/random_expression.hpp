// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tests/jets/random.hpp"

namespace delf::testing {

/// A text of the grammar of densities, made of smooth operations that have values near 0, `depth` operations deep.
inline std::string random_expression(Random& random, int depth,
                                     const std::vector<std::string>& leaves = {"phi", "phi_t", "phi_x", "x", "t", "2",
                                                                               "0.5", "c", "phi", "phi_t", "0", "1"}) {
  static const std::vector<std::string> functions{"sin", "cos", "cosm1", "tanh", "atan", "exp", "sinh", "cosh", "tan"};
  const auto sub = [&] { return random_expression(random, depth - 1, leaves); };
  const auto pick = [&](const auto& list) { return list[random.pick(0, static_cast<int>(list.size()) - 1)]; };
  if (depth == 0) return pick(leaves);
  switch (random.pick(0, 11)) {
    case 0:
      return "(" + sub() + " + " + sub() + ")";
    case 1:
      return "(" + sub() + " - " + sub() + ")";
    case 2:
    case 3:
      return "(" + sub() + "*" + sub() + ")";
    case 4:
      return "(" + sub() + "/(2 + sin(" + sub() + ")))";
    case 5:
      return "(-" + sub() + ")";
    case 6:
      return "sin(" + sub() + ")^3";
    case 7:
      return "sqrt(2 + cos(" + sub() + "))";
    case 8:
      return "log(3 + sin(" + sub() + "))";
    case 9:
      return "(2 + sin(" + sub() + "))^(-1.5)";
    default:
      return pick(functions) + "(0.3*" + sub() + ")";
  }
}

/// Sanitizers are ten times slower: fewer samples then.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_UNDEFINED__)
inline constexpr int many = 500;
#else
inline constexpr int many = 10'000;
#endif

}  // namespace delf::testing

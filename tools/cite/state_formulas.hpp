// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// Words in which formulas are written with the characters of a keyboard, with the formulas in LaTeX between dollars:
/// "a kink 4 atan exp(m s), m = 1" as "a kink $4 \arctan \exp(m s)$, $m = 1$". Letters of one character, Greek names and
/// functions belong to formulas, other words do not.
std::string with_formulas(const std::string& words);

}  // namespace delf

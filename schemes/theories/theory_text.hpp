// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "schemes/parameter.hpp"

namespace delf {

/// A built-in theory as a scene would write it: its formulas are printed from this text. Tests hold it equal to the compiled
/// density.
struct TheoryText {
  std::string theory, density;
  std::string fields = "phi";
  std::vector<std::pair<std::string, std::string>> parameters = {};  ///< a name in the density, and the key of its number
  std::string constraint = {}, symmetry = {};
  std::pair<std::string, std::string> choice = {};  ///< the key and value for which the density is this one; none: always
};

/// The texts of all built-in theories but the solar system, whose formulas fill pages.
const std::vector<TheoryText>& theory_texts();

/// The text of a theory with these values of its parameters, the others at their fallbacks. Null if it has none, or other
/// units (theory.speed, theory.scale).
std::shared_ptr<const SymbolicDensity> text_of(const std::string& theory, ParameterValues given);

}  // namespace delf

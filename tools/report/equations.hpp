// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"

namespace delf {

/// The equations of a problem for `delf plan`: of a theory that is given as text its density, its field equations, and the
/// discrete ones of the stencil, as formulas; of others the line of their entry.
std::string equations_in_words(const Problem&, const Simulation&);
/// The equations as LaTeX, a displayed formula each. Throws BadInput for a theory that has no text.
std::string equations_in_latex(const Problem&, const Simulation&);

/// The equations for a page: each a displayed formula in MathML.
struct DisplayedEquations {
  std::string density;
  std::vector<std::string> of_fields, discrete;  ///< none of a method without a stencil
};
/// Nothing for a theory that has no text.
std::optional<DisplayedEquations> equations_in_mathml(const Problem&, const Simulation&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "jets/expressions/print.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// The equations of a problem for `delf plan`: of a theory that is given as text its density, its field equations, and the
/// discrete ones of the stencil, as formulas; of others the line of their entry.
std::string equations_in_words(const Problem&, const Simulation&);
/// The equations as LaTeX, a displayed formula each. Throws BadInput for a theory that has no text.
std::string equations_in_latex(const Problem&, const Simulation&);

/// The equations, each a displayed formula: in LaTeX between \[ and \], in MathML an element, in plain notation as text.
struct DisplayedEquations {
  std::string density;
  std::vector<std::string> of_fields, discrete;  ///< none of a method without a stencil
};
/// Nothing for a theory that has no text.
std::optional<DisplayedEquations> equations_in(expressions::Notation, const Problem&, const Simulation&);
/// Those of the theory alone.
std::optional<DisplayedEquations> equations_in(expressions::Notation, const Problem&, const FieldTheory&);

}  // namespace delf

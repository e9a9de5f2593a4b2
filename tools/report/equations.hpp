// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/print.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// The equations of a problem for `delf plan`: of a theory that is given as text its density, its field equations, and the
/// discrete ones of the stencil, as formulas; of others the line of their entry.
std::string equations_in_words(const Problem&, const Simulation&);
/// The equations as LaTeX, a displayed formula each. Throws BadInput for a theory that has no text.
std::string equations_in_latex(const Problem&, const Simulation&);

/// The density as text: that of the scene, or the text of a built-in theory; null if there is none.
std::shared_ptr<const SymbolicDensity> text_of(const Problem&, const FieldTheory&);
/// A sum broken between its terms into lines of at most `width` letters, where terms are that short.
std::vector<std::string> lines_of_terms(const std::string& sum, std::size_t width);
/// A sum of terms as text for a terminal, in lines of its width.
std::string broken(const std::string& sum, std::size_t indent);
/// An equation of its own in LaTeX, in lines that fit on a page.
std::string displayed(const std::string& formula);

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

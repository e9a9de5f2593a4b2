// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "schemes/problem.hpp"
#include "tools/cite/paper_text.hpp"
#include "tools/report/equations.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The equations in the two notations of a paper.
struct EquationsForPaper {
  DisplayedEquations latex, plain;
};

/// The theory, its field equations and its density; `where` says on what: "on a circle of length $40$ for …". Without
/// equations the formula of its entry stands for them.
void say_theory(PaperText&, const Scene&, const std::optional<EquationsForPaper>&, const std::string& where);
/// ", where $w = 0.5$": the parameters that the formulas of the start and of the ends have, and the density has not.
std::string parameters_of_start(const Scene&);
/// Words of a state with the names that the equations have for these fields: phi1 as u.
std::string with_names_of_equations(std::string words, const Scene&, const std::vector<std::string>& fields);
/// φ_x as ∇φ and φ_xx as Δφ, in more than one dimension of space.
void write_for_more_dimensions(EquationsForPaper&);

}  // namespace delf

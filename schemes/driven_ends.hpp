// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/methods/method_registry.hpp"
#include "schemes/problem.hpp"
#include "schemes/system/end_work.hpp"

namespace delf {

/// Keys of a problem's parameters: formulas of t for the ends of an interval, one for each field, separated by semicolons.
inline constexpr auto left_end = "boundary.left", right_end = "boundary.right", left_flux = "boundary.left.flux",
                      right_flux = "boundary.right.flux";
/// The key of an end that moves, or lets something flow in; empty: all rest.
std::string key_of_driven_end(const Problem&);
/// An end of an interval, or the boundary of a mesh, moves or lets something flow in.
bool has_driven_boundary(const Problem&);

/// The families of these ends. Throws BadInput for those that the scheme cannot have: rows of a kernel are not the field,
/// coefficients of a basis are not its values, and wide stencils go on by mirror images.
void add_driven_ends(SchemeParts&, const FieldTheory&, const Problem&);
/// The motion of an end, by left_end or right_end; empty: it is not driven.
FormulasOfTime motion_of_end(const FieldTheory&, const Problem&, const char* key);
/// What flows in.
std::vector<EndFlux> end_fluxes(const FieldTheory&, const Problem&);

}  // namespace delf

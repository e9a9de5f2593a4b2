// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "schemes/parameter.hpp"

namespace delf {

struct Problem;

/// The keys of a method of elements in time, and those of what it has in space: scheme.space and what belongs to it.
std::vector<Parameter> with_space_keys(std::vector<Parameter>);
/// The table of space that they ask for; of one point on lattice.space = point. Throws BadInput: a key that the space
/// does not have, a stencil that the lattice is too small or not closed for.
StencilTable space_table(const Problem&);
/// "lumped", "linear", "pairs of order 4", "spectral of degree 2"
std::string space_label(const Problem&);

}  // namespace delf

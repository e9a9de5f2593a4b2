// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "jets/tables/stencil_table.hpp"
#include "schemes/parameter.hpp"

namespace delf {

struct Problem;

// The keys of space that methods of elements in time share.

/// scheme.space, lattice.space_order and scheme.degree_space
Parameter space_key(), space_order_key(), degree_space_key();
/// The table of space that they ask for; of one point on lattice.space = point. Throws BadInput: a key that the space
/// does not have, a stencil that the lattice is too small or not closed for.
StencilTable space_table(const Problem&);
/// The space in labels: ", lumped", ", linear", ", pairs of order 4", ", spectral of degree 2"; nothing on a point.
std::string space_label(const Problem&);
/// The space as a clause of a paper: " with linear finite elements in space"; nothing on a point.
std::string space_in_words(const Problem&);
/// The order of a method that has this one in time, in that space; nothing where it is not known (spectral elements).
std::optional<int> order_in_space(const Problem&, int in_time);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/tables/splitting.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {

/// lattice.space_order, 2, 4, …, 2 · widest_pair.
Parameter space_order_parameter();
/// The order in space of a problem, 4 if it is not given.
int space_order_of(const Problem&);
/// Checks lattice.space_order, an even number, and gives the number of pairs p.
int pairs_of_order(const Problem&, const char* key, int order);

/// The sub-steps of a splitting over pairs of these weights, for densities that are nonlinear in φ alone. The row
/// after s sub-steps carries the d fields: component = s · d + a. The first family is that of whole stencils; those of the walls
/// of an interval follow. Throws BadInput for what there is no scheme for.
SchemeParts pair_parts(const FieldTheory&, const Problem&, const Splitting&, const std::vector<double>& pairs);

/// The tables of one row at both walls of an interval (mirror_table); none on a circle.
std::vector<StencilTable> at_both_walls(const StencilTable&, const Lattice&);

}  // namespace delf

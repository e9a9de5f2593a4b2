// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <span>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/energy.hpp"

namespace delf {

/// A time element that is broken: φ_j(0) and φ_j(1), by which the multipliers tie it to the traces q_n and q_{n+1}, and
/// the space whose nodes have them.
struct Traces {
  std::vector<double> lower, upper;
  StencilTable space;
};

/// A theory on an element (jets/tables/table_product.hpp). Every node of the unit cell carries the d fields, component =
/// node · d + a. With traces, λ_n and μ_{n+1} of every node in space follow.
SchemeParts element_parts(const FieldTheory&, const StencilTable& element, const std::optional<Traces>& traces = {});

/// Takes elements to a mesh, where the space is one: the action of a time table on its sites and cells replaces the
/// parts' first family, which is of this table on a point.
void take_to_mesh(SchemeParts&, const FieldTheory&, const Problem&, const StencilTable& time,
                  bool values_are_sources = false);

/// The rates that have these momenta at the newest row, [i·C + c]; not numbers where there are none.
std::vector<double> row_rates(const RowsInTime&, std::span<const double> momenta);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "schemes/families/equidistribution.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/state.hpp"

namespace delf {

/// A scheme on sites that move: an element of time, what the sites follow, and how.
struct MovingScheme {
  StencilTable time;
  MeshMonitor monitor;
  /// X is varied, and multipliers keep the constraint; or else it is slaved to the constraint, and not varied.
  bool varied = true;
  /// Slaved: X is that of the rows, between them as the element has it; or else it is solved for at each point of time,
  /// with its rate, as if it were a function X(y): Tyranowski–Desbrun (36).
  bool rows_alone = false;
  double delay = 0;       ///< slaved, X of the rows: τ in τ X_t = G; 0: G = 0
  double most_phase = 0;  ///< ωh up to which the element of time is stable; 0: always
  int points = 10;        ///< of Gauss's rule in a cell
  /// The whole action of this element in closed form, without points; null: none.
  std::shared_ptr<const StencilFamily> action = {};
  /// That of one of its points, where there is no such action of the whole.
  std::function<std::shared_ptr<const StencilFamily>(double weight)> stage = {};
};

/// Families and components: φ, X, the nodes inside a step; then multipliers, or the slaved positions and rates at the
/// points of time.
SchemeParts moving_parts(const FieldTheory&, const MovingScheme&);

/// The field at a point x of row 0.
using Profile = std::function<void(double x, std::span<FieldPoint>)>;

/// Sites that start where the monitor wants them, Tyranowski–Desbrun (166), (167): G(a(X), X) = 0, followed from the
/// uniform mesh as the monitor grows to its strength; and their rates. Throws NoConvergence where it cannot be followed.
MovingSites place_moving_sites(const MeshMonitor&, const Lattice&, int d, const Profile&);

}  // namespace delf

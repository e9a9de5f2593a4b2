// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/site.hpp"
#include "lattice/stencil_shape.hpp"

namespace delf {

/// The way an unknown enters an equation: with a constant coefficient or not.
enum class Dependence { linear, nonlinear };

/// An unknown that an equation contains: `offset` is from the equation's own site, and is never wrapped.
struct Coupling {
  Site offset;
  int component = 0;
  Dependence dependence = Dependence::linear;

  friend bool operator==(const Coupling&, const Coupling&) = default;
};

/// All couplings of the equation of `component` at `site`. Empty: there is no equation, and the value there is data
/// (a fixed wall, a multiplier of a cell that the interval does not have). The lattice passed may be shorter than the
/// real one: the result may depend on its walls and the distance to them only, and on the parity of site.time for
/// brick walls only.
using Equations = std::function<std::vector<Coupling>(const Lattice&, Site site, int component)>;

/// A system of equations, one for each unknown, that repeats along a lattice and in time.
struct SystemPattern {
  int components = 1;
  int width = 1;                                ///< the largest |space offset| in any equation
  Placement placement = Placement::every_site;  ///< brick_wall if any family is: period 2 along time and space
  Equations equations;
  std::vector<std::string> names = {};  ///< of the components, for reports

  /// "lambda", or "component 2" if there are no names.
  std::string name(int component) const {
    return names.empty() ? "component " + std::to_string(component) : names[component];
  }
};

/// On every stencil of a family, the equation of (row vertex, row component) contains (column vertex, column
/// component): an entry of the Hessian ∂²L/∂yˡ∂yᵐ that is not zero.
struct VertexCoupling {
  int row_vertex = 0, column_vertex = 0;
  int row_component = 0, column_component = 0;
  Dependence dependence = Dependence::linear;
};

/// A stencil family and the entries of its Hessian.
struct StencilIncidence {
  StencilPattern pattern;
  std::vector<VertexCoupling> couplings;

  /// Every vertex coupled to every vertex.
  static StencilIncidence dense(const StencilPattern&, Dependence = Dependence::linear);
};

/// The equations Σ_{l: Δˡ = site} ∂L/∂yˡ = 0 (5.2), summed over the stencils of all families that lie in the lattice;
/// none at a fixed wall. Coefficients that cancel in the sum are not detected here: leave them out of the lists.
SystemPattern system_of(int components, std::vector<StencilIncidence> families);

}  // namespace delf

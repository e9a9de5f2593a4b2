// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <utility>

#include "schemes/stepping/evolution.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/variational_family.hpp"
#include "schemes/families/vertex_constraint.hpp"

namespace delf {

/// A scheme is a stencil with its jet map, and a density; the equations, their Jacobian, the forms and the plan are
/// generated:
///
///     auto scheme = delf::Scheme{delf::hexagon, PhiFour{}};
///     auto evolution = scheme.on(delf::Lattice::circle(254, 40.0), 0.05);
///     evolution.stepper().start({row0, row1});
///     evolution.stepper().step();
///
/// A constraint that the density declares is kept by a multiplier, which is one more component.
template <JetMap Map, Density D>
class Scheme {
 public:
  Scheme(Map, D density) : density_(std::move(density)) {}

  const D& density() const { return density_; }
  DiscreteLagrangian<Map, D> lagrangian() const { return {density_}; }

  std::shared_ptr<const VariationalFamily<Map, D>> family(double time_step, double space_step) const {
    return std::make_shared<VariationalFamily<Map, D>>(density_, time_step, space_step);
  }
  Evolution on(const Lattice& lattice, double time_step, const StepOptions& options = {}) const {
    if constexpr (Constrained<D>) {
      std::vector<Component> components = fields(components_of<D>());
      components.push_back({"lambda", Role::multiplier, {}});
      return {lattice,
              {family(time_step, lattice.space_step()),
               std::make_shared<LagrangianFamily<VertexConstraint<D>>>(VertexConstraint<D>{density_})},
              time_step, options, std::move(components)};
    } else {
      return {lattice, {family(time_step, lattice.space_step())}, time_step, options};
    }
  }

 private:
  D density_;
};

}  // namespace delf

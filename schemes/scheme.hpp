// SPDX-License-Identifier: MIT
#pragma once
#include <concepts>
#include <memory>
#include <utility>

#include "jets/batch_of.hpp"
#include "lattice/error.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/vertex_constraint.hpp"
#include "schemes/families/wall_families.hpp"
#include "schemes/stepping/evolution.hpp"

namespace delf {

template <class D>
concept InBatches = std::convertible_to<D, std::shared_ptr<const BatchDensity>>;

/// Told in one line where it is not so.
template <class D>
consteval bool is_functor_or_in_batches() {
  if constexpr (InBatches<D>) return true;
  else return is_density<D>();
}

/// A scheme is a stencil with its jet map, and a density; the equations, their Jacobian, the forms and the plan are
/// generated:
///
///     auto scheme = delf::Scheme{delf::hexagon, PhiFour{}};
///     auto evolution = scheme.on(delf::Lattice::circle(254, 40.0), 0.05);
///     evolution.stepper().start({row0, row1});
///     evolution.stepper().step();
///
/// A constraint that the density declares is kept by a multiplier, which is one more component. A density in batches will do
/// as well, such as delf::expression("0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*(phi^2 - 1)^2").
template <class D>
class Scheme {
  static_assert(is_functor_or_in_batches<D>());

 public:
  template <JetMap Map>
  Scheme(Map, D density) : Scheme(stencil_table(Map::table), std::move(density)) {}
  /// A scheme with a table made at run time. Throws BadInput if its weights are not consistent.
  Scheme(StencilTable table, D density) : table_(std::move(table)), density_(std::move(density)) {
    if (!is_consistent(table_))
      throw BadInput("lattice.stencil",
                     "the weights of a table must sum to 1 and be exact on affine fields; correct the table");
    if constexpr (Density<D>) batches_ = std::make_shared<BatchOf<D>>(density_);
    else if constexpr (InBatches<D>) batches_ = density_;
  }

  const D& density() const { return density_; }
  const StencilTable& table() const { return table_; }

  std::shared_ptr<const JetFamily> family() const { return std::make_shared<JetFamily>(table_, batches_); }
  Evolution on(const Lattice& lattice, double time_step, const StepOptions& options = {}) const {
    std::vector<std::shared_ptr<const StencilFamily>> families{family()};
    for (auto& term : wall_families(table_, batches_, lattice)) families.push_back(std::move(term));
    std::vector<Component> components = fields(batches_->components());
    if constexpr (Constrained<D>) {
      families.push_back(std::make_shared<LagrangianFamily<VertexConstraint<D>>>(VertexConstraint<D>{density_}));
      components.push_back({"lambda", Role::multiplier, {}});
    }
    return {lattice, std::move(families), time_step, options, std::move(components)};
  }

 private:
  StencilTable table_;
  D density_;
  std::shared_ptr<const BatchDensity> batches_;
};
template <JetMap Map, class D>
Scheme(Map, D) -> Scheme<D>;

}  // namespace delf

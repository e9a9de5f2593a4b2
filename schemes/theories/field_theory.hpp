// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "jets/batch_of.hpp"
#include "jets/tables/stencil_table.hpp"
#include "lattice/lattice.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/families/residual_family.hpp"
#include "schemes/families/vertex_constraint.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// A theory as a registry hands it out: its density in batches, and the constraint that it declares.
class FieldTheory {
 public:
  FieldTheory(std::shared_ptr<const BatchDensity> density, std::shared_ptr<const StencilFamily> constraint = nullptr,
              std::vector<Component> fields = {})
      : density_(std::move(density)),
        constraint_(std::move(constraint)),
        fields_(fields.empty() ? delf::fields(density_->components()) : std::move(fields)) {}

  const BatchDensity& density() const { return *density_; }
  const std::shared_ptr<const BatchDensity>& shared_density() const { return density_; }
  int components() const { return density_->components(); }
  /// The components of the field, by name.
  const std::vector<Component>& fields() const { return fields_; }
  bool is_placed() const { return density_->is_placed(); }
  /// The symmetries, which leave the density as it is, as the theory declares them.
  const std::vector<LinearSymmetry>& symmetries() const { return density_->symmetries(); }

  /// The action on a stencil of named_tables(); null if there is none of that name.
  std::shared_ptr<const StencilFamily> variational(const std::string& stencil) const;
  /// The terms that it needs at the natural walls of a lattice.
  std::vector<std::shared_ptr<const StencilFamily>> at_walls(const std::string& stencil, const Lattice&) const;
  /// The action on any table: an element, the sub-steps of a composition.
  std::shared_ptr<const StencilFamily> on_table(StencilTable, bool values_are_sources = false) const;
  /// The constraint that the theory declares, with its multiplier; null if it declares none.
  std::shared_ptr<const StencilFamily> constraint() const { return constraint_; }
  /// A comparator; null if the density declares no difference quotient.
  std::shared_ptr<const StencilFamily> comparator(DirectResidual) const;

 private:
  std::shared_ptr<const BatchDensity> density_;
  std::shared_ptr<const StencilFamily> constraint_;
  std::vector<Component> fields_;
};

template <Density D>
std::shared_ptr<const StencilFamily> constraint_of([[maybe_unused]] const D& density) {
  if constexpr (Constrained<D>)
    return std::make_shared<LagrangianFamily<VertexConstraint<D>>>(VertexConstraint<D>{density});
  else return nullptr;
}

/// A functor as a theory.
template <class D>
class TheoryOf final : public FieldTheory {
  static_assert(is_density<D>());

 public:
  explicit TheoryOf(const D& density) : FieldTheory(std::make_shared<BatchOf<D>>(density), constraint_of(density)) {}
};

}  // namespace delf

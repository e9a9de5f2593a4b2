// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <span>
#include <vector>

#include "lattice/complex/complex.hpp"
#include "schemes/complex/placed_family.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// How a ComplexSystem reads stencils.
struct StencilReading {
  /// Not empty: y holds some nodes alone, and here each value of each stencil.
  std::span<const std::int32_t> places = {};
  bool unscaled = false;  ///< as if the measures and time steps of all parts were 1
};

/// The field equations of a complex of stencils,
///
///     E(site) = Σ_{l: Δˡ = site} rˡ(y_Δ),    y[site·d + a],                     Marsden–Patrick–Shkoller (5.2)
///
/// with their Jacobian, and the action. Stencils are evaluated in batches of a family.
class ComplexSystem {
 public:
  explicit ComplexSystem(int components) : components_(components) {}

  /// So many are to be added: see Complex.
  void reserve(std::size_t sites, std::size_t stencils, std::size_t vertices) {
    complex_.reserve(sites, stencils, vertices);
    tables_.reserve(stencils), part_of_.reserve(stencils), measures_.reserve(stencils), time_steps_.reserve(stencils);
  }
  int add_site(const Complex::Position& position, SiteRole role = SiteRole::free) {
    return complex_.add_site(position, role);
  }
  void set_role(int site, SiteRole role) { complex_.set_role(site, role); }
  void set_time(int site, double t) { complex_.set_time(site, t); }
  int add_family(PlacedFamily);
  int add_table(int family, std::span<const TablePoint> points) {
    return families_[static_cast<std::size_t>(family)].add_table(points);
  }
  /// A part is a set of stencils whose measures and time steps change together: those of a stencil are its own times those
  /// of its part. Part 0 keeps both at 1. Of the other parts either all weights of a family are of φ_t, or none.
  int add_part();
  void set_part(int part, double measure, double time_step) {
    parts_[static_cast<std::size_t>(part)] = {measure, time_step};
  }
  int add_stencil(int family, std::span<const int> sites, int table, double measure, double time_step = 1,
                  int part = 0);

  const Complex& complex() const { return complex_; }
  int components() const { return components_; }
  std::size_t nodes() const {
    return static_cast<std::size_t>(complex_.sites()) * static_cast<std::size_t>(components_);
  }
  const PlacedFamily& family(int number) const { return families_[static_cast<std::size_t>(number)]; }
  int families() const { return static_cast<int>(families_.size()); }
  const PlacedFamily& family_of(int stencil) const { return family(complex_.shape_number(stencil)); }
  int parts() const { return static_cast<int>(parts_.size()); }
  int part_of(int stencil) const { return part_of_[static_cast<std::size_t>(stencil)]; }
  /// What multiplies ∂L/∂y of a part's stencils: |Δ|/hᵖ, and ∂²L/∂y∂y if p is twice as much.
  double factor(int part, int power) const;
  std::size_t bytes() const;

  /// All stencils, or those of a list, in batches of one family and one part: visit(stencils of the batch, its
  /// numbers[i·most + s]).
  using Stencils = std::span<const std::int32_t>;
  using Visit = std::function<void(Stencils, const double*)>;
  void each_lagrangian(Stencils, std::span<const double> y, const Visit&) const;
  void each_energy(Stencils, std::span<const double> y, const Visit&) const;
  void each_residual(Stencils, std::span<const double> y, const Visit&, const StencilReading& = {}) const;
  void each_jacobian(Stencils, std::span<const double> y, const Visit&, const StencilReading& = {}) const;
  std::vector<std::int32_t> all_stencils() const;

  /// The node that value i of a stencil is.
  std::size_t node(int stencil, int i) const {
    return static_cast<std::size_t>(complex_.vertices(stencil)[static_cast<std::size_t>(i / components_)]) *
               static_cast<std::size_t>(components_) +
           static_cast<std::size_t>(i % components_);
  }
  /// E at every node, whether or not it holds there.
  std::vector<Balance> residual(std::span<const double> y) const;
  /// Σ |∂E/∂y y| at every node: what the terms of E have cancelled within stencils too.
  std::vector<double> sizes(std::span<const double> y) const;

 private:
  template <class Evaluate>
  void each(Stencils, std::span<const double> y, int power, const Evaluate&, const Visit&, const StencilReading&) const;

  struct Part {
    double measure = 1, time_step = 1;
  };
  int components_;
  Complex complex_;
  std::vector<PlacedFamily> families_;  ///< its number is the number of its shape
  std::vector<Part> parts_ = std::vector<Part>(1);
  std::vector<std::int32_t> tables_, part_of_;  ///< of each stencil
  std::vector<double> measures_, time_steps_;
};

/// What |E| is relative to: the largest sum of absolute terms where an equation holds, since a vacuum has no scale of its own.
/// Where all terms are rounding, as the differences of a constant field, the largest Σ |∂E/∂y y|.
double scale_of_equations(const ComplexSystem&, std::span<const Balance> E, std::span<const double> y);
/// The largest |E| where an equation holds, relative to this scale.
double largest_residual(const ComplexSystem&, std::span<const double> y);

}  // namespace delf

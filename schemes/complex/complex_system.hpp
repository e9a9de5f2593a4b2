// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lattice/complex/complex.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// How a ComplexSystem reads stencils.
struct StencilReading {
  /// Not empty: y holds some nodes alone, and here each value of each stencil.
  std::span<const std::int32_t> places = {};
  std::optional<double> time = {};  ///< of all of them, in place of that of their sites
};

/// The field equations of a complex of stencils,
///
///     E(site) = Σ_{l: Δˡ = site} rˡ(y_Δ),    y[site·d + a],                     Marsden–Patrick–Shkoller (5.2)
///
/// with their Jacobian, and the action. Stencils are evaluated in batches of a family.
class ComplexSystem {
 public:
  static constexpr int most = 64;  ///< stencils at once

  /// Stencils that lie anywhere: a family whose tables differ from stencil to stencil in their numbers, and not in their form.
  /// L has the measure |Δ| of the stencil as a factor; weights of φ_t are per its time step, and those of φ_x of the coordinates
  /// themselves.
  class Family {
   public:
    /// A density on tables: value l·d + a is component a at vertex l. A density that reads t and x does so, at each point, where
    /// the point has φ: at the mean of the vertices with the weights of φ; and where the point has derivatives alone, at the mean
    /// of the vertices that it reads. A pair of sites in time thus has its middle, a site its own place, and a cell its centroid,
    /// or a Gauss point of it: the action is of second order.
    Family(std::shared_ptr<const BatchDensity>, int vertices, const std::vector<TablePoint>& form);
    /// A family of a lattice: L of its stencils as it is, with their numbers in the place of tables, and t that of the first site.
    explicit Family(std::shared_ptr<const StencilFamily>);

    /// The number of a table. Throws BadInput where its slots have not the vertices of the form.
    int add_table(std::span<const TablePoint>);

    int vertices() const { return vertices_; }
    int size() const { return family_->size(); }
    /// Which values feel each other, where a site of the complex holds so many of them.
    ComplexShape shape(int values_of_site) const;
    /// ∂r/∂y is proved to be the same at all y: the equations of these stencils are linear.
    bool is_linear() const { return linear_; }
    /// The equations of the stencils depend on t.
    bool reads_time() const { return reads_time_; }
    /// ∂r/∂y of value m in the equation of value i is not proved to be the same at all y.
    bool is_varying(int i, int m) const { return varying_[i * size() + m] != 0; }

   private:
    friend class ComplexSystem;
    bool is_placed() const { return density_ && density_->is_placed(); }
    /// Numbers of a stencil, those of a table and the places of its points.
    int add_numbers(int table, std::span<const Complex::Position> vertices);

    std::shared_ptr<const BatchDensity> density_;  ///< null: no tables
    int vertices_;
    std::shared_ptr<JetFamily> jets_;  ///< null: no tables
    std::shared_ptr<const StencilFamily> family_;
    std::vector<std::vector<TablePoint::Entry>> places_;  ///< of the points: weights of the vertices
    std::vector<TablePoint> form_;
    std::vector<std::vector<double>>
        tables_;  ///< of a density that is placed: numbers that stencils have besides their places
    std::vector<char> coupled_, varying_;  ///< [i·size + m]
    bool linear_ = true, reads_time_ = false;
  };

  explicit ComplexSystem(int components) : components_(components) {}

  /// So many are to be added: see Complex.
  void reserve(std::size_t sites, std::size_t stencils, std::size_t vertices) {
    complex_.reserve(sites, stencils, vertices);
    numbers_.reserve(stencils), measures_.reserve(stencils), time_steps_.reserve(stencils);
  }
  int add_site(const Complex::Position& position, SiteRole role = SiteRole::free) {
    return complex_.add_site(position, role);
  }
  void set_role(int site, SiteRole role) { complex_.set_role(site, role); }
  int add_family(Family);
  int add_table(int family, std::span<const TablePoint> points) { return families_[family].add_table(points); }
  /// `table` is not read of a family without tables.
  int add_stencil(int family, std::span<const int> sites, int table, double measure, double time_step = 1);

  const Complex& complex() const { return complex_; }
  int components() const { return components_; }
  std::size_t nodes() const { return at(complex_.sites()) * at(components_); }
  const Family& family(int number) const { return families_[number]; }
  int families() const { return static_cast<int>(families_.size()); }
  const Family& family_of(int stencil) const { return family(complex_.shape_number(stencil)); }
  std::size_t bytes() const;

  /// All stencils, or those of a list, in batches of one family: visit(stencils of the batch, its numbers[i·most + s]).
  using Stencils = std::span<const std::int32_t>;
  using Visit = std::function<void(Stencils, const double*)>;
  void each_lagrangian(Stencils, std::span<const double> y, const Visit&, const StencilReading& = {}) const;
  /// φ_t ∂ℓ/∂φ_t − ℓ of each stencil, with its measure and weights; of families with tables.
  void each_energy(Stencils, std::span<const double> y, const Visit&) const;
  void each_residual(Stencils, std::span<const double> y, const Visit&, const StencilReading& = {}) const;
  void each_jacobian(Stencils, std::span<const double> y, const Visit&, const StencilReading& = {}) const;
  std::vector<std::int32_t> all_stencils() const;

  /// The node that value i of a stencil is.
  std::size_t node(int stencil, int i) const {
    return at(complex_.vertices(stencil)[i / components_]) * at(components_) + at(i % components_);
  }
  /// E at every node, whether or not it holds there.
  std::vector<Balance> residual(std::span<const double> y) const;
  /// Σ |∂E/∂y y| at every node: what the terms of E have cancelled within stencils too.
  std::vector<double> sizes(std::span<const double> y) const;

 private:
  template <class Evaluate>
  void each(Stencils, std::span<const double> y, int power, const Evaluate&, const Visit&, const StencilReading&) const;

  int components_;
  Complex complex_;
  std::vector<Family> families_;       ///< its number is the number of its shape
  std::vector<std::int32_t> numbers_;  ///< of each stencil: where its own are
  std::vector<double> measures_, time_steps_;
};

/// What |E| is relative to: the largest sum of absolute terms where an equation holds, since a vacuum has no scale of its own.
/// Where all terms are rounding, as the differences of a constant field, the largest Σ |∂E/∂y y|.
double scale_of_equations(const ComplexSystem&, std::span<const Balance> E, std::span<const double> y);
/// The largest |E| where an equation holds, relative to this scale.
double largest_residual(const ComplexSystem&, std::span<const double> y);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "lattice/complex/complex.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

/// The field equations of a complex of stencils,
///
///     E(site) = Σ_{l: Δˡ = site} rˡ(y_Δ),    y[site·d + a],                     Marsden–Patrick–Shkoller (5.2)
///
/// A complex is a space of one row: its sites are those of the row, its stencils are listed, and what repeats on a lattice
/// are numbers of their own here. So equations, plan and checks are those of a LatticeSystem.
class ComplexSystem {
  struct Stencils;

 public:
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

    /// The number of a table; equal ones have the same. Throws BadInput where its slots have not the vertices of the form.
    int add_table(std::span<const TablePoint>);

    int vertices() const { return vertices_; }
    int size() const { return size_; }
    /// Which values feel each other, where a site of the complex holds so many of them.
    ComplexShape shape(int values_of_site) const;

   private:
    friend class ComplexSystem;
    std::span<const double> table(std::int32_t number) const {
      return std::span(tables_).subspan(at(number) * powers_.size(), powers_.size());
    }
    bool is_placed() const { return density_ ? density_->is_placed() : family_->is_placed(); }
    /// The place and the time of each point, of a stencil with these vertices.
    std::vector<double> places(std::span<const Complex::Position> vertices) const;
    std::shared_ptr<const JetFamily> on(std::shared_ptr<const ListedStencils>, const Stencils&) const;

    std::shared_ptr<const BatchDensity> density_;  ///< null: no tables
    std::shared_ptr<const StencilFamily> family_;  ///< null: tables
    int vertices_, size_;
    StencilTable table_ = {.pattern = {}, .points = {}};  ///< whose own numbers are those of a table, then the places
    std::vector<std::vector<TablePoint::Entry>> places_;  ///< of the points: weights of the vertices
    std::vector<TablePoint> form_;
    std::vector<SlotPowers> powers_;  ///< of each number of a table
    std::vector<double> tables_;      ///< the numbers of one after the other
    std::unordered_multimap<std::size_t, std::int32_t> known_;  ///< tables, by their hashes
    std::vector<char> coupled_;  ///< [i·size + m]
    bool reads_time_ = false;
  };

  explicit ComplexSystem(int components) : components_(components) {}

  /// So many are to be added: see Complex.
  void reserve(std::size_t sites, std::size_t stencils, std::size_t vertices) {
    complex_.reserve(sites, stencils, vertices), anchors_.reserve(stencils);
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

  /// The row, made when it is first asked for. Its families are those of here, one for each time or step where stencils of
  /// one batch must share it.
  const LatticeSystem& row() const;
  /// Of a stencil, as the row has it.
  Assembly::Anchor anchor(int stencil) const { return {anchors_[stencil].list, {0, anchors_[stencil].number}}; }
  /// An assembler of some stencils without equations.
  Assembly assembly(std::span<const std::int32_t> stencils) const;

  /// The stencils of a list, or all of them, sorted by their anchors: visit(stencil, its values, r or ∂r/∂y).
  using Visit = std::function<void(int stencil, const Assembly::Local&)>;
  void each_residual(std::span<const std::int32_t> stencils, std::span<const double> y, const Visit&) const;
  void each_jacobian(std::span<const std::int32_t> stencils, std::span<const double> y, const Visit&) const;
  std::vector<std::int32_t> all_stencils() const;
  /// L of each stencil.
  std::vector<double> lagrangians(std::span<const double> y) const;
  /// φ_t ∂ℓ/∂φ_t − ℓ of each stencil, with its measure and weights; of families with tables.
  std::vector<double> energies(std::span<const double> y) const;

  /// E at every node, whether or not it holds there.
  std::vector<Balance> residual(std::span<const double> y) const;
  /// Σ |∂E/∂y y| at every node: what the terms of E have cancelled within stencils too.
  std::vector<double> sizes(std::span<const double> y) const;

 private:
  /// Some stencils of a family that can be one batch.
  struct Stencils {
    int family;
    double step, time;                                    ///< of a family without tables
    std::vector<std::int32_t> tables = {}, numbers = {};  ///< `numbers`: of the stencils in the complex
    std::vector<double> measures = {}, steps = {};
    std::vector<std::vector<double>> places = {};  ///< of the points of a table
  };
  struct Place {
    std::int32_t list, number;
  };
  int stencil(const Assembly::Anchor& anchor) const { return lists_[anchor.family].numbers[anchor.site.space]; }
  std::shared_ptr<const StencilFamily> family_on_row(const Stencils&, std::shared_ptr<const JetFamily>&) const;

  int components_;
  Complex complex_;
  std::vector<Family> families_;  ///< its number is the number of its shape
  std::vector<Stencils> lists_;   ///< a family of the row each
  std::map<std::pair<int, std::vector<double>>, std::int32_t> list_of_;
  std::vector<Place> anchors_;  ///< of each stencil
  mutable std::shared_ptr<const LatticeSystem> row_;
  mutable std::vector<std::shared_ptr<const JetFamily>> tables_;  ///< of the row's families, those that have tables
};

/// What |E| is relative to: the largest sum of absolute terms where an equation holds, since a vacuum has no scale of its own.
/// Where all terms are rounding, as the differences of a constant field, the largest Σ |∂E/∂y y|.
double scale_of_equations(const ComplexSystem&, std::span<const Balance> E, std::span<const double> y);
/// The largest |E| where an equation holds, relative to this scale.
double largest_residual(const ComplexSystem&, std::span<const double> y);

}  // namespace delf

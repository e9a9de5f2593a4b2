// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "jets/tables/stencil_table.hpp"
#include "lattice/lattice.hpp"
#include "lattice/matrix_entry.hpp"
#include "lattice/plan/incidence.hpp"
#include "schemes/families/stencil_family.hpp"
#include "schemes/system/row_times.hpp"

namespace delf {

/// The role of a component of the section.
enum class Role {
  field,       ///< at the vertices of the lattice: what rows record
  inner,       ///< a field at a node inside the cells
  multiplier,  ///< of a constraint: its equation is the constraint
  trace,       ///< of a field, between cells: q, q⁻ or q⁺ of a broken element
  slaved       ///< at the vertices, determined by an equation of its own and not varied
};
inline constexpr std::array all_roles{Role::field, Role::inner, Role::multiplier, Role::trace, Role::slaved};
/// "field", "inner", …: the name of its dataset too.
const char* to_string(Role);

struct Component {
  std::string name = "phi";
  Role role = Role::field;
  NodePosition at = {};   ///< in the cell, as fractions of h and k
  bool position = false;  ///< of the sites themselves, which move: it grows along every row
  int field = 0;          ///< inner and trace: the field that it is a value of; a field is its own, counted from 0
  bool momentum = false;  ///< a multiplier that is a momentum of `field`: symmetries act on it by −Aᵀ
};
/// d fields at the vertices: "phi", or "phi1", "phi2", …
std::vector<Component> fields(int d);

/// Consecutive rows of a section in the order of sites, row[i·d + a]; what lies beyond the circle's ends is found by
/// going round, 2π·winding higher or lower each time.
struct Window {
  const Lattice* lattice;
  int components = 1;
  double monodromy = 0;        ///< φ(x + L) − φ(x)
  std::int64_t first_row = 0;  ///< index of rows[0]
  std::vector<std::vector<double>> rows;
  std::vector<double> monodromies = {};  ///< of each component, where they differ: multipliers are periodic
  /// The low parts, which rounding has taken from the rows: their values are rows + low. Empty: none is known.
  std::vector<std::vector<double>> low = {};

  /// Rows beyond the window read as its nearest row: stencils may reach there without depending on it.
  double operator()(std::int64_t row, int i, int a) const;
  bool has_low() const { return !rows.empty() && low.size() == rows.size(); }
  double low_part(std::int64_t row, int i, int a) const;
  std::int64_t last_row() const { return first_row + static_cast<std::int64_t>(rows.size()) - 1; }
};

/// An entry of the linearised field equation: ∂E/∂y at the site `offset` away, component `component`.
struct Coefficient {
  Site offset;
  int component = 0;
  double value = 0;
  Dependence dependence = Dependence::linear;
};

class LatticeSystem;
/// Every residual is the gradient of a Lagrangian: there is an action.
bool is_variational(const LatticeSystem&);

/// The discrete Euler–Lagrange field equations of some stencil families on a lattice, one stencil at a time: what
/// plans, starting rows, Newton steps and checks are made of. Steps themselves go by whole rows (Stepper).
///
///     E(site) = Σ_families Σ_{l: Δˡ = site} rˡ(y_Δ) = 0                   Marsden–Patrick–Shkoller (5.2)
///
/// one for each component: actions, constraints and whatever else there is are families alike.
class LatticeSystem {
 public:
  /// `components` names what the families' values are; without it they are fields at the vertices. Throws BadInput: a
  /// component without a name, a brick wall that does not close, a stencil that finds no place on the lattice.
  LatticeSystem(const Lattice&, std::vector<std::shared_ptr<const StencilFamily>>, double time_step,
                std::vector<Component> components = {});

  const Lattice& lattice() const { return lattice_; }
  int components() const { return static_cast<int>(names_.size()); }
  const Component& component(int a) const { return names_[a]; }
  const std::vector<Component>& all_components() const { return names_; }
  /// Components that are fields at the vertices.
  int fields() const;
  /// The component that is field a at the vertices.
  int field_component(int a) const;
  /// The sites move: a component is their position.
  bool moves() const;
  /// y(x + L) − y(x) of a component, where the fields gain `monodromy`.
  double monodromy_of(int component, double monodromy) const;
  /// The component keeps its value in this column: a fixed wall, where a node inside the cell lies on the wall or not.
  bool is_held(int column, int component) const { return lattice_.is_fixed(column) && names_[component].at.space == 0; }
  double time_step() const { return time_step_; }
  /// The times of rows: uniform, unless a run gives its steps lengths of their own. Copies of a system share them.
  const std::shared_ptr<RowTimes>& times() const { return times_; }
  void share_times(const LatticeSystem& other) { times_ = other.times_; }
  int width() const { return width_; }    ///< the largest space offset between two sites of one equation
  int height() const { return height_; }  ///< the same in time
  Placement placement() const { return placement_; }
  std::span<const std::shared_ptr<const StencilFamily>> families() const { return families_; }

  /// One stencil that reads a component at a site: which family, its anchor relative to that site, as which value.
  struct Touch {
    const StencilFamily* family;
    Site anchor;  ///< of a listed stencil the space is its number, and nothing relative
    int index;
    int family_index;
  };
  /// The stencils of `lattice` that read and vary the component at `site`, whose row matters by its parity.
  std::vector<Touch> touching(const Lattice& lattice, Site site, int component) const;
  std::vector<Touch> touching(Site site, int component) const { return touching(lattice_, site, component); }

  /// The linearised equation at a site, assembled: coefficients that cancel in the sum are absent, those that are the
  /// same at three seeded random fields are linear, and their value is that of the constant part.
  std::vector<Coefficient> linearised(const Lattice& lattice, Site site, int component) const;
  std::vector<Coefficient> linearised(Site site, int component) const { return linearised(lattice_, site, component); }

  /// The pattern that the plan is made of.
  SystemPattern pattern() const;

  /// Rows of all components, to be checked: `monodromy` is φ(x + L) − φ(x).
  Window window(std::int64_t first_row, std::vector<std::vector<double>> rows, double monodromy) const;

  /// True if a family has a stencil at (row, site), whose row matters by its parity.
  bool has_stencil(const StencilFamily&, std::int64_t row, int site) const;
  /// Anchors of a row that may have a stencil: sites, or the numbers of listed ones.
  int anchors(const StencilFamily& family) const {
    return family.listed() ? family.listed()->size() : lattice_.sites();
  }

  struct Value {
    double sum = 0, absolute = 0;  ///< Σ rˡ and Σ |rˡ|
  };
  /// E of every site and component of a row, [i·C + c], whether it is an equation there or not (Assembly).
  void equations(const Window&, std::int64_t row, std::vector<Value>& values) const;

  using Entry = MatrixEntry;
  /// ∂E(row, site, component)/∂y(unknown_row, ·) appended as entries with row and column site·d + component.
  void jacobian(const Window&, std::int64_t row, int site, int component, std::int64_t unknown_row, double time_step,
                std::vector<Entry>& entries) const;

 private:
  /// Nothing if the second derivatives are not finite at random fields of this amplitude.
  std::optional<std::vector<Coefficient>> linearised(const Lattice&, Site, int component, double amplitude) const;

  Lattice lattice_;
  std::vector<std::shared_ptr<const StencilFamily>> families_;
  double time_step_;
  std::shared_ptr<RowTimes> times_;
  std::vector<Component> names_;
  int width_ = 0, height_ = 0;
  Placement placement_ = Placement::every_site;
};

}  // namespace delf

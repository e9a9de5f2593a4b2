// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "lattice/incidence.hpp"
#include "lattice/lattice.hpp"
#include "schemes/stencil_family.hpp"

namespace delf {

/// Consecutive rows of a section in the order of sites, row[i·d + a]; what lies beyond the circle's ends is found by
/// going round, 2π·winding higher or lower each time.
struct Window {
  const Lattice* lattice;
  int components = 1;
  double turn = 0;                          ///< φ(x + L) − φ(x)
  std::int64_t first_row = 0;               ///< index of rows[0]
  std::vector<std::vector<double>> rows;

  /// Rows beyond the window read as its nearest row: stencils may reach there without depending on it.
  double operator()(std::int64_t row, int i, int a) const;
  std::int64_t last_row() const { return first_row + static_cast<std::int64_t>(rows.size()) - 1; }
};

/// An entry of the linearised field equation: ∂E/∂y at the site `offset` away, component `component`.
struct Coefficient {
  Site offset;
  int component = 0;
  double value = 0;
  Dependence dependence = Dependence::linear;
};

/// The discrete Euler–Lagrange field equations of some stencil families on a lattice, one stencil at a time: what
/// plans, starting rows, Newton steps and checks are made of. Steps themselves go by whole rows (Stepper).
///
///     E(site) = Σ_families Σ_{l: Δˡ = site} rˡ(y_Δ) = 0                   Marsden–Patrick–Shkoller (5.2)
///
class LatticeSystem {
 public:
  /// Throws BadInput: families with different numbers of components, a brick wall that does not close.
  LatticeSystem(const Lattice&, std::vector<std::shared_ptr<const StencilFamily>>, double time_step);

  const Lattice& lattice() const { return lattice_; }
  int components() const { return components_; }
  double time_step() const { return time_step_; }
  int width() const { return width_; }            ///< the largest space offset between two sites of one equation
  Placement placement() const { return placement_; }
  std::span<const std::shared_ptr<const StencilFamily>> families() const { return families_; }

  /// One stencil that touches a site: which family, its anchor relative to that site, as which vertex.
  struct Touch {
    const StencilFamily* family;
    Site anchor;
    int vertex;
  };
  /// The stencils of `lattice` that touch `site`, whose row matters by its parity.
  std::vector<Touch> touching(const Lattice& lattice, Site site) const;
  std::vector<Touch> touching(Site site) const { return touching(lattice_, site); }

  /// The linearised equation at a site, assembled: coefficients that cancel in the sum are absent, those that are the
  /// same at three seeded random fields are linear, and their value is that of the constant part.
  std::vector<Coefficient> linearised(const Lattice& lattice, Site site, int component) const;
  std::vector<Coefficient> linearised(Site site, int component) const { return linearised(lattice_, site, component); }

  /// What the plan is made of.
  SystemPattern pattern() const;

  struct Value {
    double sum = 0, absolute = 0;  ///< Σ rˡ and Σ |rˡ|
  };
  /// E(site) for a window around it; h may differ from the system's own (continuation).
  Value equation(const Window&, std::int64_t row, int site, int component, double time_step) const;

  struct Entry {
    int row, column;
    double value;
  };
  /// ∂E(row, site)/∂y(unknown_row, ·) appended as entries with row and column site·d + component.
  void jacobian(const Window&, std::int64_t row, int site, std::int64_t unknown_row, double time_step,
                std::vector<Entry>& entries) const;

 private:
  /// Nothing if the second derivatives are not finite at random fields of this amplitude.
  std::optional<std::vector<Coefficient>> linearised(const Lattice&, Site, int component, double amplitude) const;

  Cell gather(const Touch&, const Window&, std::int64_t row, int site, double time_step, std::vector<double>& y) const;

  Lattice lattice_;
  std::vector<std::shared_ptr<const StencilFamily>> families_;
  double time_step_;
  int components_ = 1, width_ = 0;
  Placement placement_ = Placement::every_site;
};

}  // namespace delf

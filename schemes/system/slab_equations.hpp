// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "jets/simd/pack.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

class BlockSolver;

/// Rows of a section for stepping slab by slab, row[i·C + c], each component in its place: a ring of the newest.
class SectionRing {
 public:
  SectionRing(int depth, std::size_t row_size)
      : depth_(depth), size_(row_size), values_(static_cast<std::size_t>(depth) * row_size, 0.0) {}
  double* row(std::int64_t r) { return values_.data() + slot(r); }
  const double* row(std::int64_t r) const { return values_.data() + slot(r); }
  int depth() const { return depth_; }
  std::size_t bytes() const { return values_.size() * sizeof(double); }

 private:
  std::size_t slot(std::int64_t r) const { return static_cast<std::size_t>(((r % depth_) + depth_) % depth_) * size_; }
  int depth_;
  std::size_t size_;
  std::vector<double> values_;
};

/// The equations of a slab and what they are made of: every stencil once, with the places that it reads and the
/// equations that it takes part in. For slabs of one parity; J is added when they are evaluated.
class SlabEquations {
 public:
  /// Rows J − past … J + future are there; stencils that reach further do not depend on what they read there.
  SlabEquations(const LatticeSystem&, const SolvePlan&, int parity, int past, int future, double turn);

  int size() const { return static_cast<int>(slab_.unknowns.size()); }
  /// Unknown and equation number n; site.time counts from J.
  const Node& unknown(int n) const { return slab_.unknowns[static_cast<std::size_t>(n)]; }
  const Node& equation(int n) const { return slab_.equations[static_cast<std::size_t>(n)]; }
  bool matched() const { return slab_.matched; }

  double& value(SectionRing& ring, std::int64_t J, int n) const {
    const Node& u = unknown(n);
    return ring.row(J + u.site.time)[u.site.space * components_ + u.component];
  }

  /// An entry of the Jacobian: ∂(equation)/∂(unknown).
  struct Place {
    int equation, unknown;
  };
  /// The entries that may differ from zero, each once.
  const std::vector<Place>& places() const { return places_; }

  /// A solver of this structure: entries that are zero at three seeded random sections, because they cancel between
  /// stencils, are no couplings to it.
  BlockSolver solver() const;

  /// E and Σ|terms| of every equation. With `momenta` (site·C + component), slab 1 from row 0 alone: the stencils below
  /// row 0 are replaced by their momenta ∂L/∂y₀, p₀ + Σ_above ∂L/∂y₀ = 0 (the discrete Legendre transform).
  void residual(const SectionRing&, std::int64_t J, std::vector<double>& E, std::vector<double>* absolute,
                const std::vector<double>* momenta = nullptr) const;
  /// The values of places().
  void jacobian(const SectionRing&, std::int64_t J, std::vector<double>& values,
                const std::vector<double>* momenta = nullptr) const;

  /// Σ_a ∂E/∂y_a V_a for several V at once, every a that the stencils read, and the values of places().
  void linearised(const SectionRing& y, std::int64_t J, const std::vector<SectionRing>& V,
                  std::vector<std::vector<double>>& E, std::vector<double>& values,
                  const std::vector<double>* momenta = nullptr) const;

  /// The part of E that contains no unknown of the slab, and E from it.
  void known(const SectionRing&, std::int64_t J, std::vector<double>& E) const;
  void residual_from(const std::vector<double>& known, const SectionRing&, std::int64_t J,
                     std::vector<double>& E) const;
  /// The values of places() without the terms that depend on the field. False if some family cannot tell.
  bool constant_jacobian(std::vector<double>& values) const;

  std::size_t bytes() const;

 private:
  /// Stencils of one family whose anchors are in one row, as many lanes as fill whole packs: the last is repeated, and
  /// what it repeats goes to an equation that nobody reads. Value i of stencil s is at i·padded + s.
  struct Batch {
    const StencilFamily* family;
    int size;             ///< values of a stencil
    int row, lowest_row;  ///< of the anchors and of the lowest value, from J
    int stencils = 0, padded = 0;
    std::size_t first_value;       ///< into value_row_, written_
    std::size_t first_read = 0;    ///< into place_, equation_, unknown_, add_
    std::size_t first_anchor = 0;  ///< into x_
    std::size_t first_entry = 0;   ///< into entry_: for each (stencil, i, m) with an equation and an unknown
    bool has_unknown = false;
    bool linear = false;                        ///< r = r(0) + J y with the same J in every cell
    std::size_t first_term = 0, last_term = 0;  ///< into terms_, of J, if it is
  };
  /// An entry of J that is not zero.
  struct Term {
    int i, m;
    double value;
  };
  using Numbers = std::vector<double>;

  void list_stencils(const LatticeSystem&, int parity);
  void list_reads(const LatticeSystem&, int past, int future, double turn);
  void list_places();
  void take_linear_part(Batch&);
  void evaluate_linear(const Batch&, const Pack* y, Pack* r) const;

  bool below_start(const Batch& b, std::int64_t J, bool legendre) const { return legendre && J + b.lowest_row < 0; }
  Cell cell(const Batch& b, std::int64_t J, double x) const;
  void add_residual(const Batch&, const SectionRing&, std::int64_t J, double* E, double* absolute) const;
  void evaluate(const Batch&, const SectionRing&, std::int64_t J, int first) const;
  void gather(const Batch&, const SectionRing&, std::int64_t J, int stencil) const;
  template <class Visit>
  void for_each_entry(const Batch&, const Visit&) const;
  void add_jacobian(const Batch&, std::span<const double> J, int stencil, const int*& entry, Numbers& values) const;
  std::vector<char> present() const;

  double time_step_, space_step_;
  int components_, depth_;
  std::size_t row_size_;
  Slab slab_;
  std::vector<Batch> batches_;
  std::vector<int> value_row_;  ///< of value i, from J
  std::vector<char> written_;   ///< some stencil's value i has an equation
  std::vector<int> place_;      ///< site·C + component
  std::vector<int> equation_;   ///< that the value's residual belongs to, or size()
  std::vector<int> unknown_;    ///< that the value is, or −1
  Numbers add_;                 ///< for having gone round the circle; empty if nothing is added
  std::vector<Pack> x_;         ///< of the anchors
  std::vector<Place> places_;
  std::vector<int> entry_;
  Numbers fixed_;  ///< the values of places() that linear batches give
  std::vector<Term> terms_;
  Numbers at_zero_;                  ///< r(0) of value i
  mutable std::vector<Pack> y_, r_;  ///< of a pack of stencils
  mutable Numbers y_one_, r_one_, J_one_;
};

}  // namespace delf

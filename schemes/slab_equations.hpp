// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "lattice/solve_plan.hpp"
#include "schemes/lattice_system.hpp"

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

  std::size_t bytes() const;

 private:
  struct Read {
    int row, place;  ///< from J; site·C + component
    double add;      ///< for having gone round the circle
    int equation;    ///< that the value's residual belongs to, or −1
    int unknown;     ///< that the value is, or −1
  };
  struct Member {
    const StencilFamily* family;
    int first, anchor_row, lowest_row;
    double x;
    int first_entry;  ///< into entry_: for each (i, m) with an equation and an unknown
  };
  void gather(const Member&, const SectionRing&, std::int64_t J) const;
  std::vector<char> present() const;
  Cell cell(const Member&, std::int64_t J) const;

  double time_step_, space_step_;
  int components_, depth_;
  std::size_t row_size_;
  Slab slab_;
  std::vector<Member> members_;
  std::vector<Read> reads_;
  std::vector<Place> places_;
  std::vector<int> entry_;
  mutable std::vector<double> y_, r_, J_;
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/stepping/rows/row_increment.hpp"
#include "schemes/stepping/rows/row_layout.hpp"
#include "schemes/stepping/rows/row_sum.hpp"

namespace delf {

/// A step strip by strip, from the first pack to the last, for rows that outgrow the cache: what comes before and after
/// finds a strip in the cache. The new row may be written over the old one: neighbours are read before.
class RowStream {
 public:
  virtual ~RowStream() = default;
  /// Packs whose right side must be ready before begin(); `work` has room for them, pack v at layout.at(v).
  virtual PackRange last_packs() const = 0;
  virtual void begin(double* work) = 0;
  /// The right side is ready up to pack `end`. Returns up to where the new row is done: `work` has room from there
  /// on, and holds what was put there. What is looked at of the row is held against `expected`; null: what the row is
  /// more than y_n + v_n, w itself.
  virtual int advance(int end, double* work, const double* expected) = 0;
  /// Without the last `parts` − 1 packs of each advance(), which look beyond its end. The row is not closed.
  virtual RowChange result() const = 0;
};

/// A factored matrix over the unknowns of a slab: solves A w = rhs for whole rows, d rows each. In words: `name()`.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// w may be rhs. Halos of w are not filled.
  virtual void solve(const double* const* rhs, double* const* w) const = 0;
  /// The step itself: w from right sides that are summed on the way, and with it the new row. The right sides are those
  /// of A w times right_side_scale(); `w` is work space. The new row is closed: overlaps, halos and looks beyond its end.
  virtual RowChange advance(const RowLayout&, int components, const RowSum* const* right_sides,
                            const RowIncrement* rows, double* const* w) const;
  /// A is one number: w is the right side times right_side_scale().
  virtual bool is_a_number() const { return false; }
  virtual double right_side_scale(int /*component*/) const { return 1; }
  /// Whether advance() needs the rows w where the new increment is not made from itself.
  virtual bool needs_work_rows() const { return true; }
  /// The same as advance() strip by strip, for one component; nothing where that is not worth while.
  virtual std::unique_ptr<RowStream> stream(const RowLayout&, const RowSum&, const RowIncrement&) const {
    return nullptr;
  }
  virtual std::size_t bytes() const = 0;
  virtual std::string name() const = 0;
};

/// A row of the matrix: entries at offsets (in unknowns, site-major) from the diagonal.
struct BandEntry {
  int offset;
  double value;
};

/// Factors the matrix whose row i·d + a has the given entries, choosing what its structure allows: a division for a
/// diagonal, two recurrences along the lanes for a symmetric circulant of width 1, an LU of the (cyclic) band, or a
/// sparse LU when the band would wrap onto itself or its pivots are not safe. Throws NoConvergence if it is singular.
std::unique_ptr<LinearSolver> factor(const Lattice&, const RowLayout&, int components,
                                     const std::vector<LatticeSystem::Entry>& entries);

/// The same for a matrix that is alike at every site of a circle, from its stencil alone, for d = 1.
std::unique_ptr<LinearSolver> factor_uniform(const Lattice&, const RowLayout&, std::span<const BandEntry> stencil);

/// For components that the matrix does not couple: each has its own solver.
std::unique_ptr<LinearSolver> by_component(std::vector<std::unique_ptr<LinearSolver>>);

}  // namespace delf

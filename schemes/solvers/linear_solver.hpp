// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lattice/matrix_entry.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/solvers/row_sum.hpp"
#include "schemes/solvers/row_update.hpp"

namespace delf {

/// A solve by a sweep to the right and one to the left, strip by strip, so that what makes the right side and what uses
/// the solution find a strip in the cache. One component; w holds the right side.
class Sweeps {
 public:
  virtual ~Sweeps() = default;
  /// Packs whose right side begin() reads, none for most.
  virtual PackRange warm_up() const { return {0, 0}; }
  /// The first solution needs all right sides.
  virtual bool takes_whole_rows() const { return false; }
  virtual void begin(double* w) = 0;
  /// The right side is there for the packs up to `end`; the first call begins at pack 0. With a sum, it is that one.
  virtual void forward(double* w, int end) = 0;
  virtual void forward(const RowSum& right_side, const double* const* rows, double* w, int end) = 0;
  /// The next packs to solve for: none until more are swept forward. Whatever the order, each comes once.
  virtual PackRange ready() const = 0;
  /// Solves for them, and updates their sites by the solution, which is not kept.
  virtual void backward(const double* w, RowUpdate&) = 0;
};

/// A factored matrix over the unknowns of a slab: solves A w = rhs for whole rows, d rows each. In words: `name()`.
class LinearSolver {
 public:
  virtual ~LinearSolver() = default;
  /// Solves in place: w holds the right sides times right_side_scale(). Halos are not filled.
  virtual void solve(double* const* w) const = 0;
  virtual double right_side_scale(int /*component*/) const { return 1; }
  /// Null where it cannot be done by sweeps.
  virtual std::unique_ptr<Sweeps> sweeps(int /*component*/) const { return nullptr; }
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
                                     const std::vector<MatrixEntry>& entries);

/// The solver of a matrix that is the same at every site of a circle, one component.
std::unique_ptr<LinearSolver> factor_uniform(const Lattice&, const RowLayout&, std::span<const BandEntry> stencil);

/// Components that do not couple.
std::unique_ptr<LinearSolver> by_component(std::vector<std::unique_ptr<LinearSolver>> solvers);

}  // namespace delf

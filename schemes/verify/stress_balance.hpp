// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "schemes/system/cell_jet.hpp"
#include "schemes/verify/check.hpp"

namespace delf {

class FieldTheory;

/// ∂_t density + ∂_x flux + source = 0, at the middle of a cell.
struct Current {
  double density = 0, flux = 0, source = 0;
};

/// One balance law over the cells of a lattice, row after row of them: what it misses at each vertex, and in total.
class BalanceLaw {
 public:
  BalanceLaw(const Lattice& lattice, double time_step) : lattice_(lattice), time_step_(time_step) {}

  /// The cells between the rows `row` and `row` + 1, of consecutive rows.
  void add(std::int64_t row, const std::vector<Current>& cells);

  /// The largest found, and where.
  struct Largest {
    double value = 0, scale = 0;  ///< scale: the largest sum of the absolute values of the terms, anywhere
    std::int64_t row = 0;
    int site = 0;
    std::int64_t count = 0;

    void add(double value, double absolute, std::int64_t row, int site);
  };
  const Largest& local() const { return local_; }
  const Largest& total() const { return total_; }

 private:
  struct Sums {
    double density = 0, absolute = 0, flux = 0, source = 0;
  };
  void add_vertices(std::int64_t row, const std::vector<Current>& above);
  void add_total(std::int64_t row, const Sums& above);
  Sums sums(const std::vector<Current>& cells) const;
  int first_vertex() const { return lattice_.space() == Space::interval ? 1 : 0; }
  int end_vertex() const { return lattice_.sites() - first_vertex(); }
  int left_cell(int site) const { return lattice_.wrapped(site - 1); }

  Lattice lattice_;
  double time_step_;
  std::vector<Current> below_;  ///< cells under the row that is checked; none at first
  Sums sums_below_;
  double first_density_ = 0, passed_ = 0;  ///< passed: through the ends and from sources, since the first row of cells
  Largest local_, total_;
};

/// The balance laws of energy and momentum, which belong to translations in time and in space:
///
///     ∂_t(φ_t ∂ℓ/∂φ_t − ℓ) + ∂_x(φ_t ∂ℓ/∂φ_x) + ∂ℓ/∂t = 0        ∂_t(−φ_x ∂ℓ/∂φ_t) + ∂_x(ℓ − φ_x ∂ℓ/∂φ_x) − ∂ℓ/∂x = 0
///
/// The lattice breaks both symmetries, so that nothing here is conserved: it is measured how fast the defects vanish
/// with h. Every cell carries the symmetric rectangle's jet, whatever the scheme; where its sites move, these are not
/// the laws. Of densities of second order, the totals on a circle. Rows are read as they come: no more than two are kept.
class StressBalance {
 public:
  /// `monodromy` is φ(x + L) − φ(x) on a circle. Keeps a reference to the theory.
  StressBalance(const FieldTheory& theory, const Lattice& lattice, double time_step, double monodromy);

  /// The fields of a row, [i·d + a]. Rows are consecutive; throws std::logic_error for one that is not.
  void add(std::int64_t row, std::span<const double> fields);

  /// "energy balance, local", "energy balance, total", and the same of momentum, which mechanics has none of.
  /// local: the largest defect at a vertex; total: the largest sum of the local ones over space and the time so far.
  std::vector<Measured> results() const;

 private:
  void add_cells(std::int64_t row, std::span<const double> above);
  std::vector<Measured> of_second_order() const;
  Measured local_of(const std::string& name, const BalanceLaw&) const;
  Measured total_of(const std::string& name, const BalanceLaw&) const;

  const FieldTheory& theory_;
  Lattice lattice_;
  double time_step_;
  std::int64_t newest_ = 0;
  std::vector<double> row_;  ///< of index newest_; none at first
  CellJets jets_;
  std::vector<Current> energy_cells_, momentum_cells_;
  BalanceLaw energy_, momentum_;
};

/// Fills `order` = log₂(coarse/fine), by name, of runs at h and k and at half of both. Not a number where the finer one
/// is round-off.
std::vector<Measured> with_orders(std::vector<Measured> coarse, const std::vector<Measured>& fine);

}  // namespace delf

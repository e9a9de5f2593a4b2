// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <vector>

#include "schemes/system/lattice_system.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/stepping/rows/row_equations.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {

/// The newest rows y and increments v of a stepper, in the rings of its table. Row n is number 1 of a ring: number 0 is where
/// row n + 1 is made. Steps in place make it over row n; the row before the first of them stays.
class KeptRows {
 public:
  /// The rows of equations that read `history` rows; φ(x + L) = φ(x) + monodromy.
  KeptRows(const LatticeSystem&, const RowLayout&, const RowEquations&, RowTable&, int history, double monodromy);

  /// The newest `history` of these rows, and the increments between them.
  void start(const std::vector<std::vector<double>>& rows);
  /// Number `back` of the ring, from values by site and component.
  void set(int back, const std::vector<double>& values);
  /// Increments of number `back`, from its row and the row before.
  void find_increment(int back);
  /// y_{n+1} = y_n + v_n
  void extrapolate();
  /// Row n + 1 has been made.
  void advance();

  std::int64_t newest() const { return n_; }
  std::int64_t start_row() const { return started_; }  ///< the increment to the row before it is not known
  int known() const { return known_; }                 ///< newest rows that are there
  /// Number `back` of the ring, by site and component; its largest |y|.
  std::vector<double> values(int back) const;
  double largest(int back) const;
  /// So many rows, the newest last. Throws std::logic_error if they are not there.
  Window window(int rows) const;
  void require(int rows) const;
  /// Number of a row in its ring, so many rows before the unknown one: the oldest stands where the next is made.
  int number(int back) const { return back % (history_ + 1); }
  std::vector<const double*> all() const;

  bool in_place() const { return !beside_.empty(); }
  /// Lets row n + 1 take the place of row n from here on.
  void go_in_place();
  void advance_in_place();
  void leave_place();
  /// Back to the row before the first step in place.
  void go_back_to_kept();
  /// The oldest row is about to be written over.
  void forget_oldest();

  void visit(SavedState&);
  std::size_t bytes() const;

 private:
  const LatticeSystem& system_;
  const RowLayout& layout_;
  const RowEquations& equations_;
  RowTable& table_;
  int d_, history_;
  double monodromy_;
  std::int64_t n_ = -1, started_ = -1, kept_row_ = -1;
  int known_ = 0;
  std::vector<double*> beside_;  ///< where row n + 1 is made when steps are not in place; empty if they are not
};

}  // namespace delf

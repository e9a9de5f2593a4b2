// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <vector>

namespace delf {

/// Sites first … last − 1 of a row, in the order in which they lie in memory.
struct Strip {
  int first = 0, last = 0;
  explicit operator bool() const { return first < last; }
};

/// The right side of a step is that of w = v_{n+1} − v_n, and g stands in it; of a correction that of δw, and δ.
enum class Solving { step, correction };

/// The operations that steps by rows are made of (row_stepper.cpp), strip by strip:
///
///     evaluate     g = ∂ℓ/∂φ at the quadrature values of the rows up to n
///     predict      g ≈ Σ_j (−1)^{j+1} C(p, j) g_{n+1−j}
///     right_side   r = −(linear part of the known rows) − r(0) − Σ hk weight · g,  or −Σ hk weight · δ
///     solve        A₊ w = r
///     update       v_{n+1} = v_n + w,  y_{n+1} = y_n + v_{n+1},                    or v_{n+1} += w,  y_{n+1} += w
///     compare      g′ = ∂ℓ/∂φ at the quadrature values of row n + 1,  δ = g′ − g,  g ← g′
///
/// A call is for a strip, never for a site: what makes an operation fast lies behind it. RowStrips has them for packs of
/// sites on one processor. Where rows are shared by several, or lie on a card, or sites are those of a mesh, a strip may be
/// a whole row.
class RowOperations {
 public:
  virtual ~RowOperations() = default;

  /// The strips of this part of a row, in the order in which a pass takes them.
  const std::vector<Strip>& strips() const { return strips_; }

  /// One pass over the rows: `along` each of the parts that they are shared out in, once or, where parts must join first,
  /// twice; then halos, and comparisons that wait for these. Returns the largest |y_{n+1}|, and of each source term the largest |δ| in
  /// `corrections`; null if nothing is compared.
  virtual double pass(Solving, std::vector<double>* corrections, const std::function<void(RowOperations&)>& along) = 0;

  virtual void evaluate(Strip) = 0;
  /// Predicts from the source terms of `order` rows.
  virtual void predict(int order, Strip) = 0;
  virtual void right_side(Strip) = 0;
  /// The next strip to update: right sides of other strips may have to come first, and then it is empty.
  virtual Strip solve() = 0;
  virtual void update(Strip) = 0;
  /// Compares as far as row n + 1 is there.
  virtual void compare(Strip) = 0;

  /// g in whole rows: those terms that depend on rows up to n alone, and that other sites read; or those that depend on row
  /// n + 1, as it stands.
  virtual void evaluate_known() = 0;
  virtual void evaluate_unknown() = 0;

 protected:
  std::vector<Strip> strips_;
};

}  // namespace delf

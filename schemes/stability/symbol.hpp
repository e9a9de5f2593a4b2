// SPDX-License-Identifier: MIT
#pragma once
#include <complex>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/system/lattice_system.hpp"

namespace delf {

/// The symbol of a scheme at a constant state: its linearised equations applied to a wave y_ij = zʲ e^{iθi} v,
///
///     P(z, θ) v = 0,        P_ab(z, θ) = Σ_{t,s} A_ab(t, s) zᵗ e^{iθs},
///
/// with A_ab(t, s) the derivative of equation a by the component b, t rows later and s sites to the right: sums of
/// entries of the Hessians. Its roots z are the amplification factors of a step on all of space, without walls.
///
/// On a brick wall the equations of even and of odd sites (row + site) differ, and v has the values of both, first all
/// components of the even ones. As (−1)^(row + site) is a wave too, (z, θ) and (−z, θ + π) are then the same mode.
class Symbol {
 public:
  using Complex = std::complex<double>;

  /// All components have the value `constant`. Throws BadInput: a multiplier of a constraint
  /// that is not linear in the fields (scheme.method), a density that depends on
  /// t or x, or that has no finite second derivatives there (theory.name), equations that determine no unknown.
  explicit Symbol(const LatticeSystem&, double constant = 0);

  int size() const { return size_; }  ///< of v
  int components() const { return components_; }
  int fields() const { return fields_; }
  bool brick() const { return brick_; }
  double time_step() const { return time_step_; }
  double space_step() const { return space_step_; }
  /// The place of the component of v in its cell, as fractions of h and k.
  NodePosition position(int v) const { return positions_[index(v % components_)]; }

  /// All modes have their mirror image in 0 ≤ θ ≤ zone(): 0 for mechanics, π/2 for bricks, else π.
  double zone() const { return zone_; }

  /// det P(z, θ) = 0, largest |z| first, without those that are zero whatever the coefficients. A step that cannot be
  /// solved at this wave number is one infinite root.
  std::vector<Complex> roots(double theta) const;
  /// max |z|; a root on the unit circle to round-off has |z| = 1.
  double amplification(double theta) const;
  /// The amplification of given roots(θ).
  double amplification(double theta, const std::vector<Complex>& roots) const;

  /// P, row by row.
  std::vector<Complex> matrix(Complex z, double theta) const;
  /// The singular values of P with its rows and columns scaled, relative to the size of its terms; smallest last. One
  /// of them is zero if z is a root.
  std::vector<double> singular_values(Complex z, double theta) const;
  /// True if z is a root to round-off.
  bool is_root(Complex z, double theta) const;
  /// The v of Euclidean length 1 with the smallest |P v|.
  std::vector<Complex> mode(Complex z, double theta) const;
  /// The number of independent constant fields that solve the equations: P(1, 0) v = 0.
  int constant_solutions() const;

 private:
  struct Term {
    int equation, unknown, time, space;
    double value;
  };
  /// The unknown and its row that an equation is solved for (Σ-method), and the number of roots.
  struct Order {
    std::vector<int> c, d;   ///< of equations and unknowns: their rows in a slab
    std::vector<int> depth;  ///< of unknowns: slabs before this one that equations read
    int roots = 0;
  };
  struct Powers;  ///< the matrices of all powers of z
  struct Scaled;  ///< P with its rows and columns scaled, over the size of its terms

  static std::size_t index(int i) { return at(i); }
  static Order order_of(int size, const std::vector<Term>& terms);
  std::vector<Complex> phases(double theta) const;
  Scaled scaled(Complex z, double theta) const;
  void find_inner();
  bool eliminate(Powers&) const;
  std::vector<Complex> roots_of(const Powers&, const Order&) const;
  std::vector<Complex> scalar_roots(double theta) const;

  int size_ = 0, components_ = 0, fields_ = 0;
  bool brick_ = false;
  double time_step_, space_step_, zone_;
  int low_ = 0, high_ = 0, width_ = 0;  ///< t = low … high, |s| ≤ width
  std::vector<NodePosition> positions_;
  std::vector<Term> terms_;    ///< scaled: scale_[a] A_ab scale_[b]
  std::vector<double> scale_;  ///< powers of two
  double norm_ = 0;            ///< of the terms, scaled
  Order order_;
  std::vector<int> outer_, inner_;  ///< inner: nodes between the rows, which their own equations eliminate
  Order outer_order_;
};

}  // namespace delf

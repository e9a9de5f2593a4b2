// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <memory>
#include <vector>

#include "jets/simd/pack.hpp"
#include "schemes/solvers/block_solver.hpp"
#include "schemes/solvers/site_groups.hpp"

namespace delf {

/// A matrix of groups that are coupled with their neighbours alone, round a circle. It is cut into as many arcs as
/// there are lanes by separators of a group or more; lane l eliminates arc l from its left end to its right one,
///
///     D_t ← D_t − L_t W_{t−1},    W_t = D_t⁻¹ U_t,    z_t = D_t⁻¹ (r_t − L_t z_{t−1}),    x_t = z_t − W_t x_{t+1},
///
/// and what is left is a dense matrix for the separators s, to which arcs are coupled at their ends:
///
///     x = A⁻¹ r − P s_left − Q s_right.
///
/// Rows are exchanged within groups only, alike in all lanes: a factorisation is looked at before it is trusted.
class ArcSolver {
 public:
  using Entries = BlockSolver::Entries;

  /// Nothing if groups are too large or too few, or too much of them would be separators.
  static std::unique_ptr<ArcSolver> make(const SiteGroups&, Entries);

  /// `values` by the entries' places. False where it is singular, or what it solves is not accurate.
  bool factor(const std::vector<double>& values, Entries);
  /// A x = rhs; x may not be rhs.
  void solve(const double* rhs, double* x) const;
  std::size_t bytes() const;

 private:
  static constexpr int largest_group = 12, most_separated = 256;
  enum Part { diagonal, lower, upper, left, right, parts };

  struct Separator {
    int first_group, groups;
    int first, first_size;  ///< its first group's numbers among the separators'
    int last, last_size;
  };

  static std::size_t at(int i) { return static_cast<std::size_t>(i); }
  std::size_t block(Part part, int t) const { return (at(t) * parts + at(part)) * at(b_ * b_); }
  Pack* part(Part p, int t) { return pool_.data() + block(p, t); }
  const Pack* part(Part p, int t) const { return pool_.data() + block(p, t); }
  std::size_t coupling(int separator, bool next) const;

  /// False if it does not lie like this.
  bool place(const SiteGroups&, Entries);
  template <class Home>
  void list_members(const std::vector<int>& group_of, int G, const std::vector<Home>& home,
                    const std::vector<int>& number, std::vector<int>& in_arcs, std::vector<int>& separated,
                    std::vector<int>& in_group) const;

  /// a −= l · u
  void subtract_product(Pack* a, const Pack* l, const Pack* u) const;
  /// a ← l · a
  void multiply(const Pack* l, Pack* a) const;

  static double least(Pack a);
  /// a ← a⁻¹ by Gauss and Jordan; the pivot is the row whose smallest lane is largest. False if it is zero.
  bool invert(Pack* a) const;

  bool eliminate();
  /// The separators' own matrix, with what goes through the arcs.
  bool join();
  /// Solves for a vector that is known: A x = b is to hold up to rounding.
  bool is_accurate(const std::vector<double>& values, Entries) const;

  template <int size>
  void solve_groups_of(const double* rhs, double* x) const;

  void solve_separators(const double* rhs, double* x, Pack* s_left, Pack* s_right) const;

  int b_ = 0, arc_ = 0, separated_ = 0;  ///< of a group; groups of an arc; unknowns of all separators
  std::vector<Separator> separators_;    ///< separator l is before arc l
  std::vector<Pack> pool_;         ///< the parts of each t, rows · b + columns; `diagonal` is D⁻¹, `upper` is W
  std::vector<double> couplings_;  ///< the separators' own entries, then theirs with the arcs before and after
  Eigen::MatrixXd inverse_;
  std::vector<int> where_;  ///< of each entry: in pool_ by lanes, or −1 − where in couplings_
  std::vector<int> row_, column_, separated_row_, separated_column_;
  mutable std::vector<Pack> z_;
  mutable Eigen::VectorXd separated_rhs_, separated_x_;
};

}  // namespace delf

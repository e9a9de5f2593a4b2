// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/OrderingMethods>
#include <Eigen/SparseLU>
#include <algorithm>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "lattice/index.hpp"

namespace delf {

/// A sparse LU factorisation whose unknowns are eliminated place by place. The order of places is one of least degree of
/// the graph of places, two of which are neighbours where an equation of one has an unknown of the other; unknowns of a
/// place stay together, in their order. What is found at a place is regular by itself, even where it has a multiplier, whose
/// diagonal is 0: an order of single unknowns that does not know it fills the factors.
class SitewiseLU {
 public:
  using Matrix = Eigen::SparseMatrix<double>;
  using Vector = Eigen::VectorXd;

  /// The place of each equation and of each unknown, by numbers that are not negative.
  SitewiseLU(std::vector<int> of_equations, std::vector<int> of_unknowns)
      : of_equations_(std::move(of_equations)), of_unknowns_(std::move(of_unknowns)) {
    std::vector<int> number;  // of a place, in the order of unknowns
    for (auto* places : {&of_unknowns_, &of_equations_})
      for (int& place : *places) {
        if (number.size() <= at(place)) number.resize(at(place) + 1, -1);
        if (number[place] < 0) number[place] = places_++;
        place = number[place];
      }
  }

  /// False where A is singular. All matrices have the pattern of the first.
  bool factorize(const Matrix& A) {
    if (!lu_) {
      find_order(A);
      lu_ = std::make_unique<Factors>();
      lu_->analyzePattern(A * order_);
    }
    lu_->factorize(A * order_);
    return lu_->info() == Eigen::Success;
  }
  Vector solve(const Vector& E) const { return order_ * Vector(lu_->solve(E)); }
  /// Frees the factors; the next matrix is analysed anew.
  void forget() { lu_.reset(); }

 private:
  using Factors = Eigen::SparseLU<Matrix, Eigen::NaturalOrdering<int>>;
  using Order = Eigen::PermutationMatrix<Eigen::Dynamic, Eigen::Dynamic, int>;

  void find_order(const Matrix& A) {
    std::vector<Eigen::Triplet<double>> neighbours;
    for (Eigen::Index u = 0; u < A.outerSize(); ++u)
      for (Matrix::InnerIterator e(A, u); e; ++e) neighbours.emplace_back(of_equations_[e.row()], of_unknowns_[u], 1.0);
    Matrix graph(places_, places_);
    graph.setFromTriplets(neighbours.begin(), neighbours.end());
    Order of_places;  // places in the order of their elimination
    Eigen::AMDOrdering<int>()(graph, of_places);
    std::vector<int> turn(places_), unknowns(of_unknowns_.size());
    for (int n = 0; n < places_; ++n) turn[of_places.indices()[n]] = n;
    std::iota(unknowns.begin(), unknowns.end(), 0);
    std::ranges::stable_sort(unknowns, {}, [&](int u) { return turn[of_unknowns_[u]]; });
    order_ = Order(Eigen::Map<const Eigen::VectorXi>(unknowns.data(), A.cols()));
  }

  std::vector<int> of_equations_, of_unknowns_;
  int places_ = 0;
  Order order_;
  std::unique_ptr<Factors> lu_;
};

}  // namespace delf

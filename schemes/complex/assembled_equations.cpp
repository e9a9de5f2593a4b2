// SPDX-License-Identifier: MIT
#include "schemes/complex/assembled_equations.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lattice/index.hpp"

namespace delf {
namespace {

using Triplet = Eigen::Triplet<double>;

}  // namespace

AssembledEquations::AssembledEquations(const ComplexSystem& system, std::vector<std::int32_t> stencils, int count,
                                       const Number& equation, const Number& unknown)
    : system_(system), count_(count) {
  const Complex& complex = system.complex();
  std::sort(stencils.begin(), stencils.end(), [&](auto s, auto t) {
    return std::pair(complex.shape_number(s), s) < std::pair(complex.shape_number(t), t);
  });
  stencils.erase(std::unique(stencils.begin(), stencils.end()), stencils.end());
  for (const auto s : stencils)
    for (int i = 0; i < system.family_of(s).size(); ++i) nodes_.push_back(system.node(s, i));
  std::sort(nodes_.begin(), nodes_.end());
  nodes_.erase(std::unique(nodes_.begin(), nodes_.end()), nodes_.end());
  nodes_.shrink_to_fit();  // each was there as often as stencils read it
  for (const auto s : stencils) {
    const ComplexSystem::Family& family = system.family_of(s);
    Stencils& to = family.is_linear() ? linear_ : nonlinear_;
    to.list.push_back(s);
    const std::size_t begin = to.rows.size();
    for (int i = 0; i < family.size(); ++i) {
      const std::size_t node = system.node(s, i);
      to.places.push_back(place_of(node)), to.rows.push_back(equation(node)), to.columns.push_back(unknown(node));
    }
    for (int i = 0; i < family.size() && !family.is_linear(); ++i)
      for (int m = 0; m < family.size(); ++m)
        if (to.rows[begin + at(i)] >= 0 && to.columns[begin + at(m)] >= 0 && family.is_varying(i, m)) direct_ = false;
  }
  assemble();
  linear_ = {};  // all of it is in the matrices
}

std::int32_t AssembledEquations::place_of(std::size_t node) const {
  return static_cast<std::int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
}

void AssembledEquations::assemble() {
  const Vector zero = Vector::Zero(static_cast<Eigen::Index>(nodes_.size()));
  at_zero_ = Vector::Zero(count_);
  std::vector<Triplet> all, of_unknowns;
  const auto collect = [&](const Stencils& stencils, bool linear) {
    if (linear) each(stencils, zero, [&](std::size_t i, double r) { at_zero_[stencils.rows[i]] += r; });
    each(stencils, zero, [&](std::size_t i, std::size_t m, double value) {
      if (linear) all.emplace_back(stencils.rows[i], stencils.places[m], value);
      if (stencils.columns[m] >= 0) of_unknowns.emplace_back(stencils.rows[i], stencils.columns[m], value);
    });
  };
  collect(linear_, true);
  if (direct_) collect(nonlinear_, false);  // what nonlinear stencils make of the unknowns is constant too
  matrix_.resize(count_, static_cast<Eigen::Index>(nodes_.size()));
  matrix_.setFromTriplets(all.begin(), all.end());
  of_unknowns_.resize(count_, count_);
  of_unknowns_.setFromTriplets(of_unknowns.begin(), of_unknowns.end());
}

std::size_t AssembledEquations::bytes() const {
  const auto of = [](const auto& matrix) { return at(12 * matrix.nonZeros() + 4 * matrix.outerSize()); };
  const auto numbers = [](const auto&... all) { return (... + (all.capacity() * sizeof(all[0]))); };
  std::size_t sum = of(matrix_) + of(of_unknowns_) + 8 * at(at_zero_.size()) + numbers(nodes_);
  sum += numbers(nonlinear_.list, nonlinear_.places, nonlinear_.rows, nonlinear_.columns);
  return sum;
}

AssembledEquations::Vector AssembledEquations::residual(const Vector& y) const {
  Vector E = at_zero_;
  E.noalias() += matrix_ * y;
  add_nonlinear(y, E);
  return E;
}

AssembledEquations::Vector AssembledEquations::absolute(const Vector& y) const {
  Vector sum = matrix_.cwiseAbs() * y.cwiseAbs();
  each(nonlinear_, y, [&](std::size_t i, std::size_t m, double value) {
    sum[nonlinear_.rows[i]] += std::abs(value * y[nonlinear_.places[m]]);
  });
  return sum;
}

}  // namespace delf

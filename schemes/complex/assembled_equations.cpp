// SPDX-License-Identifier: MIT
#include "schemes/complex/assembled_equations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }
using Triplet = Eigen::Triplet<double>;

/// Adds the entries to those of `all`, and returns them as a matrix; they are gone then, as there are many.
template <class M>
M take(std::vector<Triplet>& entries, M& all) {
  M part(all.rows(), all.cols());
  part.setFromTriplets(entries.begin(), entries.end());
  std::vector<Triplet>().swap(entries);
  all = all.nonZeros() == 0 ? part : M(all + part);
  return part;
}

/// The entries of a matrix, and where they stand in another one that has at least these.
template <class M>
void find_places(const M& part, const M& all, std::vector<int>& places, std::vector<double>& values) {
  places.reserve(static_cast<std::size_t>(part.nonZeros())), values.reserve(places.capacity());
  const int* const inner = all.innerIndexPtr();
  for (Eigen::Index outer = 0; outer < part.outerSize(); ++outer) {
    int place = all.outerIndexPtr()[outer];
    for (typename M::InnerIterator e(part, outer); e; ++e) {
      while (inner[place] < e.index()) ++place;
      places.push_back(place), values.push_back(e.value());
    }
  }
}

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
    const PlacedFamily& family = system.family_of(s);
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
  scale();
}

std::int32_t AssembledEquations::place_of(std::size_t node) const {
  return static_cast<std::int32_t>(std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
}

void AssembledEquations::assemble() {
  const Vector zero = Vector::Zero(static_cast<Eigen::Index>(nodes_.size()));
  struct Entries {
    Vector at_zero;
    std::vector<Triplet> all, of_unknowns;
  };
  std::map<std::pair<int, int>, Entries> parts;  // by part and power
  const auto collect = [&](const Stencils& stencils, bool linear) {
    // The stencil of each value.
    std::vector<Entries*> entries_of;
    for (const auto s : stencils.list) {
      const PlacedFamily& family = system_.family_of(s);
      Entries& entries = parts[{system_.part_of(s), family.time_power().value_or(0)}];
      if (entries.at_zero.size() == 0) entries.at_zero = Vector::Zero(count_);
      entries_of.insert(entries_of.end(), at(family.size()), &entries);
    }
    if (linear)
      each(
          stencils, zero, [&](std::size_t i, double r) { entries_of[i]->at_zero[stencils.rows[i]] += r; }, true);
    each(
        stencils, zero,
        [&](std::size_t i, std::size_t m, double value) {
          if (linear) entries_of[i]->all.emplace_back(stencils.rows[i], stencils.places[m], value);
          if (stencils.columns[m] >= 0)
            entries_of[i]->of_unknowns.emplace_back(stencils.rows[i], stencils.columns[m], value);
        },
        true);
  };
  collect(linear_, true);
  if (direct_) collect(nonlinear_, false);  // what nonlinear stencils make of the unknowns is constant too
  matrix_.resize(count_, static_cast<Eigen::Index>(nodes_.size()));
  of_unknowns_.resize(count_, count_);
  std::vector<Rows> matrices;
  std::vector<Matrix> matrices_of_unknowns;
  for (auto& [key, entries] : parts) {
    matrices.push_back(take(entries.all, matrix_));
    matrices_of_unknowns.push_back(take(entries.of_unknowns, of_unknowns_));
  }
  at_zero_ = Vector::Zero(count_);
  if (parts.empty()) return;
  if (parts.size() == 1 && parts.begin()->first.first == 0) {  // which is not scaled
    at_zero_ = std::move(parts.begin()->second.at_zero);
    return;
  }
  std::size_t n = 0;
  for (auto& [key, entries] : parts) {
    Scaled part{key.first, key.second, std::move(entries.at_zero), {}, {}, {}, {}};
    if (part.at_zero.isZero(0)) part.at_zero.resize(0);
    find_places(matrices[n], matrix_, part.places, part.values);
    find_places(matrices_of_unknowns[n], of_unknowns_, part.places_of_unknowns, part.values_of_unknowns);
    matrices[n] = {}, matrices_of_unknowns[n++] = {};
    parts_.push_back(std::move(part));
  }
}

void AssembledEquations::scale() {
  if (parts_.empty()) return;
  const auto clear = [](auto& matrix) { std::fill_n(matrix.valuePtr(), matrix.nonZeros(), 0.0); };
  clear(matrix_), clear(of_unknowns_);
  at_zero_.setZero();
  for (const Scaled& part : parts_) {
    const double factor = system_.factor(part.part, 2 * part.power);
    const auto add = [&](const std::vector<int>& places, const std::vector<double>& values, double* to) {
      for (std::size_t n = 0; n < places.size(); ++n) to[places[n]] += factor * values[n];
    };
    add(part.places, part.values, matrix_.valuePtr());
    add(part.places_of_unknowns, part.values_of_unknowns, of_unknowns_.valuePtr());
    if (part.at_zero.size() > 0) at_zero_ += system_.factor(part.part, part.power) * part.at_zero;
  }
}

std::size_t AssembledEquations::bytes() const {
  const auto of = [](const auto& matrix) {
    return static_cast<std::size_t>(12 * matrix.nonZeros() + 4 * matrix.outerSize());
  };
  const auto numbers = [](const auto&... all) { return (... + (all.capacity() * sizeof(all[0]))); };
  std::size_t sum = of(matrix_) + of(of_unknowns_) + 8 * static_cast<std::size_t>(at_zero_.size()) + numbers(nodes_);
  sum += numbers(nonlinear_.list, nonlinear_.places, nonlinear_.rows, nonlinear_.columns);
  for (const Scaled& part : parts_)
    sum += numbers(part.places, part.places_of_unknowns, part.values, part.values_of_unknowns) +
           8 * static_cast<std::size_t>(part.at_zero.size());
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

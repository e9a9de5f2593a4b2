// SPDX-License-Identifier: MIT
#include "schemes/row_equations.hpp"

#include <algorithm>

namespace delf {

/// One loop will do if the unknown row has one coefficient, and all that is known are differences to neighbours and
/// outputs of the site's own value.
void RowEquations::build_loop() {
  if (system_.families().size() != 1 || bricks_ || equations_.correction_form || !equations_.exceptional.empty())
    return;
  const RowKernel& kernel = *system_.families()[0]->row_kernel();
  const auto neighbours = kernel.explicit_neighbours();
  if (neighbours.empty() || kernel.nonlinearity() != Nonlinearity::values) return;
  std::vector<double> linear(neighbours.size() * static_cast<std::size_t>(d_), 0.0), nonlinear;
  for (int a = 0; a < d_; ++a) {
    const auto own = static_cast<std::size_t>(a);
    const EquationTerms& equation = equations_.bulk[own];
    const auto& unknowns = equations_.unknowns[own];
    if (unknowns.size() != 1 || unknowns[0].space != 0 || unknowns[0].component != a || equation.constant != 0) return;
    const double factor = -1 / unknowns[0].coefficient;
    nonlinear.push_back(0);
    for (const Term& t : equation.terms) {
      const auto at = std::ranges::find(neighbours, t.shift) - neighbours.begin();
      const bool beside = at < static_cast<std::ptrdiff_t>(neighbours.size());
      if (t.source == Source::output && t.age + kernel.outputs_read_until() <= 0)
        nonlinear.back() += factor * t.coefficient;
      else if (t.source == Source::difference && t.component == a && beside)
        linear[own * neighbours.size() + static_cast<std::size_t>(at)] += factor * t.coefficient;
      else if (t.source != Source::unknown) return;
    }
  }
  one_loop_ = &kernel;
  loop_linear_ = std::move(linear);
  loop_nonlinear_ = std::move(nonlinear);
  loop_reach_ = std::ranges::max(neighbours);
  loop_now_.resize(static_cast<std::size_t>(d_));
  loop_v_before_.resize(static_cast<std::size_t>(d_));
  loop_y_.resize(static_cast<std::size_t>(d_));
  loop_v_.resize(static_cast<std::size_t>(d_));
}

int RowEquations::first_of_part(int part, int parts) const {
  if (part == 0 || part == parts) return part == 0 ? 0 : layout_.packs();
  return static_cast<int>(static_cast<long long>(part) * layout_.packs() / parts);
}

/// At the ends of the row that is its halo, which stays; in between it is a copy.
const double* RowEquations::edge(int part, int parts, int side, int a) const {
  const double* const y = loop_now_[static_cast<std::size_t>(a)];
  if (part == 0 && side == 0) return y + layout_.at(-loop_reach_);
  if (part + 1 == parts && side == 1) return y + layout_.at(layout_.packs());
  return edges_.row(0) + static_cast<std::ptrdiff_t>(((2 * part + side) * d_ + a) * loop_reach_) * lanes;
}

void RowEquations::begin_loop(int parts, bool in_place) {
  const bool known = loop_row_ == n_;
  if (in_place) rows_.overwrite_newest();
  for (int c = 0; c < d_; ++c) {
    const auto a = static_cast<std::size_t>(c);
    // Where rows lie takes divisions to find: a step in place after another goes on where that one was.
    if (known) loop_now_[a] = loop_y_[a], loop_v_before_[a] = loop_v_[a];
    if (known && in_place) continue;
    loop_y_[a] = rows_.y(n_ + 1, c), loop_v_[a] = rows_.v(n_ + 1, c);
    if (known) continue;
    loop_now_[a] = in_place ? loop_y_[a] : rows_.y(n_, c);
    loop_v_before_[a] = in_place ? loop_v_[a] : rows_.v(n_, c);
  }
  loop_row_ = n_ + 1;
  if (parts == 1) return;
  if (edges_.bytes() < edge_doubles(parts) * sizeof(double)) edges_ = RowBuffer(edge_doubles(parts));
  for (int boundary = 1; boundary < parts; ++boundary)
    for (int a = 0; a < d_; ++a) {
      const double* const y = loop_now_[static_cast<std::size_t>(a)] + layout_.at(first_of_part(boundary, parts));
      const int doubles_beside = loop_reach_ * lanes;
      std::copy_n(y, doubles_beside, const_cast<double*>(edge(boundary - 1, parts, 1, a)));
      std::copy_n(y - doubles_beside, doubles_beside, const_cast<double*>(edge(boundary, parts, 0, a)));
    }
}

double RowEquations::loop(int part, int parts) const {
  constexpr int most = RowKernel::most_components;
  const double *now[most], *v_before[most], *before[most], *after[most];
  double *v[most], *y[most];
  for (int a = 0; a < d_; ++a) {
    now[a] = loop_now_[static_cast<std::size_t>(a)];
    v_before[a] = loop_v_before_[static_cast<std::size_t>(a)];
    v[a] = loop_v_[static_cast<std::size_t>(a)];
    y[a] = loop_y_[static_cast<std::size_t>(a)];
    before[a] = edge(part, parts, 0, a);
    after[a] = edge(part, parts, 1, a);
  }
  return one_loop_->explicit_step(
      {slab_of(now, n_), before, after, v_before, v, y, loop_linear_.data(), loop_nonlinear_.data()},
      {first_of_part(part, parts), first_of_part(part + 1, parts)});
}

void RowEquations::measure_loop(LargestTerms* terms) {
  constexpr int most = RowKernel::most_components;
  const double *now[most], *v_before[most];
  double* v[most];
  for (int a = 0; a < d_; ++a) now[a] = rows_.y(n_, a), v_before[a] = rows_.v(n_, a), v[a] = rows_.v(n_ + 1, a);
  one_loop_->explicit_residual(
      {slab_of(now, n_), nullptr, nullptr, v_before, v, nullptr, loop_linear_.data(), loop_nonlinear_.data()}, terms);
}

void RowEquations::close_loop() {
  for (int a = 0; a < d_; ++a) layout_.fill_halo(loop_y_[static_cast<std::size_t>(a)], turn_);
}

}  // namespace delf

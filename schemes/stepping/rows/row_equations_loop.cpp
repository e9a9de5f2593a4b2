// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/row_equations.hpp"

#include <algorithm>
#include <limits>

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
  loop_near_squares_ = kernel.near_below() > 0 ? kernel.near_below() * kernel.near_below() : -1;
  for (auto* rows : {&loop_now_, &loop_before_, &loop_after_, &loop_v_before_}) rows->resize(static_cast<std::size_t>(d_));
  for (auto* rows : {&loop_y_, &loop_v_}) rows->resize(static_cast<std::size_t>(d_));
  loop_rows_ = {.now = slab_of(loop_now_.data(), 0),
                .before = loop_before_.data(),
                .after = loop_after_.data(),
                .v_before = loop_v_before_.data(),
                .v = loop_v_.data(),
                .y = loop_y_.data(),
                .linear = loop_linear_.data(),
                .nonlinear = loop_nonlinear_.data()};
}

/// At the ends of the row that is its halo, which stays; in between it is a copy.
const double* RowEquations::edge(int part, int parts, int side, int a) const {
  const double* const y = loop_now_[static_cast<std::size_t>(a)];
  if (part == 0 && side == 0) return y + layout_.at(-loop_reach_);
  if (part + 1 == parts && side == 1) return y + layout_.at(layout_.packs());
  return edges_.row(0) + static_cast<std::ptrdiff_t>(((2 * part + side) * d_ + a) * loop_reach_) * lanes;
}

void RowEquations::begin_loop(int parts, bool in_place, double sum_of_squares) {
  if (in_place) rows_.overwrite_newest();
  loop_rows_.now.t = static_cast<double>(n_) * time_step_;
  loop_rows_.now.near = sum_of_squares <= loop_near_squares_;
  const bool keeps_slopes = !in_place && !loop_slopes_.empty();
  loop_rows_.slopes = keeps_slopes ? loop_slopes_.data() : nullptr;
  if (keeps_slopes) slopes_row_ = n_;
  // Where rows lie takes divisions to find: a step in place after another goes on where that one was.
  if (!in_place || !loop_in_place_ || loop_row_ != n_) find_loop_rows(in_place);
  loop_row_ = n_ + 1;
  if (parts == 1) return;
  if (edges_.bytes() < edge_doubles(parts) * sizeof(double)) edges_ = RowBuffer(edge_doubles(parts));
  for (int boundary = 1; boundary < parts; ++boundary)
    for (int a = 0; a < d_; ++a) {
      const std::ptrdiff_t first = layout_.at(layout_.first_of_part(boundary, parts));
      const double* const y = loop_now_[static_cast<std::size_t>(a)] + first;
      const int doubles_beside = loop_reach_ * lanes;
      std::copy_n(y, doubles_beside, const_cast<double*>(edge(boundary - 1, parts, 1, a)));
      std::copy_n(y - doubles_beside, doubles_beside, const_cast<double*>(edge(boundary, parts, 0, a)));
    }
}

void RowEquations::find_loop_rows(bool in_place) {
  const bool known = loop_row_ == n_;
  for (int c = 0; c < d_; ++c) {
    const auto a = static_cast<std::size_t>(c);
    if (known) loop_now_[a] = loop_y_[a], loop_v_before_[a] = loop_v_[a];
    if (!known || !in_place) loop_y_[a] = rows_.y(n_ + 1, c), loop_v_[a] = rows_.v(n_ + 1, c);
    if (!known) {
      loop_now_[a] = in_place ? loop_y_[a] : rows_.y(n_, c);
      loop_v_before_[a] = in_place ? loop_v_[a] : rows_.v(n_, c);
    }
    loop_before_[a] = edge(0, 1, 0, c), loop_after_[a] = edge(0, 1, 1, c);
  }
  loop_in_place_ = in_place;
}

double RowEquations::loop(int part, int parts) const {
  if (parts == 1) return one_loop_->explicit_step(loop_rows_, layout_.all());
  constexpr int most = RowKernel::most_components;
  const double *before[most], *after[most];
  for (int a = 0; a < d_; ++a) before[a] = edge(part, parts, 0, a), after[a] = edge(part, parts, 1, a);
  ExplicitRows rows = loop_rows_;
  rows.before = before, rows.after = after;
  return one_loop_->explicit_step(rows, {layout_.first_of_part(part, parts), layout_.first_of_part(part + 1, parts)});
}

/// Slopes that the step has not kept are found again, some packs at a time. They are kept by the next steps where this
/// is asked for after every one: then it pays for the row that they take.
void RowEquations::measure_loop(LargestTerms* terms) {
  constexpr int most_packs = 32, most = RowKernel::most_components;
  if (slopes_row_ == n_) {
    for (int a = 0; a < d_; ++a) terms[a] = measure_loop(a, layout_.all(), loop_slopes_[static_cast<std::size_t>(a)], {});
  } else {
    alignas(Pack) double found[most][most_packs * lanes];
    const double* now[most];
    for (int a = 0; a < d_; ++a) now[a] = rows_.y(n_, a);
    const SlabRows slab = slab_of(now, n_);
    for (int first = 0; first < layout_.packs(); first += most_packs) {
      const PackRange packs{first, std::min(first + most_packs, layout_.packs())};
      double* slopes[most];
      for (int a = 0; a < d_; ++a) slopes[a] = found[a] - layout_.at(first);
      one_loop_->explicit_slopes(slab, slopes, packs);
      for (int a = 0; a < d_; ++a) terms[a] = measure_loop(a, packs, slopes[a], terms[a]);
    }
    if (residual_row_ >= 0 && residual_row_ == n_ - 1 && loop_slopes_.empty()) {
      scratch_ = RowBuffer(layout_, d_);
      for (int a = 0; a < d_; ++a) loop_slopes_.push_back(scratch_.row(a));
    }
  }
  residual_row_ = n_;
}

/// What is left of the step's equation, for the rows as they are,
///
///     E = Σ_s linear(s) (y(i + s) − y(i)) + nonlinear ∂ℓ/∂φ(y(i)) − (v_{n+1} − v_n)(i)
LargestTerms RowEquations::measure_loop(int a, const PackRange& packs, const double* slopes,
                                        LargestTerms largest) const {
  const double *const y = rows_.y(n_, a), *const v_before = rows_.v(n_, a), *const v = rows_.v(n_ + 1, a);
  const auto neighbours = one_loop_->explicit_neighbours();
  const double* const linear = loop_linear_.data() + static_cast<std::size_t>(a) * neighbours.size();
  const double nonlinear = loop_nonlinear_[static_cast<std::size_t>(a)];
  const auto measure = [&](const auto& add_linear) __attribute__((always_inline)) {
    for (int pack = packs.first; pack < packs.last; ++pack) {
      const std::ptrdiff_t at = layout_.at(pack);
      const Pack w = Pack::load(v + at) - Pack::load(v_before + at);
      Pack E = -w, size = abs(w);
      const auto add = [&](double coefficient, Pack term, Pack magnitude) __attribute__((always_inline)) {
        E += coefficient * term;
        size += std::abs(coefficient) * magnitude;
      };
      add_linear(at, add);
      const Pack slope = Pack::load(slopes + at);
      add(nonlinear, slope, abs(slope));
      largest(at, E, size);
    }
  };
  const auto difference = [y](std::ptrdiff_t to, std::ptrdiff_t from) __attribute__((always_inline)) {
    return Pack::load(y + to) - Pack::load(y + from);
  };
  if (loop_reach_ > 1) {
    measure([&](std::ptrdiff_t at, const auto& add) {
      for (std::size_t s = 0; s < neighbours.size(); ++s) {
        const Pack term = difference(at + neighbours[s] * lanes, at);
        add(linear[s], term, abs(term));
      }
    });
    return largest;
  }
  // y(i) − y(i − 1), and its size: the pack before has worked it out.
  const double to_last = -linear[0], to_next = linear[1];
  Pack last = difference(layout_.at(packs.first), layout_.at(packs.first - 1)), last_size = abs(last);
  measure([&](std::ptrdiff_t at, const auto& add) __attribute__((always_inline)) {
    const Pack next = difference(at + lanes, at), next_size = abs(next);
    add(to_last, last, last_size);
    add(to_next, next, next_size);
    last = next, last_size = next_size;
  });
  return largest;
}

void RowEquations::close_loop() {
  for (int a = 0; a < d_; ++a) layout_.fill_halo(loop_y_[static_cast<std::size_t>(a)], turn_);
}

void RowEquations::tile(int parts) {
  if (!is_one_loop() || turn_ != 0 || !TimeTiles::are_worth_while(layout_, loop_reach_, parts)) return;
  tiles_.emplace(layout_, *one_loop_, d_, loop_reach_, parts);
}

bool RowEquations::loop_levels(std::span<double> squares, double sum_of_squares, RowTeam* team) {
  begin_loop(1, true, sum_of_squares);
  for (std::size_t level = 1; level < squares.size(); ++level) rows_.overwrite_newest();
  loop_row_ = n_ + static_cast<std::int64_t>(squares.size());
  tiles_->run(loop_rows_, n_, squares, team);
  close_loop();
  const double most = loop_rows_.now.near ? loop_near_squares_ : std::numeric_limits<double>::infinity();
  return std::ranges::all_of(squares, [most](double sum) { return sum <= most; });
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <utility>
#include <vector>

#include "schemes/row_layout.hpp"

namespace delf {

/// A sum over shifted rows, with coefficients and shifts that are known at set-up and rows that change from step to
/// step:
///
///     constant + Σ coefficient · (row(shifted) − row) + Σ coefficient · row(shifted)
///
/// A pass hands every pack's sum to `consume(at, sum)`, so that what is done with it needs no pass of its own. Like
/// std::for_each it works with a copy of `consume` and returns it: what that carries along stays in registers.
class RowSum {
 public:
  /// `row` is an index into the rows that bind() is given; `shift` in sites.
  void add_difference(int row, int shift, double coefficient) { differences_.push_back({row, shift, coefficient}); }
  void add(int row, int shift, double coefficient) { plain_.push_back({row, shift, coefficient}); }
  void add_constant(double c) { constant_ += c; }
  /// Multiplies every coefficient.
  void scale(double factor);

  /// Sums are taken of these rows from here on; where one of them is another, bind again.
  void bind(const double* const* rows) {
    for (Term& t : differences_) t.bind(rows);
    for (Term& t : plain_) t.bind(rows);
  }

  template <class Consume>
  [[gnu::always_inline]] Consume pass(const RowLayout& layout, PackRange packs, Consume consume) const;
  /// The same with `consume` itself: where one goes on with what another pass left, a copy would go through memory.
  template <class Consume>
  [[gnu::always_inline]] void pass_on(const RowLayout& layout, PackRange packs, Consume& consume) const {
    dispatch<false>(layout, packs, consume);
  }
  /// The same for every second pack.
  template <class Consume>
  [[gnu::always_inline]] void pass_bricks(const RowLayout& layout, PackRange packs, Consume consume) const {
    if (are_of_one_row() && static_cast<int>(plain_.size()) <= most_plain<false>)
      counted<false, false, 2>(layout, packs, consume);
    else general_pass<false>(layout, packs, consume);
  }
  /// The same with the sum of the terms' absolute values: `consume(at, sum, absolute)`.
  template <class Consume>
  Consume measure(const RowLayout& layout, PackRange packs, Consume consume) const;

 private:
  struct Term {
    int row, shift;
    double coefficient;
    const double *own = nullptr, *shifted = nullptr;  ///< the row, and it from `shift` sites further on
    void bind(const double* const* rows) {
      own = rows[row];
      shifted = own + static_cast<std::ptrdiff_t>(shift) * lanes;
    }
  };
  bool are_of_one_row() const { return differences_.size() == 2 && differences_[0].row == differences_[1].row; }
  /// Differences are those to the sites on either side.
  bool are_to_both_sides() const {
    return are_of_one_row() && differences_[0].shift + differences_[1].shift == 0 &&
           std::abs(differences_[0].shift) == 1;
  }
  // Inlined where they are used: what `consume` carries would else be copied through memory.
  template <bool measured, class Consume>
  [[gnu::always_inline]] void dispatch(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, bool carried, int differences, int plain, class Consume>
  [[gnu::always_inline]] void counted_pass(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, bool carried, int differences, class Consume>
  [[gnu::always_inline]] void counted(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, class Consume>
  [[gnu::always_inline]] void general_pass(const RowLayout&, PackRange, Consume&) const;
  template <bool measured>
  static constexpr int most_plain = measured ? 11 : 8;  ///< with the unknown row's

  std::vector<Term> differences_, plain_;
  double constant_ = 0;
};

/// `carried`: differences to the next pack and to the one before it, packs one after the other. Either is then the
/// other's of the pack before: one subtraction for both.
template <bool measured, bool carried, int differences, int plain, class Consume>
inline void RowSum::counted_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const double *beside[differences + 1], *row[plain + 1];
  const double* const here = differences > 0 ? differences_[0].own : nullptr;
  double difference_coefficient[differences + 1], coefficient[plain + 1];
  for (int i = 0; i < differences; ++i) {
    const Term& t = differences_[static_cast<std::size_t>(i)];
    beside[i] = t.shifted, difference_coefficient[i] = t.coefficient;
  }
  double of_next = 0, of_last = 0;
  if constexpr (carried) {
    const bool next_first = differences_[0].shift > 0;
    of_next = difference_coefficient[next_first ? 0 : 1], of_last = difference_coefficient[next_first ? 1 : 0];
  }
  for (int i = 0; i < plain; ++i) {
    const Term& t = plain_[static_cast<std::size_t>(i)];
    row[i] = t.shifted, coefficient[i] = t.coefficient;
  }
  const Pack constant(constant_);
  const std::ptrdiff_t end = layout.at(packs.last), by = static_cast<std::ptrdiff_t>(packs.stride) * lanes;
  std::ptrdiff_t at = layout.at(packs.first);
  Pack value = differences > 0 ? Pack::load(here + at) : constant;
  Pack last = carried ? value - Pack::load(here + at - lanes) : constant;
  for (; at < end; at += by) {
    Pack sum = constant, absolute(0.0);
    if constexpr (carried) {
      const Pack next_value = Pack::load(here + at + lanes), next = next_value - value;
      sum += of_next * next;
      sum -= of_last * last;
      if constexpr (measured) absolute += std::abs(of_next) * abs(next) + std::abs(of_last) * abs(last);
      value = next_value, last = next;
    } else {
      if (differences > 0) value = Pack::load(here + at);
      for (int i = 0; i < differences; ++i) {
        const Pack difference = Pack::load(beside[i] + at) - value;
        sum += difference_coefficient[i] * difference;
        if constexpr (measured) absolute += std::abs(difference_coefficient[i]) * abs(difference);
      }
    }
    for (int i = 0; i < plain; ++i) {
      const Pack term = Pack::load(row[i] + at);
      sum += coefficient[i] * term;
      if constexpr (measured) absolute += std::abs(coefficient[i]) * abs(term);
    }
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
  }
}

template <bool measured, class Consume>
inline void RowSum::general_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  for (int v = packs.first; v < packs.last; v += packs.stride) {
    const std::ptrdiff_t at = layout.at(v);
    Pack sum = constant_, absolute(0.0);
    const auto add = [&](Pack term) {
      sum += term;
      if constexpr (measured) absolute += abs(term);
    };
    for (const Term& t : differences_) add(t.coefficient * (Pack::load(t.shifted + at) - Pack::load(t.own + at)));
    for (const Term& t : plain_) add(t.coefficient * Pack::load(t.shifted + at));
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
  }
}

/// The numbers of terms of the usual schemes are compiled, differences being those of one row: rows then stay in
/// registers.
template <bool measured, bool carried, int differences, class Consume>
inline void RowSum::counted(const RowLayout& layout, PackRange packs, Consume& consume) const {
  [&]<int... plain>(std::integer_sequence<int, plain...>) __attribute__((always_inline)) {
    const int count = static_cast<int>(plain_.size());
    ((count == plain ? counted_pass<measured, carried, differences, plain>(layout, packs, consume) : void()), ...);
  }
  (std::make_integer_sequence<int, most_plain<measured> + 1>{});
}
template <bool measured, class Consume>
inline void RowSum::dispatch(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const bool is_counted = static_cast<int>(plain_.size()) <= most_plain<measured>;
  if (is_counted && differences_.empty()) return counted<measured, false, 0>(layout, packs, consume);
  if (is_counted && packs.stride == 1 && are_to_both_sides())
    return counted<measured, true, 2>(layout, packs, consume);
  if constexpr (measured)  // every second pack too
    if (is_counted && are_of_one_row()) return counted<true, false, 2>(layout, packs, consume);
  general_pass<measured>(layout, packs, consume);
}

template <class Consume>
inline Consume RowSum::pass(const RowLayout& layout, PackRange packs, Consume consume) const {
  dispatch<false>(layout, packs, consume);
  return consume;
}
template <class Consume>
Consume RowSum::measure(const RowLayout& layout, PackRange packs, Consume consume) const {
  dispatch<true>(layout, packs, consume);
  return consume;
}

}  // namespace delf

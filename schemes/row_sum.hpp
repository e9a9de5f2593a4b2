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

  /// Every second pack, v where v + `phase` is odd, takes the other sum, as bricks do.
  void take_turns_with(const RowSum& other, int phase) { other_ = &other, phase_ = phase; }

  template <class Consume>
  [[gnu::always_inline]] Consume pass(const RowLayout& layout, PackRange packs, Consume consume) const;
  /// The same with `consume` itself: where one goes on with what another pass left, a copy would go through memory.
  template <class Consume>
  [[gnu::always_inline]] void pass_on(const RowLayout& layout, PackRange packs, Consume& consume) const {
    dispatch<false>(layout, packs, consume);
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
  const RowSum& of(int pack) const { return other_ && (pack + phase_) % 2 != 0 ? *other_ : *this; }
  /// Differences are those to the sites on either side.
  bool are_to_both_sides() const {
    return differences_.size() == 2 && differences_[0].row == differences_[1].row &&
           differences_[0].shift + differences_[1].shift == 0 && std::abs(differences_[0].shift) == 1;
  }
  bool are_like(const RowSum& other) const {
    return plain_.size() == other.plain_.size() && are_to_both_sides() && other.are_to_both_sides() &&
           differences_[0].row == other.differences_[0].row;
  }
  /// The terms of a counted pass, as a pass keeps them.
  template <int differences, int plain>
  struct Counted;
  // Inlined where they are used: what `consume` carries would else be copied through memory.
  template <bool measured, class Consume>
  [[gnu::always_inline]] void dispatch(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, bool in_turn, int differences, int plain, class Consume>
  [[gnu::always_inline]] void counted_pass(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, bool in_turn, int differences, int most, class Consume>
  [[gnu::always_inline]] void counted(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, class Consume>
  [[gnu::always_inline]] void general_pass(const RowLayout&, PackRange, Consume&) const;
  /// Compiled, with the unknown row's where sums are measured; of sums that take turns.
  template <bool measured>
  static constexpr int most_plain = measured ? 11 : 8;
  template <bool measured>
  static constexpr int most_in_turn = measured ? 6 : 3;

  std::vector<Term> differences_, plain_;
  double constant_ = 0;
  const RowSum* other_ = nullptr;
  int phase_ = 0;
};

/// None or two differences: those to the next pack and to the one before it. Either is then the other's of the pack
/// before: one subtraction for both.
template <int differences, int plain>
struct RowSum::Counted {
  const double* row[plain + 1];
  double coefficient[plain + 1];
  double of_next = 0, of_last = 0;
  Pack constant;

  [[gnu::always_inline]] explicit Counted(const RowSum& sum) : constant(sum.constant_) {
    for (int i = 0; i < plain; ++i) {
      const Term& t = sum.plain_[static_cast<std::size_t>(i)];
      row[i] = t.shifted, coefficient[i] = t.coefficient;
    }
    if constexpr (differences > 0) {
      const std::size_t next = sum.differences_[0].shift > 0 ? 0 : 1;
      of_next = sum.differences_[next].coefficient, of_last = sum.differences_[1 - next].coefficient;
    }
  }
};

/// `in_turn`: with the other sum, which is like this one. Packs follow each other.
template <bool measured, bool in_turn, int differences, int plain, class Consume>
inline void RowSum::counted_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const Counted<differences, plain> first(of(packs.first)), second(in_turn ? of(packs.first + 1) : *this);
  const double* const here = differences > 0 ? differences_[0].own : nullptr;
  std::ptrdiff_t at = layout.at(packs.first);
  const std::ptrdiff_t end = layout.at(packs.last);
  Pack value = differences > 0 ? Pack::load(here + at) : Pack(0.0);
  Pack last = differences > 0 ? value - Pack::load(here + at - lanes) : Pack(0.0);
  const auto take = [&](const Counted<differences, plain>& terms) __attribute__((always_inline)) {
    Pack sum = terms.constant, absolute(0.0);
    if constexpr (differences > 0) {
      const Pack next_value = Pack::load(here + at + lanes), next = next_value - value;
      sum += terms.of_next * next;
      sum -= terms.of_last * last;
      if constexpr (measured) absolute += std::abs(terms.of_next) * abs(next) + std::abs(terms.of_last) * abs(last);
      value = next_value, last = next;
    }
    for (int i = 0; i < plain; ++i) {
      const Pack term = Pack::load(terms.row[i] + at);
      sum += terms.coefficient[i] * term;
      if constexpr (measured) absolute += std::abs(terms.coefficient[i]) * abs(term);
    }
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
    at += lanes;
  };
  if constexpr (in_turn) {
    while (at + lanes < end) take(first), take(second);
    if (at < end) take(first);
  } else {
    while (at < end) take(first);
  }
}

template <bool measured, class Consume>
inline void RowSum::general_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  for (int v = packs.first; v < packs.last; ++v) {
    const std::ptrdiff_t at = layout.at(v);
    const RowSum& terms = of(v);
    Pack sum = terms.constant_, absolute(0.0);
    const auto add = [&](Pack term) {
      sum += term;
      if constexpr (measured) absolute += abs(term);
    };
    for (const Term& t : terms.differences_) add(t.coefficient * (Pack::load(t.shifted + at) - Pack::load(t.own + at)));
    for (const Term& t : terms.plain_) add(t.coefficient * Pack::load(t.shifted + at));
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
  }
}

/// The numbers of terms of the usual schemes are compiled, differences being those to both sides: rows then stay in
/// registers.
template <bool measured, bool in_turn, int differences, int most, class Consume>
inline void RowSum::counted(const RowLayout& layout, PackRange packs, Consume& consume) const {
  [&]<int... plain>(std::integer_sequence<int, plain...>) __attribute__((always_inline)) {
    const int count = static_cast<int>(plain_.size());
    ((count == plain ? counted_pass<measured, in_turn, differences, plain>(layout, packs, consume) : void()), ...);
  }
  (std::make_integer_sequence<int, most + 1>{});
}
template <bool measured, class Consume>
inline void RowSum::dispatch(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const int count = static_cast<int>(plain_.size());
  if (other_) {
    if (count <= most_in_turn<measured> && are_like(*other_))
      return counted<measured, true, 2, most_in_turn<measured>>(layout, packs, consume);
  } else if (count <= most_plain<measured>) {
    if (differences_.empty()) return counted<measured, false, 0, most_plain<measured>>(layout, packs, consume);
    if (are_to_both_sides()) return counted<measured, false, 2, most_plain<measured>>(layout, packs, consume);
  }
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

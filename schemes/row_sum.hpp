// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
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

  void bind(const double* const* rows);

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
    const double* shifted = nullptr;
    const double* own = nullptr;
  };
  // Inlined where they are used: what `consume` carries would else be copied through memory.
  template <bool measured, class Consume>
  [[gnu::always_inline]] void dispatch(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, int differences, int plain, class Consume>
  [[gnu::always_inline]] void counted_pass(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, class Consume>
  [[gnu::always_inline]] void general_pass(const RowLayout&, PackRange, Consume&) const;

  std::vector<Term> differences_, plain_;
  double constant_ = 0;
};

template <bool measured, int differences, int plain, class Consume>
inline void RowSum::counted_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const double *shifted[differences + 1], *row[plain + 1];
  const double* const own = differences > 0 ? differences_[0].own : nullptr;
  double difference_coefficient[differences + 1], coefficient[plain + 1];
  for (int i = 0; i < differences; ++i) {
    const Term& t = differences_[static_cast<std::size_t>(i)];
    shifted[i] = t.shifted, difference_coefficient[i] = t.coefficient;
  }
  for (int i = 0; i < plain; ++i) {
    const Term& t = plain_[static_cast<std::size_t>(i)];
    row[i] = t.shifted, coefficient[i] = t.coefficient;
  }
  const Pack constant(constant_);
  const std::ptrdiff_t end = layout.at(packs.last), by = static_cast<std::ptrdiff_t>(packs.stride) * lanes;
  for (std::ptrdiff_t at = layout.at(packs.first); at < end; at += by) {
    Pack sum = constant, absolute(0.0);
    const Pack here = differences > 0 ? Pack::load(own + at) : constant;
    for (int i = 0; i < differences; ++i) {
      const Pack difference = Pack::load(shifted[i] + at) - here;
      sum += difference_coefficient[i] * difference;
      if constexpr (measured) absolute += std::abs(difference_coefficient[i]) * abs(difference);
    }
    for (int i = 0; i < plain; ++i) {
      const Pack value = Pack::load(row[i] + at);
      sum += coefficient[i] * value;
      if constexpr (measured) absolute += std::abs(coefficient[i]) * abs(value);
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
template <bool measured, class Consume>
inline void RowSum::dispatch(const RowLayout& layout, PackRange packs, Consume& consume) const {
  const auto counted = [&]<int differences>() __attribute__((always_inline)) {
    switch (plain_.size()) {
      case 0:
        return counted_pass<measured, differences, 0>(layout, packs, consume);
      case 1:
        return counted_pass<measured, differences, 1>(layout, packs, consume);
      case 2:
        return counted_pass<measured, differences, 2>(layout, packs, consume);
      case 3:
        return counted_pass<measured, differences, 3>(layout, packs, consume);
      case 4:
        return counted_pass<measured, differences, 4>(layout, packs, consume);
      case 5:
        return counted_pass<measured, differences, 5>(layout, packs, consume);
      case 6:
        return counted_pass<measured, differences, 6>(layout, packs, consume);
      case 7:
        return counted_pass<measured, differences, 7>(layout, packs, consume);
      case 8:
        return counted_pass<measured, differences, 8>(layout, packs, consume);
    }
    if constexpr (measured) {  // the unknown row's terms too
      if (plain_.size() == 9) counted_pass<true, differences, 9>(layout, packs, consume);
      if (plain_.size() == 10) counted_pass<true, differences, 10>(layout, packs, consume);
      if (plain_.size() == 11) counted_pass<true, differences, 11>(layout, packs, consume);
    }
  };
  constexpr std::size_t most_plain = measured ? 11 : 8;
  if (differences_.empty() && plain_.size() <= most_plain) counted.template operator()<0>();
  else if (differences_.size() == 2 && differences_[0].own == differences_[1].own && plain_.size() <= most_plain)
    counted.template operator()<2>();
  else general_pass<measured>(layout, packs, consume);
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

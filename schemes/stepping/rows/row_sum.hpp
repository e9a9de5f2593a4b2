// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <type_traits>
#include <utility>
#include <vector>

#include "schemes/stepping/rows/row_layout.hpp"

namespace delf {

/// A sum over shifted rows, with coefficients and shifts that are known at set-up and rows that change from step to
/// step:
///
///     constant + Σ coefficient · (row(shifted) − row) + Σ coefficient · row(shifted)
///              + Σ coefficient · (row(shifted) − before(shifted))
///
/// of differences, plain terms, and changes.
/// A pass hands every pack's sum to `consume(at, sum)`, so that what is done with it needs no pass of its own. Like
/// std::for_each it works with a copy of `consume` and returns it: what that carries along stays in registers.
class RowSum {
 public:
  /// What sums are taken of: rows, and which packs take the other sum where two take turns, v where v + `phase` is odd.
  struct Rows {
    const double* const* row = nullptr;
    int phase = 0;
  };

  /// `row` is an index into Rows::row; `shift` in sites.
  void add_difference(int row, int shift, double coefficient) {
    differences_.insert(shift > 0 ? differences_.begin() : differences_.end(), {row, shift, coefficient, row});
    find_form();
  }
  void add(int row, int shift, double coefficient) {
    plain_.push_back({row, shift, coefficient, row});
    find_form();
  }
  /// Of the row since `before`.
  void add_change(int row, int before, int shift, double coefficient) {
    changes_.push_back({row, shift, coefficient, before, shift});
    find_form();
  }
  void add_constant(double c) { constant_ += c; }
  /// Multiplies every coefficient.
  void scale(double factor);

  /// Sums are taken of what stands there when a pass begins.
  void bind(const Rows& rows) { rows_ = &rows; }

  /// Every second pack takes the other sum, as bricks do. That has all its terms, and is bound too.
  void take_turns_with(const RowSum& other) {
    other_ = &other;
    find_form();
  }

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
    int from, from_shift = 0;
  };
  const double* row(int r) const { return rows_->row[r]; }
  /// The row from `shift` sites further on, and what it is less.
  const double* shifted(const Term& t) const { return row(t.row) + static_cast<std::ptrdiff_t>(t.shift) * lanes; }
  const double* subtracted(const Term& t) const {
    return row(t.from) + static_cast<std::ptrdiff_t>(t.from_shift) * lanes;
  }
  const RowSum& of(int pack) const { return other_ && (pack + rows_->phase) % 2 != 0 ? *other_ : *this; }
  /// Differences are those to the sites on either side, the next one first.
  bool are_to_both_sides() const {
    return differences_.size() == 2 && differences_[0].row == differences_[1].row &&
           differences_[0].shift == 1 && differences_[1].shift == -1;
  }
  /// Changes are those of one row at a site, or at it and on either side of it.
  bool are_around_site() const {
    const auto is_there = [this](int shift) {
      for (const Term& t : changes_)
        if (t.shift == shift && t.row == changes_[0].row && t.from == changes_[0].from) return true;
      return false;
    };
    return changes_.empty() || (changes_.size() == 1 && is_there(0)) ||
           (changes_.size() == 3 && is_there(-1) && is_there(0) && is_there(1));
  }
  /// The other sum has as many terms of each kind, its differences and changes of the same rows and at the same sites.
  bool are_like(const RowSum& other) const {
    return plain_.size() == other.plain_.size() && are_to_both_sides() && other.are_to_both_sides() &&
           differences_[0].row == other.differences_[0].row && changes_.size() == other.changes_.size() &&
           other.are_around_site() &&
           (changes_.empty() || (changes_[0].row == other.changes_[0].row && changes_[0].from == other.changes_[0].from));
  }
  /// What is as far to either side has one coefficient, and so have all plain terms.
  bool is_even() const {
    for (const Term& t : plain_)
      if (t.coefficient != plain_[0].coefficient) return false;
    for (const Term& t : changes_)
      for (const Term& u : changes_)
        if (t.shift == -u.shift && t.coefficient != u.coefficient) return false;
    return differences_.size() != 2 || differences_[0].coefficient == differences_[1].coefficient;
  }
  /// Plain terms are those of rows at a site and at the one before it, as outputs of cells on either side are.
  bool are_pairs() const {
    const auto there = [this](int row, int shift) {
      return std::ranges::count_if(plain_, [=](const Term& t) { return t.row == row && t.shift == shift; }) == 1;
    };
    return !plain_.empty() && !other_ &&
           std::ranges::all_of(plain_, [&](const Term& t) { return there(t.row, 0) && there(t.row, -1); });
  }
  /// What coefficients and terms allow a pass to add before it multiplies.
  enum class Alike { no, even, pairs };
  /// Of sums that take turns, fewer terms are compiled; and fewer in steps where terms are alike.
  static constexpr int most_plain = 8, most_in_turn = 3, most_alike = 4, general = -1;
  /// Compiled passes by number: without differences, with them, and in turn, each by the number of plain terms.
  static constexpr int with_differences = most_plain + 1, in_turn = 2 * with_differences, forms = in_turn + most_in_turn + 1;
  /// Found once, not by every pass: a dozen of these questions take as long as a pack.
  void find_form() {
    const int plain = static_cast<int>(plain_.size());
    form_ = general;
    const bool even = is_even() && (!other_ || other_->is_even());
    alike_ = !even ? Alike::no : are_pairs() ? Alike::pairs : Alike::even;
    adds_first_ = even && !differences_.empty() && plain <= most_alike;
    if (!are_around_site()) return;
    if (other_) {
      if (plain <= most_in_turn && are_like(*other_)) form_ = in_turn + plain;
    } else if (plain <= most_plain && (differences_.empty() || are_to_both_sides())) {
      form_ = (differences_.empty() ? 0 : with_differences) + plain;
    }
  }
  /// The terms of a counted pass, as a pass keeps them.
  template <int differences, int plain, int changes, bool in_pairs>
  struct Counted;
  // Inlined where they are used: what `consume` carries would else be copied through memory.
  template <bool measured, class Consume>
  [[gnu::always_inline]] void dispatch(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, Alike alike, int changes, class Consume>
  [[gnu::always_inline]] void dispatch_counted(const RowLayout&, PackRange, Consume&) const;
  template <bool measured, Alike alike, bool takes_turns, int differences, int plain, int changes, class Consume>
  [[gnu::always_inline]] void counted_pass(const RowLayout&, PackRange, Consume&) const;
  /// A function of its own: one function with as many loops as there are forms takes the compilers of sanitizers minutes.
  /// It works with a copy of `consume`, where that can be put back.
  template <Alike alike, bool takes_turns, int differences, int plain, int changes, class Consume>
  [[gnu::noinline]] void measured_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
    if constexpr (std::is_copy_assignable_v<Consume>) {
      Consume own = consume;
      counted_pass<true, alike, takes_turns, differences, plain, changes>(layout, packs, own);
      consume = own;
    } else {
      counted_pass<true, alike, takes_turns, differences, plain, changes>(layout, packs, consume);
    }
  }
  template <bool measured, class Consume>
  [[gnu::always_inline]] void general_pass(const RowLayout&, PackRange, Consume&) const;

  std::vector<Term> differences_, plain_, changes_;
  const Rows* rows_ = nullptr;
  double constant_ = 0;
  const RowSum* other_ = nullptr;
  int form_ = 0;
  Alike alike_ = Alike::no;
  bool adds_first_ = false;  ///< in a step too
};

/// None or two differences: those to the next pack and to the one before it. Either is then the other's of the pack
/// before: one subtraction for both. None, one or three changes, which go on to the next pack in the same way. Of pairs
/// the rows alone, and their sum goes on.
template <int differences, int plain, int changes, bool in_pairs>
struct RowSum::Counted {
  const double* row[plain + 1];
  double coefficient[plain + 1];
  double of_next = 0, of_last = 0;
  double of_change[3] = {0, 0, 0};  ///< of the last pack, here, and of the next one
  Pack constant;

  [[gnu::always_inline]] explicit Counted(const RowSum& sum) : constant(sum.constant_) {
    for (int i = 0, next = 0; i < plain; ++i) {
      const Term& t = sum.plain_[static_cast<std::size_t>(i)];
      if (in_pairs && t.shift != 0) continue;
      const double* shifted = sum.shifted(t);
      // Hidden from compilers, which would find one row from another, and have too many registers to keep.
      asm("" : "+r"(shifted));
      row[next] = shifted, coefficient[next] = t.coefficient;
      ++next;
    }
    if constexpr (differences > 0) {
      of_next = sum.differences_[0].coefficient, of_last = sum.differences_[1].coefficient;
    }
    for (int i = 0; i < changes; ++i) {
      const Term& t = sum.changes_[static_cast<std::size_t>(i)];
      of_change[t.shift + 1] = t.coefficient;
    }
  }
};

/// `takes_turns`: with the other sum, which is like this one. Packs follow each other.
template <bool measured, RowSum::Alike alike, bool takes_turns, int differences, int plain, int changes, class Consume>
inline void RowSum::counted_pass(const RowLayout& layout, PackRange packs, Consume& consume) const {
  constexpr bool even = alike != Alike::no, in_pairs = alike == Alike::pairs && plain > 0;
  using Terms = Counted<differences, plain, changes, in_pairs>;
  const bool other_first = takes_turns && (packs.first + rows_->phase) % 2 != 0;
  const Terms first(other_first ? *other_ : *this);
  std::ptrdiff_t at = layout.at(packs.first);
  const std::ptrdiff_t end = layout.at(packs.last);
  const double* const here = differences > 0 ? row(differences_[0].row) : nullptr;
  Pack value = differences > 0 ? Pack::load(here + at) : Pack(0.0);
  Pack last = differences > 0 ? value - Pack::load(here + at - lanes) : Pack(0.0), last_size = abs(last);
  const double* const changed = changes > 0 ? row(changes_[0].row) : nullptr;
  const double* const before = changes > 0 ? row(changes_[0].from) : nullptr;
  const auto change_at = [=](std::ptrdiff_t to) __attribute__((always_inline)) {
    return Pack::load(changed + to) - Pack::load(before + to);
  };
  Pack last_change = changes == 3 ? change_at(at - lanes) : Pack(0.0);
  Pack change = changes == 3 ? change_at(at) : Pack(0.0);
  Pack last_change_size = abs(last_change), change_size = abs(change);
  // Of rows at a site: their sum, and the sum of their sizes. The next pack adds them to its own.
  const auto pairs_at = [](const Terms& terms, std::ptrdiff_t to, Pack& all, Pack& size) __attribute__((always_inline)) {
    all = Pack::load(terms.row[0] + to), size = abs(all);
    for (int i = 1; i < plain / 2; ++i) {
      const Pack term = Pack::load(terms.row[i] + to);
      all += term, size += abs(term);
    }
  };
  Pack last_pairs(0.0), last_pairs_size(0.0);
  if constexpr (in_pairs) pairs_at(first, at - lanes, last_pairs, last_pairs_size);
  const auto take = [&](const Terms& terms) __attribute__((always_inline)) {
    Pack sum = terms.constant, absolute(0.0);
    const auto add = [&](double coefficient, Pack term, Pack size) __attribute__((always_inline)) {
      sum += coefficient * term;
      if constexpr (measured) absolute += std::abs(coefficient) * size;
    };
    if constexpr (differences > 0) {
      const Pack next_value = Pack::load(here + at + lanes), next = next_value - value, next_size = abs(next);
      if constexpr (even) {
        add(terms.of_next, next - last, next_size + last_size);
      } else {
        add(terms.of_next, next, next_size);
        add(-terms.of_last, last, last_size);
      }
      value = next_value, last = next, last_size = next_size;
    }
    if constexpr (in_pairs) {
      Pack pairs, pairs_size;
      pairs_at(terms, at, pairs, pairs_size);
      add(terms.coefficient[0], pairs + last_pairs, pairs_size + last_pairs_size);
      last_pairs = pairs, last_pairs_size = pairs_size;
    } else if constexpr (even && plain > 0) {
      Pack all = Pack::load(terms.row[0] + at), size = abs(all);
      for (int i = 1; i < plain; ++i) {
        const Pack term = Pack::load(terms.row[i] + at);
        all += term, size += abs(term);
      }
      add(terms.coefficient[0], all, size);
    } else {
      for (int i = 0; i < plain; ++i) {
        const Pack term = Pack::load(terms.row[i] + at);
        add(terms.coefficient[i], term, abs(term));
      }
    }
    if constexpr (changes == 1) {
      const Pack term = change_at(at);
      add(terms.of_change[1], term, abs(term));
    }
    if constexpr (changes == 3) {
      const Pack next = change_at(at + lanes), next_size = abs(next);
      add(terms.of_change[1], change, change_size);
      if constexpr (even) {
        add(terms.of_change[0], last_change + next, last_change_size + next_size);
      } else {
        add(terms.of_change[0], last_change, last_change_size);
        add(terms.of_change[2], next, next_size);
      }
      last_change = change, change = next;
      last_change_size = change_size, change_size = next_size;
    }
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
    at += lanes;
  };
  if constexpr (takes_turns) {
    const Terms second(other_first ? *this : *other_);
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
    for (const auto* list : {&terms.differences_, &terms.changes_})
      for (const Term& t : *list)
        add(t.coefficient * (Pack::load(terms.shifted(t) + at) - Pack::load(terms.subtracted(t) + at)));
    for (const Term& t : terms.plain_) add(t.coefficient * Pack::load(terms.shifted(t) + at));
    if constexpr (measured) consume(at, sum, absolute);
    else consume(at, sum);
  }
}

/// The numbers of terms of the usual schemes are compiled, differences being those to both sides: rows then stay in
/// registers.
template <bool measured, RowSum::Alike alike, int changes, class Consume>
inline void RowSum::dispatch_counted(const RowLayout& layout, PackRange packs, Consume& consume) const {
  [&]<int... number>(std::integer_sequence<int, number...>) __attribute__((always_inline)) {
    const auto done = [&]<int form>() __attribute__((always_inline)) {
      if (form_ != form) return false;
      constexpr bool takes_turns = form >= in_turn;
      constexpr int differences = form >= with_differences ? 2 : 0, plain = form % with_differences;
      // Pairs are of one row or two, beside differences.
      constexpr bool may_be_pairs = differences > 0 && !takes_turns && (plain == 2 || plain == 4);
      constexpr Alike here = alike == Alike::pairs && !may_be_pairs ? Alike::even : alike;
      if constexpr (!measured && alike != Alike::no && (differences == 0 || plain > most_alike)) return false;
      else if constexpr (measured) measured_pass<here, takes_turns, differences, plain, changes>(layout, packs, consume);
      else counted_pass<false, here, takes_turns, differences, plain, changes>(layout, packs, consume);
      return true;
    };
    (void)(done.template operator()<number>() || ...);
  }
  (std::make_integer_sequence<int, forms>{});
}
template <bool measured, class Consume>
inline void RowSum::dispatch(const RowLayout& layout, PackRange packs, Consume& consume) const {
  // Changes are the unknown row's, which steps do not ask for, and residuals do.
  if (form_ == general || measured == changes_.empty()) return general_pass<measured>(layout, packs, consume);
  if constexpr (!measured) {
    if (!adds_first_) dispatch_counted<false, Alike::no, 0>(layout, packs, consume);
    else if (alike_ == Alike::even) dispatch_counted<false, Alike::even, 0>(layout, packs, consume);
    else dispatch_counted<false, Alike::pairs, 0>(layout, packs, consume);
  } else {
    const auto with = [&]<int changes>() __attribute__((always_inline)) {
      if (alike_ == Alike::no) dispatch_counted<true, Alike::no, changes>(layout, packs, consume);
      else if (alike_ == Alike::even) dispatch_counted<true, Alike::even, changes>(layout, packs, consume);
      else dispatch_counted<true, Alike::pairs, changes>(layout, packs, consume);
    };
    changes_.size() == 1 ? with.template operator()<1>() : with.template operator()<3>();
  }
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

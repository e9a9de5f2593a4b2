// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>

#include "schemes/families/argument_loop.hpp"
#include "schemes/stepping/rows/largest_terms.hpp"
#include "schemes/stepping/rows/row_increment.hpp"
#include "schemes/families/row_kernel.hpp"

namespace delf {

/// The highest number of past rows that an argument is extrapolated from in a loop of division.
inline constexpr int most_past_rows_divided = 5;

/// What a loop of division looks at in rows of arguments, and what it makes of w.
template <int past_rows, int parts>
class DivisionByArguments {
 public:
  static constexpr bool fetches = false, measures = false, adds_constant = true;
  DivisionByArguments(const DivisionRows& given, const RowIncrement& rows)
      : unknown_(given.arguments), known_(given.arguments.known), pass_(rows) {}
  [[gnu::always_inline]] Pack unknown(std::ptrdiff_t at) const { return unknown_(at); }
  [[gnu::always_inline]] Pack known(std::ptrdiff_t at) const { return Pack::load(known_ + at); }
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) { pass_(at, w); }
  RowChange result(const DivisionRows& given, const RowIncrement& rows) {
    return pass_.closed(*given.arguments.layout, rows);
  }

 private:
  UnknownArgument<past_rows> unknown_;
  const double* known_;
  IncrementPass<parts, Order::ascending, Look::argument> pass_;
};

/// From so many packs ahead. Processors that fetch ahead by themselves stop at the end of each page of memory: a tenth of
/// a step of the triangle at 10⁶ sites. (5.15), with a sinc beside the sine, would not gain by it.
[[gnu::always_inline]] inline void fetch_ahead(const double* row, std::ptrdiff_t at) {
  constexpr std::ptrdiff_t packs = 64;
  __builtin_prefetch(row + at + packs * lanes);
}

/// What is looked at where it has no rows of its own, of y = row, or along straight lines of y = row + v,
///
///     u(i) = Σ_p weights[p] y(i + p),        known(i) = known row(i + known_site) − known_increment v(i).
template <int parts, bool straight>
class MixtureOnTheWay {
 public:
  static constexpr bool fetches = straight && parts > 1;
  MixtureOnTheWay(const DivisionRows& given, const RowIncrement& rows, const double* row)
      : row_(row),
        v_(rows.v_before),
        known_(given.arguments.known),
        known_increment_(given.known_increment),
        weights_(rows.look.weights, 1) {
    const std::ptrdiff_t begin = given.arguments.layout->at(0);
    for (int p = 0; p + 1 < parts; ++p) ahead_.take(value(begin + p * lanes));
  }
  [[gnu::always_inline]] Pack unknown(std::ptrdiff_t at) {
    if constexpr (fetches) fetch_ahead(row_, at), fetch_ahead(v_, at);
    ahead_.take(value(at + (parts - 1) * lanes));
    return weights_.added(Pack(0.0), ahead_);
  }
  [[gnu::always_inline]] Pack known(std::ptrdiff_t at) const {
    const Pack y = Pack::load(known_ + at);
    if constexpr (parts > 1) return y;
    else return y - known_increment_ * Pack::load(v_ + at);
  }

 private:
  [[gnu::always_inline]] Pack value(std::ptrdiff_t at) const {
    if constexpr (straight) return Pack::load(row_ + at) + Pack::load(v_ + at);
    else return Pack::load(row_ + at);
  }

  const double *row_, *v_, *known_;
  double known_increment_;
  PackWeights<parts> weights_;
  LastPacks<parts> ahead_;
};

/// The step along straight lines; the new row may be written over the old one. It differs from them by w, whose largest
/// value is the change: what u changes by is no more than that times the sum of the weights.
template <int parts>
class StraightDivision : public MixtureOnTheWay<parts, true> {
 public:
  static constexpr bool measures = false, adds_constant = true;
  StraightDivision(const DivisionRows& given, const RowIncrement& rows)
      : MixtureOnTheWay<parts, true>(given, rows, rows.y_before), pass_(rows) {}
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) { pass_(at, w); }
  RowChange result(const DivisionRows& given, const RowIncrement& rows) {
    return pass_.closed(*given.arguments.layout, rows);
  }

 private:
  IncrementPass<1, Order::ascending, Look::increment> pass_;
};

/// No step: by how much the row that is there misses the w that its own outputs give, E = w − (v − v_before), in units of
/// an output. Where there is no constant a sum less is noticed.
template <int parts, bool adds>
class MeasuredDivision : public MixtureOnTheWay<parts, false> {
 public:
  static constexpr bool measures = true, adds_constant = adds;
  MeasuredDivision(const DivisionRows& given, const RowIncrement& rows)
      : MixtureOnTheWay<parts, false>(given, rows, rows.y),
        v_before_(rows.v_before),
        v_(rows.v),
        in_outputs_(1 / given.of_outputs) {}
  /// `absolute`: Σ |terms| of w.
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w, Pack absolute) {
    const Pack change = Pack::load(v_ + at) - Pack::load(v_before_ + at);
    largest_(at, w - in_outputs_ * change, absolute + std::abs(in_outputs_) * abs(change));
  }
  LargestTerms result(const DivisionRows&, const RowIncrement&) const { return largest_; }

 private:
  const double *v_before_, *v_;
  double in_outputs_;
  LargestTerms largest_;
};

/// What the outputs at a pack, or at a group of them, are evaluated at. A function, and no closure that a loop keeps: what
/// closures refer to stays in memory.
template <class P, class Output, class Division>
[[gnu::always_inline]] inline auto argument_at(const Output& output, Division& division, std::ptrdiff_t at) {
  const auto unknown = [&](std::ptrdiff_t to) __attribute__((always_inline)) { return division.unknown(to); };
  const auto known = [&](std::ptrdiff_t to) __attribute__((always_inline)) { return division.known(to); };
  return output.argument(of_packs<P>(at, unknown), of_packs<P>(at, known));
}

/// A step of DivisionRows in one loop. Outputs are evaluated side by side, at what was found a group of packs ahead, and
/// the new row is made a group after them: what waits for an output would keep the evaluation of the next ones waiting.
/// That arguments are found between the two, when the ones before are used up, leaves registers for the outputs.
///
/// Output and division are made here, number by number: what is stored through others cannot change them, so that they
/// stay in registers; copied as a whole they would wait for all that has just been stored (15 ns).
template <class Division, int old, class Output>
[[gnu::__flatten__, gnu::__noclone__]] auto division_loop(const Output& given_output, const DivisionRows& given,
                                                          const RowIncrement& rows) {
  static_assert(old == 0 || old == 2);
  const Output output = given_output.copy();
  Division division(given, rows);
  const double *const y = given.y, *const old_row = given.old_output;
  double* const out = given.output;
  // Of w, or of w / of_outputs where it is measured, for which an output counts once.
  const double unit = Division::measures ? given.of_outputs : 1;
  const double of_neighbours = given.of_neighbours / unit, of_outputs = given.of_outputs;
  const Pack constant(given.constant / unit);
  const RowLayout& layout = *given.arguments.layout;
  const std::ptrdiff_t begin = layout.at(0), end = layout.at(layout.packs());
  Pack here = Pack::load(y + begin), last = here - Pack::load(y + begin - lanes), last_size = abs(last);
  Pack last_old = old == 2 ? Pack::load(old_row + begin - lanes) : Pack(0.0), last_old_size = abs(last_old);
  const auto make = [&](std::ptrdiff_t at, Pack E) __attribute__((always_inline)) {
    if constexpr (Division::fetches) fetch_ahead(old_row, at);
    const Pack next_value = Pack::load(y + at + lanes), next = next_value - here;
    const Pack neighbours = of_neighbours * (next - last), w = Division::adds_constant ? constant + neighbours : neighbours;
    Pack outputs = E;
    if constexpr (old == 2) {
      const Pack E_old = Pack::load(old_row + at);  // before it is written over
      outputs = (E_old + last_old) + outputs;
      last_old = E_old;
    }
    if constexpr (Division::measures) {
      const Pack next_size = abs(next), old_size = abs(last_old);
      const Pack sizes = old == 2 ? (old_size + last_old_size) + abs(E) : abs(E);
      division(at, w + outputs, std::abs(of_neighbours) * (next_size + last_size) + sizes);
      last_size = next_size, last_old_size = old_size;
    } else {
      E.store(out + at);
      division(at, w + of_outputs * outputs);
    }
    here = next_value, last = next;
  };
  std::ptrdiff_t at = begin;
  if constexpr (Output::near) {
    constexpr std::ptrdiff_t group = NearPacks::count * lanes;
    if (at + group <= end) {
      auto found = argument_at<NearPacks>(output, division, at);
      NearPacks ready = output(found, at);
      at += group;
      if (at + group <= end) found = argument_at<NearPacks>(output, division, at);
      const auto go_on = [&]<bool finds_more>() __attribute__((always_inline)) {
        const NearPacks E = output(found, at);
        if constexpr (finds_more) found = argument_at<NearPacks>(output, division, at + group);
        for_each_pack(ready, at - group, make);
        ready = E;
        at += group;
      };
      while (at + 2 * group <= end) go_on.template operator()<true>();
      if (at + group <= end) go_on.template operator()<false>();
      for_each_pack(ready, at - group, make);
    }
  }
  for (; at < end; at += lanes) make(at, output(argument_at<Pack>(output, division, at), at));
  if constexpr (!Division::measures) layout.fill_halo(out, given.arguments.read_before, given.arguments.read_after);
  return division.result(given, rows);
}

/// The loop for so many past rows, none or 2 … most.
template <int old, int parts, class Output>
RowChange division_loop_for(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  RowChange all;
  with_past_rows<most_past_rows_divided>(given.arguments.past_rows, [&]<int past_rows>() {
    all = division_loop<DivisionByArguments<past_rows, parts>, old>(output, given, rows);
  });
  return all;
}
template <int old, int parts, class Output>
RowChange straight_division_loop(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  return division_loop<StraightDivision<parts>, old>(output, given, rows);
}
/// Of E' where the row stands; no row is made.
template <int old, int parts, class Output>
LargestTerms measured_division_loop(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  if (given.constant != 0) return division_loop<MeasuredDivision<parts, true>, old>(output, given, rows);
  return division_loop<MeasuredDivision<parts, false>, old>(output, given, rows);
}

}  // namespace delf

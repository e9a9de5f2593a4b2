// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/argument_loop.hpp"
#include "schemes/row_increment.hpp"
#include "schemes/row_kernel.hpp"

namespace delf {

/// The highest number of past rows that an argument is extrapolated from in a loop of division.
inline constexpr int most_past_rows_divided = 5;

/// What a loop of division looks at in rows of arguments, and what it makes of w.
template <int past_rows, int parts>
class DivisionByArguments {
 public:
  static constexpr bool finds_ahead = parts == 1, fetches = false;
  DivisionByArguments(const DivisionRows& given, const RowIncrement& rows)
      : unknown_(given.arguments), known_(given.arguments.known), pass_(rows) {}
  [[gnu::always_inline]] Pack unknown(std::ptrdiff_t at) const { return unknown_(at); }
  [[gnu::always_inline]] Pack known(std::ptrdiff_t at) const { return Pack::load(known_ + at); }
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) { pass_(at, w); }
  RowChange closed(const DivisionRows& given, const RowIncrement& rows) {
    return pass_.closed(*given.arguments.layout, rows);
  }

 private:
  UnknownArgument<past_rows> unknown_;
  const double* known_;
  IncrementPass<parts, Order::ascending, Look::argument> pass_;
};

/// From so many packs ahead. Processors that fetch ahead by themselves stop at the end of each page of memory: a tenth of a
/// step of the triangle at 10⁶ sites. (5.15), which writes its rows beside the old ones, would lose by it.
[[gnu::always_inline]] inline void fetch_ahead(const double* row, std::ptrdiff_t at) {
  constexpr std::ptrdiff_t packs = 64;
  __builtin_prefetch(row + at + packs * lanes);
}

/// The same where the argument is that of straight lines in time, with no rows of its own,
///
///     u(i) = Σ_p weights[p] (y + v)(i + p),        known(i) = y(i + known_site) − known_increment v(i),
///
/// and the new row may be written over the old one. It differs from the straight line by w, whose largest value is the
/// change: what u changes by is no more than that times the sum of the weights.
template <int parts>
class StraightDivision {
 public:
  static constexpr bool finds_ahead = true, fetches = parts > 1;
  StraightDivision(const DivisionRows& given, const RowIncrement& rows)
      : y_(rows.y_before),
        v_(rows.v_before),
        known_(given.arguments.known),
        known_increment_(given.known_increment),
        pass_(rows),
        weights_(rows.look.weights, 1) {
    const std::ptrdiff_t begin = given.arguments.layout->at(0);
    for (int p = 0; p + 1 < parts; ++p) ahead_.take(straight(begin + p * lanes));
  }
  [[gnu::always_inline]] Pack unknown(std::ptrdiff_t at) {
    if constexpr (fetches) fetch_ahead(y_, at), fetch_ahead(v_, at);
    ahead_.take(straight(at + (parts - 1) * lanes));
    return weights_.added(Pack(0.0), ahead_);
  }
  [[gnu::always_inline]] Pack known(std::ptrdiff_t at) const {
    const Pack y = Pack::load(known_ + at);
    if constexpr (parts > 1) return y;
    else return y - known_increment_ * Pack::load(v_ + at);
  }
  [[gnu::always_inline]] void operator()(std::ptrdiff_t at, Pack w) { pass_(at, w); }
  RowChange closed(const DivisionRows& given, const RowIncrement& rows) {
    return pass_.closed(*given.arguments.layout, rows);
  }

 private:
  [[gnu::always_inline]] Pack straight(std::ptrdiff_t at) const { return Pack::load(y_ + at) + Pack::load(v_ + at); }

  const double *y_, *v_, *known_;
  double known_increment_;
  IncrementPass<1, Order::ascending, Look::increment> pass_;
  PackWeights<parts> weights_;
  LastPacks<parts> ahead_;
};

/// A step of DivisionRows in one loop. The new row is made one pack after its outputs: what waits for an output would
/// keep the evaluation of the next ones waiting. Arguments are found one pack ahead where a tenth is gained by it; there
/// are registers enough for that in some of these loops only.
template <int old, int parts, class Output, class Division>
[[gnu::__flatten__]] void division_loop(const Output& given_output, const DivisionRows& given,
                                        Division& given_division) {
  static_assert(old == 0 || old == 2);
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const Output output = given_output;
  Division division = given_division;
  const double *const y = given.y, *const old_row = given.old_output;
  double* const out = given.output;
  const double of_neighbours = given.of_neighbours, of_outputs = given.of_outputs;
  const Pack constant(given.constant);
  const RowLayout& layout = *given.arguments.layout;
  const std::ptrdiff_t begin = layout.at(0);
  Pack here = Pack::load(y + begin), last = here - Pack::load(y + begin - lanes);
  Pack last_old = old == 2 ? Pack::load(old_row + begin - lanes) : Pack(0.0);
  struct Evaluated {
    Pack E, E_old;
  };
  using Argument = decltype(output.argument(Pack(), Pack()));
  const auto find = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    return output.argument(division.unknown(at), division.known(at));
  };
  const auto evaluate = [&](std::ptrdiff_t at, const Argument& found) __attribute__((always_inline)) {
    if constexpr (Division::fetches) fetch_ahead(old_row, at);
    Evaluated e;
    e.E = output(found, at);
    e.E_old = old == 2 ? Pack::load(old_row + at) : Pack(0.0);  // before it is written over
    e.E.store(out + at);
    return e;
  };
  const auto make = [&](std::ptrdiff_t at, const Evaluated& e) __attribute__((always_inline)) {
    const Pack next_value = Pack::load(y + at + lanes), next = next_value - here;
    const Pack w = constant + of_neighbours * (next - last);
    here = next_value, last = next;
    Pack outputs = e.E;
    if constexpr (old == 2) outputs = (e.E_old + last_old) + outputs;
    last_old = e.E_old;
    division(at, w + of_outputs * outputs);
  };
  const std::ptrdiff_t end = layout.at(layout.packs());
  Evaluated ready = evaluate(begin, find(begin));
  std::ptrdiff_t ahead = begin + lanes;
  Argument found{};
  if (Division::finds_ahead && ahead < end) found = find(ahead);
  for (; ahead < end; ahead += lanes) {
    const Argument sought = Division::finds_ahead ? found : find(ahead);
    if (Division::finds_ahead && ahead + lanes < end) found = find(ahead + lanes);
    const Evaluated next = evaluate(ahead, sought);
    make(ahead - lanes, ready);
    ready = next;
  }
  make(ahead - lanes, ready);
  layout.fill_halo(out, given.arguments.read_before, given.arguments.read_after);
  given_division = division;
}

/// The loop for so many past rows, none or 2 … most.
template <int old, int parts, class Output>
RowChange division_loop_for(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  RowChange all;
  with_past_rows<most_past_rows_divided>(given.arguments.past_rows, [&]<int past_rows>() {
    DivisionByArguments<past_rows, parts> division(given, rows);
    division_loop<old, parts>(output, given, division);
    all = division.closed(given, rows);
  });
  return all;
}
template <int old, int parts, class Output>
RowChange straight_division_loop(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  StraightDivision<parts> division(given, rows);
  division_loop<old, parts>(output, given, division);
  return division.closed(given, rows);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include "schemes/argument_loop.hpp"
#include "schemes/row_increment.hpp"
#include "schemes/row_kernel.hpp"

namespace delf {

/// The highest number of past rows that an argument is extrapolated from in a DivisionRows' loop.
inline constexpr int most_past_rows_divided = 7;

/// A step of DivisionRows in one loop. The new row is made one pack after its outputs: what waits for an output would keep
/// the evaluation of the next ones waiting.
template <int past_rows, int old, int parts, class Output>
[[gnu::flatten]] RowChange division_loop(const Output& given_output, const DivisionRows& given,
                                         const RowIncrement& rows) {
  // Copies of this function alone: what is stored through others cannot change them, so that they stay in registers.
  const Output output = given_output;
  IncrementPass<parts, Order::ascending, Look::argument> pass(rows);
  const UnknownArgument<past_rows> found(given.arguments);
  const double *const known = given.arguments.known, *const y = given.y, *const old_row = given.old_output;
  double* const out = given.output;
  const double before = given.before, after = given.after, of_output = given.of_output, of_old = given.of_old[0],
               of_old_before = given.of_old[1];
  const Pack constant(given.constant);
  const RowLayout& layout = *given.arguments.layout;
  const std::ptrdiff_t begin = layout.at(0);
  Pack here = Pack::load(y + begin), last = here - Pack::load(y + begin - lanes);
  Pack last_old = old > 1 ? Pack::load(old_row + begin - lanes) : Pack(0.0);
  const auto evaluate = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    const Pack E = output(found(at), Pack::load(known + at), at);
    E.store(out + at);
    return E;
  };
  const auto make = [&](std::ptrdiff_t at, Pack E) __attribute__((always_inline)) {
    const Pack next_value = Pack::load(y + at + lanes), next = next_value - here;
    Pack w = constant + after * next;
    w -= before * last;
    here = next_value, last = next;
    if constexpr (old > 0) {
      const Pack value = Pack::load(old_row + at);
      w += of_old * value;
      if constexpr (old > 1) w += of_old_before * last_old;
      last_old = value;
    }
    pass(at, w + of_output * E);
  };
  Pack E = evaluate(begin);
  std::ptrdiff_t ahead = begin + lanes;
  const auto until = [&](int packs) __attribute__((always_inline)) {
    for (const std::ptrdiff_t end = layout.at(packs); ahead < end; ahead += lanes) {
      const Pack E_next = evaluate(ahead);
      make(ahead - lanes, E);
      E = E_next;
    }
  };
  if constexpr (parts > 1) {
    until(parts);
    pass.forget_change();  // the first packs had nothing to be looked at with
  }
  until(layout.packs());
  make(ahead - lanes, E);
  return pass.result();
}

/// The loop for so many past rows, none or 2 … most.
template <int old, int parts, class Output>
RowChange division_loop_for(const Output& output, const DivisionRows& given, const RowIncrement& rows) {
  RowChange all;
  with_past_rows<most_past_rows_divided>(given.arguments.past_rows, [&]<int past_rows>() {
    all = division_loop<past_rows, old, parts>(output, given, rows);
  });
  return all;
}

}  // namespace delf

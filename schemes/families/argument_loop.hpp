// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <type_traits>
#include <utility>

#include "schemes/stepping/rows/extrapolation.hpp"
#include "schemes/families/row_kernel.hpp"
#include "schemes/families/value_jet.hpp"

namespace delf {

/// The newest `count` rows, or none. One member each: arrays would go through memory.
template <int count>
class PastRows {
 public:
  explicit PastRows(const double* const* past) : newer_(past), row_(past[count - 1]) {}
  /// That so many rows before the unknown one, 1 … count.
  template <int back>
  [[gnu::always_inline]] Pack row(std::ptrdiff_t at) const {
    if constexpr (back == count) return Pack::load(row_ + at);
    else return newer_.template row<back>(at);
  }

 private:
  PastRows<count - 1> newer_;
  const double* row_;
};
template <>
class PastRows<0> {
 public:
  explicit PastRows(const double* const*) {}
};

/// u_{n+1} = Σ_{j=1}^{count} (−1)^{j+1} C(count, j) u_{n+1−j}. Rows j and count − j have the same binomial: they are added
/// before they are multiplied, and the oldest row is not.
template <int count>
[[gnu::always_inline]] inline Pack extrapolated(const PastRows<count>& rows, std::ptrdiff_t at) {
  const Pack oldest = rows.template row<count>(at);
  Pack sum = count % 2 == 0 ? -oldest : oldest;
  [&]<int... before>(std::integer_sequence<int, before...>) __attribute__((always_inline)) {
    const auto add = [&]<int j>() __attribute__((always_inline)) {
      Pack term = rows.template row<j>(at);
      if constexpr (2 * j < count) {
        const Pack other = rows.template row<count - j>(at);
        term = count % 2 == 0 ? term + other : term - other;
      }
      sum += extrapolation_weight(count, j) * term;
    };
    (add.template operator()<count / 2 - before>(), ...);
  }
  (std::make_integer_sequence<int, count / 2>{});
  return sum;
}

/// The unknown part u of arguments, pack by pack: as it stands, or extrapolated from so many rows, and put there.
template <int past_rows>
class UnknownArgument {
 public:
  explicit UnknownArgument(const ArgumentRow& given) : unknown_(given.unknown), past_(given.past) {}
  [[gnu::always_inline]] Pack operator()(std::ptrdiff_t at) const {
    if constexpr (past_rows == 0) {
      return Pack::load(unknown_ + at);
    } else {
      const Pack u = extrapolated(past_, at);
      u.store(unknown_ + at);
      return u;
    }
  }

 private:
  double* unknown_;
  PastRows<past_rows> past_;
};

/// `run` with past_rows, none or 2 … most, as a constant.
template <int most, class Run>
[[gnu::always_inline]] inline void with_past_rows(int past_rows, const Run& run) {
  [&]<int... j>(std::integer_sequence<int, j...>) __attribute__((always_inline)) {
    constexpr auto rows = [](int i) { return i == 0 ? 0 : i + 1; };
    ((past_rows == rows(j) ? run.template operator()<rows(j)>() : void()), ...);
  }
  (std::make_integer_sequence<int, most>{});
}

/// Fetches the rows of SlabRows::ahead, so many packs at a time; where none is wanted, one that is in the cache anyway.
template <int packs = 1>
class FetchAhead {
 public:
  explicit FetchAhead(const SlabRows& rows) {
    for (std::size_t r = 0; r < rows_.size(); ++r) rows_[r] = rows.ahead[r] ? rows.ahead[r] : rows.values[0];
  }
  [[gnu::always_inline]] void fetch(std::ptrdiff_t at) const {
    for (const double* row : rows_)  // into the second level: they are a strip
      for (int v = 0; v < packs; ++v) __builtin_prefetch(row + at + v * lanes, 0, 2);
  }

 private:
  decltype(SlabRows::ahead) rows_;
};

/// evaluate(at, find(at)) from pack to pack. What is evaluated is found two packs ahead: evaluations that wait for theirs
/// would keep others waiting. At the end the last one is found again.
template <class Find, class Evaluate>
[[gnu::always_inline]] inline void find_ahead(std::ptrdiff_t at, std::ptrdiff_t end, std::ptrdiff_t by,
                                              const Find& find, const Evaluate& evaluate) {
  if (at >= end) return;
  const std::ptrdiff_t last = at + (end - at - 1) / by * by;
  auto here = find(at), next = find(std::min(at + by, last));
  for (; at < end; at += by) {
    const auto ahead = find(std::min(at + 2 * by, last));
    evaluate(at, here);
    here = next, next = ahead;
  }
}

/// The same for a row of a circle, from its last two packs on: they are what stands before its first one, from which
/// what follows may then begin while the others are still under way.
template <class Find, class Evaluate>
[[gnu::always_inline]] inline void find_ahead_around(std::ptrdiff_t first, std::ptrdiff_t end, std::ptrdiff_t by,
                                                     const Find& find, const Evaluate& evaluate) {
  const std::ptrdiff_t around = (end - first + by - 1) / by * by;
  if (around <= by) return find_ahead(first, end, by, find, evaluate);
  auto here = find(first + around - 2 * by), next = find(first + around - by);
  for (std::ptrdiff_t at = first - 2 * by; at < first + around - 2 * by; at += by) {
    const auto ahead = find(at + 2 * by);
    evaluate(at < first ? at + around : at, here);
    here = next, next = ahead;
  }
}

/// out = output(output.argument(u, known), at) for the packs of a row of arguments: where u is extrapolated, that is done
/// while the output is worked out. `make_output` makes it here: what is stored through others cannot change it then, so
/// that it stays in registers.
template <int past_rows, int stride, class Make>
[[gnu::__flatten__, gnu::__noclone__]] void argument_loop(const Make& make_output, const ArgumentRow& given,
                                                          double* out, const PackRange& packs) {
  const auto output = make_output();
  const UnknownArgument<past_rows> found(given);
  const double* const known = given.known;
  const auto find = [&](std::ptrdiff_t at) __attribute__((always_inline)) {
    return output.argument(found(at), Pack::load(known + at));
  };
  // Where bricks are missing, packs in between are extrapolated too: steps compare u everywhere.
  const std::ptrdiff_t between = packs.first % 2 == 0 ? lanes : -lanes;
  find_ahead_around(
      given.layout->at(packs.first), given.layout->at(packs.last), stride * lanes,
      find, [&](std::ptrdiff_t at, const auto& argument) __attribute__((always_inline)) {
        if constexpr (stride == 2 && past_rows > 0) found(at + between);
        output(argument, at).store(out + at);
      });
  given.layout->fill_halo(out, given.read_before, given.read_after);
}

/// `make_output` makes an output of NearPacks or of Packs: `make_output.template operator()<Value>()`.
template <int stride, class Make>
[[gnu::always_inline]] inline void argument_loop_for(const Make& make_output, const ArgumentRow& row, double* out,
                                                     const PackRange& packs) {
  const auto of_near = [&] { return make_output.template operator()<NearPack>(); };
  const auto of_any = [&] { return make_output.template operator()<Pack>(); };
  if (!row.near) return argument_loop<0, stride>(of_any, row, out, packs);
  with_past_rows<ArgumentRow::most_past_rows>(
      row.past_rows, [&]<int past_rows>() { argument_loop<past_rows, stride>(of_near, row, out, packs); });
}

/// ∂ℓ/∂φ at the mixture m = u + known_weight · known, of a Pack or of NearPacks; t, and x from the anchor's, are those of
/// the arguments.
template <Density D, class Value = Pack>
struct MixtureSlope {
  static constexpr bool near = std::is_same_v<Value, NearPack>;
  D density;
  double known_weight, t;
  const double* positions;
  double x_offset;

  /// Member by member (division_loop() says why).
  [[gnu::always_inline]] MixtureSlope copy() const { return {density, known_weight, t, positions, x_offset}; }
  template <class P>
  [[gnu::always_inline]] P argument(const P& u, const P& known) const {
    return u + known_weight * known;
  }
  template <class P>
  [[gnu::always_inline]] P operator()(const P& m, std::ptrdiff_t at) const {
    using Number = std::conditional_t<std::is_same_v<P, NearPacks>, NearPacks, Value>;
    const auto phi = [&m](int) __attribute__((always_inline)) { return m; };
    return density(value_jet<D, Number>(phi, Pack(t), positions + at, x_offset)).derivative(0);
  }
};

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <tuple>
#include <utility>

#include "tools/peers/row.hpp"

namespace delf::peers {

/// odeint's arithmetic of states on rows, a pack at a time: its operations see packs where they saw numbers.
struct PackAlgebra {
#define DELF_FOR_EACH(n)                               \
  template <class... RowsAndOperation>                 \
  static void for_each##n(RowsAndOperation&&... all) { \
    static_assert(sizeof...(all) == n + 1);            \
    over_packs(std::make_index_sequence<n>(), all...); \
  }
  DELF_FOR_EACH(2)
  DELF_FOR_EACH(3)
  DELF_FOR_EACH(4)
  DELF_FOR_EACH(5)
  DELF_FOR_EACH(6)
  DELF_FOR_EACH(7)
  DELF_FOR_EACH(8)
  DELF_FOR_EACH(9)
  DELF_FOR_EACH(10)
  DELF_FOR_EACH(11)
  DELF_FOR_EACH(12)
  DELF_FOR_EACH(13)
  DELF_FOR_EACH(14)
  DELF_FOR_EACH(15)
#undef DELF_FOR_EACH

 private:
  // Operations assign to the first and read the others.
  template <std::size_t... others, class First, class... Rest>
  static void over_packs(std::index_sequence<0, others...>, First& first, Rest&... rest) {
    const auto arguments = std::tie(rest...);
    const auto operation = std::get<sizeof...(others)>(arguments);
    double* const y = first.data();
    const std::size_t size = first.size();
    const double* const read[] = {std::get<others - 1>(arguments).data()...};
    for (std::size_t i = 0; i != size; i += lanes) {
      Pack result;
      operation(result, Pack::load(read[others - 1] + i)...);
      result.store(y + i);
    }
  }
};

}  // namespace delf::peers

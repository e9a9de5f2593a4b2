// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>

namespace delf {

/// The index of an element, or a number of elements, which is not negative: containers count in std::size_t.
template <class Integer>
constexpr std::size_t at(Integer i) {
  return static_cast<std::size_t>(i);
}

}  // namespace delf

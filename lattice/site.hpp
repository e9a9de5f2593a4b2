// SPDX-License-Identifier: MIT
#pragma once
#include <compare>

namespace delf {

/// A site of spacetime, or an offset between two. The paper writes (i, j) = (space, time); this is the one place where
/// an order is chosen: time first.
struct Site {
  int time = 0, space = 0;

  friend constexpr auto operator<=>(const Site&, const Site&) = default;
  friend constexpr Site operator+(Site a, Site b) { return {a.time + b.time, a.space + b.space}; }
  friend constexpr Site operator-(Site a, Site b) { return {a.time - b.time, a.space - b.space}; }
};

}  // namespace delf

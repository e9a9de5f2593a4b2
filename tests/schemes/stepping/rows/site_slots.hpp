// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <numeric>
#include <set>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "tests/catch.hpp"

namespace delf::testing {

/// 0, 1, … sites − 1.
inline std::vector<double> numbered(int sites) {
  std::vector<double> values(sites);
  std::iota(values.begin(), values.end(), 0.0);
  return values;
}

/// Checks that each of N sites has its slot, alone in the arc of a lane, and that arcs hold nothing but sites.
inline void check_site_slots(const RowLayout& layout, int N) {
  std::set<int> slots, all;
  bool right = true;
  for (int i = 0; i < N; ++i) {
    const int slot = layout.slot(i), lane = slot % lanes, v = slot / lanes - layout.halo();
    right = right && v >= 0 && v < layout.packs() && layout.start(lane) + v == i;
    slots.insert(slot);
    const std::vector<int> every = layout.slots_of(i);
    right = right && std::ranges::count(every, slot) == 1;
    all.insert(every.begin(), every.end());
  }
  CHECK(right);
  CHECK(slots.size() == at(N));
  CHECK(all.size() == at(layout.packs() * lanes));
}

}  // namespace delf::testing

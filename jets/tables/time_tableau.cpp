// SPDX-License-Identifier: MIT
#include "jets/tables/time_tableau.hpp"

namespace delf {

const std::vector<TimeTableau>& time_tableaux() {
  static const std::vector<TimeTableau> all = [] {
    std::vector<TimeTableau> list{{"midpoint", "lagrange-lobatto", 2, "gauss", 1},
                                  {"stormer-verlet", "lagrange-lobatto", 2, "lobatto", 2}};
    for (int s = 1; s <= 6; ++s) list.push_back({"gauss" + std::to_string(s), "lagrange-lobatto", s + 1, "gauss", s});
    for (int s = 2; s <= 6; ++s)
      list.push_back({"lobatto" + std::to_string(s), "lagrange-lobatto-bubble", s + 1, "lobatto", s});
    return list;
  }();
  return all;
}

}  // namespace delf

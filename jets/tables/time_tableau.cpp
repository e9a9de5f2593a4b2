// SPDX-License-Identifier: MIT
#include "jets/tables/time_tableau.hpp"

namespace delf {

const std::vector<TimeTableau>& time_tableaux() {
  static const std::vector<TimeTableau> all = [] {
    std::vector<TimeTableau> list{
        {"midpoint", "lagrange-lobatto", 2, "gauss", 1, "the midpoint rule", {"hairer-lubich-wanner-2006"}},
        {"stormer-verlet",
         "lagrange-lobatto",
         2,
         "lobatto",
         2,
         "the Störmer–Verlet method",
         {"verlet-1967", "hairer-lubich-wanner-2003"}}};
    for (int s = 1; s <= 6; ++s)
      list.push_back({"gauss" + std::to_string(s),
                      "lagrange-lobatto",
                      s + 1,
                      "gauss",
                      s,
                      "the Gauss method of order " + std::to_string(2 * s),
                      {"butcher-1964"}});
    for (int s = 2; s <= 6; ++s)
      list.push_back({"lobatto" + std::to_string(s),
                      "lagrange-lobatto-bubble",
                      s + 1,
                      "lobatto",
                      s,
                      "the Lobatto IIIA–IIIB method of order " + std::to_string(2 * s - 2),
                      {"jay-1996"}});
    return list;
  }();
  return all;
}

}  // namespace delf

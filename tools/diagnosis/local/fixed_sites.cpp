// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>

#include "tools/diagnosis/findings.hpp"

namespace delf {

// Every site whose equations fail keeps its values, and others move.
std::optional<Finding> find_fixed_sites(const Evidence& e) {
  const int N = e.system.lattice().sites(), C = e.system.components();
  const auto sites = e.failed.sites();
  if (sites.empty() || e.rows < 4 || static_cast<int>(sites.size()) > N / 4) return std::nullopt;
  // Sites at the ends alone are walls: a seam.
  if (std::ranges::all_of(sites, [&](int i) { return i == 0 || i == N - 1; })) return std::nullopt;
  const std::vector<double> first = e.row(1);
  bool moves = false;
  constexpr std::int64_t looks = 8;
  for (std::int64_t n = 1; n <= looks; ++n) {
    const std::vector<double> row = e.row(1 + (e.rows - 2) * n / looks);
    for (const int i : sites)
      for (int c = 0; c < C; ++c)
        if (const std::size_t at = i * C + c; row[at] != first[at]) return std::nullopt;
    moves = moves || row != first;
  }
  if (!moves) return std::nullopt;
  std::string list;
  for (std::size_t n = 0; n < std::min<std::size_t>(sites.size(), 8); ++n)
    list += fmt::format("{}{}", n == 0 ? "" : ", ", sites[n]);
  return Finding{
      "fixed-sites",
      fmt::format("Site{} {}{} keep{} the same value in all rows: held fixed by the program, inside the "
                  "lattice. Everywhere else the equations hold.",
                  sites.size() == 1 ? "" : "s", list, sites.size() > 8 ? ", …" : "", sites.size() == 1 ? "s" : "")};
}

}  // namespace delf

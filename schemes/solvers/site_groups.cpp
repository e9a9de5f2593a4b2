// SPDX-License-Identifier: MIT
#include "schemes/solvers/site_groups.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

int SiteGroups::reach(Entries entries) const {
  int most = 0;
  for (const auto& e : entries) {
    const int apart = std::abs(of_row[at(e.row)] - of_column[at(e.column)]);
    most = std::max(most, std::min(apart, count() - apart));
  }
  return most;
}

void SiteGroups::merge(int together) {
  const int groups = count() / together;
  std::vector<int> merged(at(groups), 0);
  for (int g = 0; g < count(); ++g) merged[at(std::min(g / together, groups - 1))] += sizes[at(g)];
  for (auto* of : {&of_row, &of_column})
    for (int& g : *of) g = std::min(g / together, groups - 1);
  sizes = std::move(merged);
}

std::optional<SiteGroups> SiteGroups::of(const std::vector<int>& row_sites, const std::vector<int>& column_sites,
                                         Entries entries) {
  SiteGroups groups;
  std::map<int, int> number;
  for (const int site : column_sites) number[site] = 0;
  int next = 0;
  for (auto& [site, n] : number) n = next++;
  groups.sizes.assign(number.size(), 0);
  std::vector<int> rows(number.size(), 0);
  for (const int site : column_sites) ++groups.sizes[at(groups.of_column.emplace_back(number[site]))];
  for (const int site : row_sites) {
    const auto found = number.find(site);
    if (found == number.end()) return std::nullopt;
    ++rows[at(groups.of_row.emplace_back(found->second))];
  }
  if (rows != groups.sizes) return std::nullopt;
  const int reach = groups.reach(entries);
  if (reach > 3 || groups.count() < 4 * std::max(reach, 1)) return std::nullopt;
  if (reach > 1) groups.merge(reach);
  return groups;
}

}  // namespace delf

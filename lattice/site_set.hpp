// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

#include "lattice/site.hpp"

namespace delf {

/// A finite set of sites, sorted by time, then space, with fast search: O(1) in a row without gaps.
class SiteSet {
 public:
  SiteSet() = default;
  explicit SiteSet(std::vector<Site> sites);  ///< in any order, duplicates allowed

  const std::vector<Site>& sites() const { return sites_; }
  std::size_t size() const { return sites_.size(); }
  /// The place of a site in sites(), or size() if it is not there.
  std::size_t index(Site site) const;
  bool contains(Site site) const { return index(site) < size(); }

 private:
  struct Row {
    int time;
    std::size_t begin, end;
  };
  std::vector<Site> sites_;
  std::vector<Row> rows_;
};

}  // namespace delf

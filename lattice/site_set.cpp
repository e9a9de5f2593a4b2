// SPDX-License-Identifier: MIT
#include "lattice/site_set.hpp"

#include <algorithm>
#include <utility>

#include "lattice/index.hpp"

namespace delf {

SiteSet::SiteSet(std::vector<Site> sites) : sites_(std::move(sites)) {
  std::ranges::sort(sites_);
  sites_.erase(std::unique(sites_.begin(), sites_.end()), sites_.end());
  for (std::size_t n = 0; n < sites_.size(); ++n)
    if (rows_.empty() || rows_.back().time != sites_[n].time) rows_.push_back({sites_[n].time, n, n + 1});
    else rows_.back().end = n + 1;
}

std::size_t SiteSet::index(Site site) const {
  const auto row = std::ranges::lower_bound(rows_, site.time, {}, &Row::time);
  if (row == rows_.end() || row->time != site.time) return size();

  const long long first = sites_[row->begin].space, last = sites_[row->end - 1].space;
  if (site.space < first || site.space > last) return size();
  // A row without gaps, of one node a cell.
  if (at(last - first) + 1 == row->end - row->begin) {
    const std::size_t there = row->begin + at(site.space - first);
    if (sites_[there] == site) return there;
  }

  const auto begin = sites_.begin() + static_cast<std::ptrdiff_t>(row->begin);
  const auto end = sites_.begin() + static_cast<std::ptrdiff_t>(row->end);
  const auto found = std::lower_bound(begin, end, site);
  return found != end && *found == site ? at(found - sites_.begin()) : size();
}

}  // namespace delf

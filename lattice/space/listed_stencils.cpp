// SPDX-License-Identifier: MIT
#include "lattice/space/listed_stencils.hpp"

#include <utility>

#include "lattice/index.hpp"

namespace delf {

ListedStencils::ListedStencils(int length, std::vector<std::int32_t> sites, int sites_of_row)
    : length_(length), sites_(std::move(sites)), first_(at(sites_of_row) + 1, 0) {
  for (const std::int32_t site : sites_) ++first_[at(site) + 1];
  for (std::size_t s = 1; s < first_.size(); ++s) first_[s] += first_[s - 1];
  std::vector<std::int32_t> next(first_.begin(), first_.end() - 1);
  members_.resize(sites_.size());
  for (std::int32_t n = 0; n < static_cast<std::int32_t>(sites_.size()); ++n)
    members_[at(next[at(sites_[n])]++)] = {n / length_, n % length_};
}

}  // namespace delf

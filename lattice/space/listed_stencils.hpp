// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "lattice/index.hpp"

namespace delf {

/// The stencils of one family in a row of a space where they do not repeat: each an ordered list of as many sites. The
/// space of a vertex of the family's pattern is its place in this list, and the space of an anchor the stencil's number.
class ListedStencils {
 public:
  /// `sites` of one stencil after the other, `length` each; those of the space are numbered below `sites_of_row`.
  ListedStencils(int length, std::vector<std::int32_t> sites, int sites_of_row);

  int size() const { return static_cast<int>(sites_.size()) / length_; }
  int site(int stencil, int place) const { return sites_[stencil * length_ + place]; }

  /// The stencils that have a site, by their numbers, and where they have it.
  struct Member {
    std::int32_t stencil, place;
  };
  std::span<const Member> touching(int site) const {
    const std::size_t s = site;
    return {members_.data() + first_[s], at(first_[s + 1] - first_[s])};
  }

 private:
  int length_;
  std::vector<std::int32_t> sites_;
  std::vector<std::int32_t> first_;  ///< [site]: of its members, and the end
  std::vector<Member> members_;
};

}  // namespace delf

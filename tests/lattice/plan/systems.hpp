// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <random>
#include <utility>
#include <vector>

#include "lattice/plan/incidence.hpp"
#include "lattice/stencil_shape.hpp"

/// Systems to plan, for the tests of this folder.
namespace delf::testing {

/// Every vertex of the shape coupled to every vertex: a dense Hessian.
template <StencilShape S>
SystemPattern dense(const S& shape, Dependence dependence = Dependence::linear) {
  return system_of(1, {StencilIncidence::dense(StencilPattern(shape), dependence)});
}

/// The given pairs of vertices coupled, both ways, and each vertex to itself.
template <StencilShape S>
SystemPattern coupled(const S& shape, const std::vector<std::pair<int, int>>& pairs) {
  StencilIncidence family{StencilPattern(shape), {}};
  for (int l = 0; l < S::size(); ++l) family.couplings.push_back({l, l});
  for (const auto& [l, m] : pairs) {
    family.couplings.push_back({l, m});
    family.couplings.push_back({m, l});
  }
  return system_of(1, {family});
}

inline int pick(std::mt19937& random, int first, int last) {
  return std::uniform_int_distribution<int>(first, last)(random);
}

/// A tuple of different sites, some rows and columns around the anchor.
inline StencilPattern random_pattern(std::mt19937& random, Placement placement) {
  StencilPattern pattern({}, placement);
  while (pattern.size() < 1 || (pattern.size() < 6 && pick(random, 0, 3) > 0)) {
    const Site site{pick(random, -1, 1), pick(random, -1, 1)};
    if (std::find(pattern.vertices.begin(), pattern.vertices.end(), site) == pattern.vertices.end())
      pattern.vertices.push_back(site);
  }
  return pattern;
}

}  // namespace delf::testing

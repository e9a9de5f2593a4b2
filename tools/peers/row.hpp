// SPDX-License-Identifier: MIT
#pragma once
#include <boost/align/aligned_allocator.hpp>
#include <cstddef>
#include <vector>

#include "jets/simd/pack.hpp"

namespace delf::peers {

/// Numbers aligned to whole packs.
using Row = std::vector<double, boost::alignment::aligned_allocator<double, sizeof(Pack)>>;

/// The least multiple of `lanes` that is not below.
inline std::size_t whole_packs(std::size_t numbers) { return (numbers + lanes - 1) / lanes * lanes; }

}  // namespace delf::peers

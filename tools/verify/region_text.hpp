// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>
#include <vector>

#include "lattice/lattice.hpp"
#include "lattice/site.hpp"

namespace delf {

/// The sites of a region as text, by time and space: rectangles ROWSxSITES, added by + and taken away by −, such as
/// "0:8x10:30-3:5x18:22". Sites may run on around a circle. Throws BadInput "verify.regions".
std::vector<Site> sites_of_region(std::string_view text, const Lattice&);

}  // namespace delf

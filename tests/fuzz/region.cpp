// SPDX-License-Identifier: MIT
#include "tests/fuzz/target.hpp"
#include "tools/verify/region_text.hpp"

// The sites of a region, verify.regions, on a circle and between walls.
void delf::fuzz::read_bytes(std::string_view bytes) {
  sites_of_region(bytes, Lattice::circle(255, 30));
  sites_of_region(bytes, Lattice::interval(64, 30));
}

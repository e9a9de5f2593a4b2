// SPDX-License-Identifier: MIT
#pragma once

namespace delf::bench {

/// ns for one sine of 4096 numbers in cache, all of them independent: the median of `repeats`.
struct Sines {
  double packs, library, autovectorised;
};
Sines time_sines(int repeats);

/// ns for each site of v += s·y, y += v over rows of so many sites: the state of any scheme here, y and its increment,
/// read once and written once, 32 bytes a site.
double time_traffic(int sites, int repeats);

}  // namespace delf::bench

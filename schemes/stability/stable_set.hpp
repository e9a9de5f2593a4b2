// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <vector>

#include "schemes/system/lattice_system.hpp"

namespace delf {

/// Stable from `from` to `to`.
struct StableInterval {
  double from, to;
};

/// The search of a parameter.
struct StableSearch {
  int samples = 200;        ///< steps of the parameter; intervals and gaps narrower than a step may be missed
  double tolerance = 1e-8;  ///< of the ends
  double constant = 0;      ///< the state
  int wave_numbers = 201;
};

/// The values of a parameter between `least` and `most` at which a scheme is linearly stable: a union of intervals,
/// ascending, which may be several. An end at `least` or `most` is where the search ended, not where stability does.
/// `least` itself is not tried: it may be 0. `make` interprets the parameter: the Courant number at a fixed mh
/// or mk, or mh at a fixed Courant number. Throws as Symbol, and whatever `make` does.
std::vector<StableInterval> stable_set(const std::function<LatticeSystem(double)>& make, double least, double most,
                                       const StableSearch& = {});

/// The stable Courant numbers in (0, most].
inline std::vector<StableInterval> stable_courants(const std::function<LatticeSystem(double courant)>& make,
                                                   double most, const StableSearch& search = {}) {
  return stable_set(make, 0, most, search);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdlib>

#include "tests/catch.hpp"

namespace delf::testing {

/// Whether gnuplot is installed; warns if it is not.
inline bool has_gnuplot() {
  if (std::system("command -v gnuplot > /dev/null") == 0) return true;
  WARN("gnuplot is not installed: no figures are tested");
  return false;
}

}  // namespace delf::testing

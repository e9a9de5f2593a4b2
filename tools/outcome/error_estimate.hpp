// SPDX-License-Identifier: MIT
#pragma once
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace delf {

/// The error of the coarsest of three values at h, h/2 and h/4, by Richardson's extrapolation: with differences
/// d₁ = |y_h − y_{h/2}| and d₂ = |y_{h/2} − y_{h/4}|, the order is p = log₂(d₁/d₂) and the error d₁ 2ᵖ/(2ᵖ − 1).
struct Richardson {
  double error = std::numeric_limits<double>::quiet_NaN();
  double order = std::numeric_limits<double>::quiet_NaN();
  bool converging = false;  ///< without it there is no estimate
};

/// The error from two differences; `size` is that of the values, whose rounding counts as no error.
Richardson richardson(double first, double second, double size);

/// The error of a run, found from runs of the same scene at half and at a quarter of its steps.
struct ErrorEstimate {
  std::string failure;       ///< why there is none
  bool interrupted = false;  ///< by Ctrl-C
  Richardson row;            ///< the last row, in the maximum norm
  std::vector<std::pair<std::string, Richardson>> measures;
};

/// One line each.
std::vector<std::string> in_words(const ErrorEstimate&);

}  // namespace delf

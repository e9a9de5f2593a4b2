// SPDX-License-Identifier: MIT
#pragma once
#include <span>

namespace delf {

/// The place m (not an integer) of the largest peak of |Σ_j w_j (f_j − f̄) e^{−2πi mj/n}|, 0 < m < n/2, for values that are
/// evenly spaced; not a number where all are equal, or too few. Without a window the values are taken to be periodic, and
/// m is an integer; with Hann's, m is that of a parabola through the logarithms at the peak and beside it.
double spectrum_peak(std::span<const double> values, bool periodic);

}  // namespace delf

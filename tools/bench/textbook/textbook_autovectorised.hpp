// SPDX-License-Identifier: MIT
#pragma once

namespace delf::bench {

/// The loop of textbook_explicit.cpp for the compiler to vectorise, the sine too: this file alone is compiled with
/// -ffast-math, with which glibc offers vector sines (libmvec). `next` holds y_{n−1} and receives y_{n+1}; both rows
/// are on a circle, without ghost sites.
void autovectorised_step(const double* y, double* next, int sites, double squared_ratio, double squared_step);

/// out = sin x
void autovectorised_sine(const double* x, double* out, int count);

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>

namespace delf {

inline double seconds_of(std::chrono::steady_clock::duration d) { return std::chrono::duration<double>(d).count(); }

/// Seconds since `begin`; negative before it.
inline double seconds_since(std::chrono::steady_clock::time_point begin) {
  return seconds_of(std::chrono::steady_clock::now() - begin);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

/// Random numbers that are the same with every library.
namespace delf::testing {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}
  /// Uniform in [low, high).
  double operator()(double low, double high) {
    return low + (high - low) * static_cast<double>(engine_() >> 11) * 0x1p-53;
  }
  template <std::size_t n>
  std::array<double, n> array(double low, double high) {
    std::array<double, n> values;
    for (double& x : values) x = (*this)(low, high);
    return values;
  }
  /// An integer first … last.
  int pick(int first, int last) {
    return first + static_cast<int>(engine_() % static_cast<unsigned>(last - first + 1));
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace delf::testing

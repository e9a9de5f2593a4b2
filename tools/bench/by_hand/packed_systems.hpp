// SPDX-License-Identifier: MIT
#pragma once
#include <array>

#include "tools/bench/by_hand/packed_slab.hpp"

namespace delf::bench {

/// The moving mesh of schemes/families/r_adaptive.hpp, its formulas written once more with the time step folded in.
struct PackedMovingMesh {
  static constexpr int components = 3, half_band = 5, equation[] = {0, 0, 1}, unknown[] = {1, 1, 0};
  static constexpr bool multiplier[] = {false, false, true};

  struct Rectangle {
    static constexpr std::array<StencilValue, 8> values{
        {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}, {0, 1, 0}, {0, 1, 1}}};
    double h;
    template <class T>
    T operator()(const T* y) const {
      const double per_h = 1 / h;
      const T left_t = per_h * (y[2] - y[0]), left_mesh_t = per_h * (y[3] - y[1]);
      const T right_t = per_h * (y[4] - y[6]), right_mesh_t = per_h * (y[5] - y[7]);
      const auto row = [&](const T& a, const T& mesh_a, const T& b, const T& mesh_b) -> T {
        const T size = mesh_b - mesh_a, slope = (b - a) / size;
        const T w_a = left_t - slope * left_mesh_t, w_b = right_t - slope * right_mesh_t;
        const T mean_cos = cos(0.5 * (a + b)) * sinc_near_zero(0.5 * (a - b));
        return size * ((1. / 6) * (w_a * w_a + w_a * w_b + w_b * w_b) - 0.5 * (slope * slope) - (1.0 - mean_cos));
      };
      return (0.5 * h) * (row(y[0], y[1], y[6], y[7]) + row(y[2], y[3], y[4], y[5]));
    }
  };
  struct Arclength {
    static constexpr std::array<StencilValue, 7> values{
        {{0, -1, 0}, {0, -1, 1}, {0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 1, 0}, {0, 1, 1}}};
    double alpha;
    template <class T>
    T operator()(const T* y) const {
      const T left = y[2] - y[0], left_size = y[3] - y[1], right = y[5] - y[2], right_size = y[6] - y[3];
      const double a = alpha * alpha;
      return -(y[4] * (a * (right * right) + right_size * right_size - a * (left * left) - left_size * left_size));
    }
  };
};

/// The wave map into the sphere on `rectangle`: u_t on both vertical edges, u_x the mean of both rows.
struct PackedWaveMap {
  static constexpr int components = 4, half_band = 11, equation[] = {0, 0, 0, 1}, unknown[] = {1, 1, 1, 0};
  static constexpr bool multiplier[] = {false, false, false, true};

  struct Rectangle {
    static constexpr std::array<StencilValue, 12> values{{{0, 0, 0},
                                                          {0, 0, 1},
                                                          {0, 0, 2},
                                                          {1, 0, 0},
                                                          {1, 0, 1},
                                                          {1, 0, 2},
                                                          {1, 1, 0},
                                                          {1, 1, 1},
                                                          {1, 1, 2},
                                                          {0, 1, 0},
                                                          {0, 1, 1},
                                                          {0, 1, 2}}};
    double h, k;
    template <class T>
    T operator()(const T* y) const {
      const auto square = [](const T& x) -> T { return x * x; };
      const auto part = [&](int c) -> T {
        return (0.25 * k / h) * (square(y[3 + c] - y[c]) + square(y[6 + c] - y[9 + c])) -
               (0.125 * h / k) * square(y[9 + c] - y[c] + y[6 + c] - y[3 + c]);
      };
      return part(0) + part(1) + part(2);
    }
  };
  struct Sphere {
    static constexpr std::array<StencilValue, 4> values{{{0, 0, 0}, {0, 0, 1}, {0, 0, 2}, {0, 0, 3}}};
    template <class T>
    T operator()(const T* y) const {
      return y[3] * (y[0] * y[0] + y[1] * y[1] + y[2] * y[2] - 1.0);
    }
  };
};

}  // namespace delf::bench

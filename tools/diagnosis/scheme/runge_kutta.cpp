// SPDX-License-Identifier: MIT
#include "tools/diagnosis/scheme/runge_kutta.hpp"

namespace delf {

bool RungeKutta::is_explicit() const {
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t j = i; j < a.size(); ++j)
      if (a[i][j] != 0) return false;
  return true;
}

const std::vector<RungeKutta>& runge_kutta_methods() {
  static const std::vector<RungeKutta> all{
      {"explicit Euler", {{0}}, {1}},
      {"the explicit midpoint rule (Runge)", {{0, 0}, {0.5, 0}}, {0, 1}},
      {"Heun's method of order 2", {{0, 0}, {1, 0}}, {0.5, 0.5}},
      {"Ralston's method of order 2", {{0, 0}, {2. / 3, 0}}, {0.25, 0.75}},
      {"Kutta's method of order 3", {{0, 0, 0}, {0.5, 0, 0}, {-1, 2, 0}}, {1. / 6, 2. / 3, 1. / 6}},
      {"Heun's method of order 3", {{0, 0, 0}, {1. / 3, 0, 0}, {0, 2. / 3, 0}}, {0.25, 0, 0.75}},
      {"the classical Runge-Kutta method of order 4",
       {{0, 0, 0, 0}, {0.5, 0, 0, 0}, {0, 0.5, 0, 0}, {0, 0, 1, 0}},
       {1. / 6, 1. / 3, 1. / 3, 1. / 6}},
      {"the 3/8 rule of Kutta",
       {{0, 0, 0, 0}, {1. / 3, 0, 0, 0}, {-1. / 3, 1, 0, 0}, {1, -1, 1, 0}},
       {0.125, 0.375, 0.375, 0.125}},
      {"Dormand and Prince's method of order 5",
       {{0, 0, 0, 0, 0, 0},
        {1. / 5, 0, 0, 0, 0, 0},
        {3. / 40, 9. / 40, 0, 0, 0, 0},
        {44. / 45, -56. / 15, 32. / 9, 0, 0, 0},
        {19372. / 6561, -25360. / 2187, 64448. / 6561, -212. / 729, 0, 0},
        {9017. / 3168, -355. / 33, 46732. / 5247, 49. / 176, -5103. / 18656, 0}},
       {35. / 384, 0, 500. / 1113, 125. / 192, -2187. / 6784, 11. / 84}},
      {"implicit Euler", {{1}}, {1}},
      {"the trapezoidal rule", {{0, 0}, {0.5, 0.5}}, {0.5, 0.5}},
      {"Radau IIA of two stages", {{5. / 12, -1. / 12}, {0.75, 0.25}}, {0.75, 0.25}},
  };
  return all;
}

}  // namespace delf

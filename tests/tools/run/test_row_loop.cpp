// SPDX-License-Identifier: MIT
#include <limits>

#include "tests/catch.hpp"
#include "tools/run/row_loop.hpp"

using namespace delf;

TEST_CASE("a row is a solution if what its equations leave is rounding, or what the tolerance allows") {
  CHECK(is_solution(1e-15, 1e-14));
  CHECK(is_solution(9e-7, 1e-14));
  CHECK_FALSE(is_solution(2e-6, 1e-14));
  CHECK_FALSE(is_solution(1, 1e-14));
  CHECK_FALSE(is_solution(std::numeric_limits<double>::infinity(), 1e-14));
  CHECK(is_solution(1e-4, 1e-6));
  CHECK_FALSE(is_solution(1e-2, 1e-6));
  CHECK_FALSE(is_solution(std::numeric_limits<double>::quiet_NaN(), 1e-14));
}

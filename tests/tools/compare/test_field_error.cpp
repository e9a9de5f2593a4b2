// SPDX-License-Identifier: MIT
#include "tools/compare/field_error.hpp"

#include <array>
#include <cmath>
#include <limits>

#include "tests/catch.hpp"

using namespace delf;

TEST_CASE("errors of a field, of which a NaN stays wherever it stands") {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  const std::array solution{1.0, 2.0, 3.0};
  const FieldError e = field_error(std::array{1.0, 2.5, 1.0}, solution, 0.5);
  CHECK(e.linf == 2);
  CHECK(e.l2 == Approx(std::sqrt(0.5 * 4.25)));
  for (const auto& field : {std::array{nan, 2.0, 3.0}, {1.0, nan, 5.0}, {1.0, 2.0, nan}}) {
    const FieldError bad = field_error(field, solution, 0.5);
    CHECK(std::isnan(bad.linf));
    CHECK(std::isnan(bad.l2));
  }
}

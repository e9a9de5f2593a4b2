// SPDX-License-Identifier: MIT
#include "schemes/stepping/rows/seen_contraction.hpp"

#include <cmath>

#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int N = 255;
constexpr double L = 40, k = L / N, h = k / 8;

Evolution evolution(const std::string& scheme, double tolerance) {
  StepOptions options;
  options.tolerance = tolerance;
  return evolution_of(problem_of("sine-gordon"), scheme, Lattice::circle(N, L), h, options);
}

/// Two humps that are narrow enough to leave short waves behind, which no polynomial in time foretells.
std::vector<Row> humps() {
  std::vector<Row> rows(2);
  for (int n = 0; n < 2; ++n)
    for (int i = 0; i < N; ++i) {
      const auto hump = [&](double at, double speed) { return 2.5 * std::exp(-std::pow(i * k - at - speed * n * h, 2)); };
      rows[static_cast<std::size_t>(n)].push_back(hump(12, 0.5) - hump(25, -0.8));
    }
  return rows;
}

struct Run {
  double worst = 0, span = 0;  ///< how far steps are from their roots, and what the field spans
  double iterations = 0;       ///< mean
};

/// Steps of a scheme, of which every seventh is compared with its root from the same two rows.
Run run(const std::string& scheme, double tolerance) {
  Evolution made = evolution(scheme, tolerance), exact = evolution(scheme, 1e-16);
  Stepper& stepper = made.stepper();
  stepper.start(humps());
  Run result;
  constexpr int first = 30, steps = 900;
  for (int n = 0; n < steps; ++n) {
    const bool compared = n >= first && n % 7 == 0;
    if (compared) exact.stepper().start({stepper.row(1), stepper.row(0)}), exact.stepper().step();
    stepper.step();
    if (n >= first) result.iterations += stepper.iterations() / static_cast<double>(steps - first);
    const Row row = stepper.row(0);
    const auto [least, most] = std::ranges::minmax(row);
    result.span = std::max(result.span, most - least);
    if (compared) result.worst = std::max(result.worst, distance(row, exact.stepper().row(0)));
  }
  return result;
}

}  // namespace

TEST_CASE("what was seen of a first iteration is said of changes that are like it, and twice that") {
  SeenContraction seen;
  CHECK_FALSE(seen.is_like(1));
  seen.see(2e-6, 5e-9);
  CHECK(seen.is_like(2e-6));
  CHECK(seen.is_like(2.9e-6));
  CHECK(seen.is_like(1.4e-6));
  CHECK_FALSE(seen.is_like(3.1e-6));
  CHECK_FALSE(seen.is_like(1.3e-6));
  CHECK_FALSE(seen.is_like(std::nan("")));
  CHECK(seen.next_change() == Approx(2 * 2.5e-3));
  seen.forget();
  CHECK_FALSE(seen.is_like(2e-6));
}

TEST_CASE("steps from extrapolated outputs are as near their roots as the tolerance says, and most evaluate once") {
  for (const std::string scheme : {"rectangle-symmetric", "rectangle", "triangle", "guo", "vu-quoc-li"}) {
    CAPTURE(scheme);
    const Run found = run(scheme, 1e-13);
    CHECK(found.worst <= 1e-13 * found.span);
    CHECK(found.worst > 0.1e-13 * found.span);
    if (scheme != "guo") CHECK(found.iterations < 1.6);  // 1.5 to 2 where arguments are extrapolated
  }
}

TEST_CASE("the comparison of steps with their roots can fail: of another tolerance") {
  const Run loose = run("rectangle-symmetric", 1e-10);
  CHECK(loose.worst > 1e-13 * loose.span);
  CHECK(loose.worst <= 1e-10 * loose.span);
}

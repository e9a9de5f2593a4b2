// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <string>

#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

struct Solution {
  const char* state;
  double length, until;
};
constexpr Solution kink_train{"kink-train", 10, 8}, breather{"breather", 40, 12};

/// The error of one solution at `until`, N sites.
double error_at(const SchemeName& scheme, const Solution& solution, double until, double courant, int N, Start how) {
  const Lattice lattice = Lattice::circle(N, solution.length);
  Problem p = problem_for(scheme, "sine-gordon", lattice, courant);
  StateRequest request;
  request.name = solution.state, request.theory = "sine-gordon";
  if (request.name == "kink-train") request.winding = p.winding = 1, request.epsilon = 1e-6;
  if (request.name == "breather") request.frequency = 0.6;
  const int steps = static_cast<int>(std::lround(until / p.time_step));
  REQUIRE(std::abs(steps * p.time_step - until) < 1e-12);
  return final_error(p, *make_state(request, lattice), steps, how);
}

double measured_order(const SchemeName& scheme, const Solution& solution, double until, double courant, int N,
                      Start how) {
  return order(error_at(scheme, solution, until, courant, N, how),
               error_at(scheme, solution, until, courant, 2 * N, how), 2);
}

bool second(double p) { return 1.9 <= p && p <= 2.1; }

}  // namespace

TEST_CASE("every scheme is of second order on a kink train and on a breather, from either start") {
  for (const Solution& solution : {kink_train, breather})
    for (const SchemeName& scheme : all_schemes)
      for (const double courant : {0.125, 0.5})
        for (const Start how : {Start::exact, Start::centred}) {
          // two steps of the ladder N, 2N, 4N
          const double coarse = measured_order(scheme, solution, solution.until, courant, 160, how);
          const double fine = measured_order(scheme, solution, solution.until, courant, 320, how);
          CAPTURE(solution.state, scheme.text(), courant, how == Start::exact, coarse, fine);
          CHECK(second(coarse));
          CHECK(second(fine));
        }
}

TEST_CASE("the check can fail: from row 1 = row 0 + h φ_t every scheme is of first order") {
  for (const Solution& solution : {kink_train, breather})
    for (const SchemeName& scheme : all_schemes) {
      // Early, while the scheme's own C k² is still small beside what the start adds.
      const double p = measured_order(scheme, solution, 0.5, 0.5, 640, Start::euler);
      CAPTURE(solution.state, scheme.text(), p);
      CHECK((0.9 <= p && p <= 1.1));
      CHECK_FALSE(second(measured_order(scheme, solution, solution.until, 0.5, 640, Start::euler)));
    }
}

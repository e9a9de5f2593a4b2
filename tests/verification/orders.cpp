// SPDX-License-Identifier: MIT
#include <cmath>

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
  if (request.name == "kink-train") request.winding = p.winding = 1, request.values["initial.epsilon"] = 1e-6;
  if (request.name == "breather") request.values["initial.frequency"] = 0.6;
  const int steps = static_cast<int>(std::lround(until / p.time_step));
  REQUIRE(std::abs(steps * p.time_step - until) < 1e-12);
  return final_error(p, *make_state(request, lattice), steps, how);
}

bool second(double p) { return 1.9 <= p && p <= 2.1; }

}  // namespace

TEST_CASE("every scheme is of second order on a kink train and on a breather, from either start") {
  for (const Solution& solution : {kink_train, breather})
    for (const SchemeName& scheme : all_schemes)
      for (const double courant : {0.125, 0.5})
        for (const Start how : {Start::exact, Start::centred}) {
          const auto error = [&](int N) { return error_at(scheme, solution, solution.until, courant, N, how); };
          const double at_160 = error(160), at_320 = error(320), at_640 = error(640);
          const double coarse = order(at_160, at_320, 2), fine = order(at_320, at_640, 2);
          CAPTURE(solution.state, scheme.text(), courant, how == Start::exact, coarse, fine);
          CHECK(second(coarse));
          CHECK(second(fine));
        }
}

TEST_CASE("the check can fail: from row 1 = row 0 + h φ_t every scheme is of first order") {
  for (const Solution& solution : {kink_train, breather})
    for (const SchemeName& scheme : all_schemes) {
      const auto euler_order = [&](double until) {
        return order(error_at(scheme, solution, until, 0.5, 640, Start::euler),
                     error_at(scheme, solution, until, 0.5, 1280, Start::euler), 2);
      };
      // early, while the scheme's own C k² is small beside what the start adds
      const double early = euler_order(0.5), late = euler_order(solution.until);
      CAPTURE(solution.state, scheme.text(), early, late);
      CHECK((0.9 <= early && early <= 1.1));
      CHECK_FALSE(second(late));
    }
}

// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>

#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

// C in max |y_i − φ(T, x_i)| ≈ C k², kink train with L = 10, 1 − κ = 1e-6, T = 8, from another program in quadruple
// precision with N = 640; (5.8), (5.10), (5.12), (5.14), (5.15).
struct Constants {
  double courant;
  std::array<double, 5> of_scheme;
};
constexpr std::array<Constants, 4> reference{{{0.125, {1.3937983, 1.2810539, 2.5611661, 2.1509091, 2.0980568}},
                                              {0.5, {1.3285020, 1.8730140, 1.9691176, 2.6666275, 1.8214859}},
                                              {0.9, {0.8747606, 3.2851300, 0.5639557, 3.8940447, 1.1706905}},
                                              {1.0, {0.7017554, 3.7696860, 0.1231860, 4.3178762, 0.9598931}}}};

/// C at N = 360, where T = 8 is a whole number of steps for all these Courant numbers.
double measured(const SchemeName& scheme, double courant) {
  const Lattice lattice = Lattice::circle(360, 10);
  Problem p = problem_for(scheme, "sine-gordon", lattice, courant);
  p.winding = 1;
  StateRequest request;
  request.name = "kink-train", request.theory = "sine-gordon", request.winding = 1, request.values["initial.epsilon"] = 1e-6;
  const double k = lattice.space_step();
  return final_error(p, *make_state(request, lattice), static_cast<int>(std::lround(8 / p.time_step))) / (k * k);
}

bool agree(double a, double b) { return std::abs(a / b - 1) < 0.1; }

}  // namespace

TEST_CASE("error constants of the five schemes on the kink train") {
  for (const Constants& row : reference)
    for (std::size_t s = 0; s < paper_schemes.size(); ++s) {
      const double C = measured(paper_schemes[s], row.courant);
      CAPTURE(paper_schemes[s].text(), row.courant, C, row.of_scheme[s]);
      CHECK(agree(C, row.of_scheme[s]));
    }
}

TEST_CASE("the hexagon's error constant on the kink train is 0.53 at h = k/2") {
  CHECK(agree(measured({"hexagon"}, 0.5), 0.53));
}

TEST_CASE("the constants tell schemes and Courant numbers apart") {
  // Each differs from that of every other scheme by more than the tolerance, somewhere; so does each from its own at
  // another Courant number.
  for (std::size_t s = 0; s < 5; ++s) {
    const double C = measured(paper_schemes[s], 0.125);
    CAPTURE(paper_schemes[s].text(), C);
    CHECK_FALSE(agree(C, reference[2].of_scheme[s]));
    for (std::size_t other = 0; other < 5; ++other) {
      if (other == s) continue;
      bool alike = true;
      for (const Constants& row : reference)
        alike = alike && agree(measured(paper_schemes[s], row.courant), row.of_scheme[other]);
      CHECK_FALSE(alike);
    }
  }
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/verification/patch.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// Rows 0 … 12 of a run on a circle of 24 sites at h = k/2, from seeded noise at rest, as a field on all of them: what
/// the steps, row by row and by whatever plan, make of the equations is checked one stencil at a time.
Patch stepped(const std::string& theory, const SchemeName& scheme) {
  const int N = 24, last = 12;
  const Lattice lattice = Lattice::circle(N, 10);
  const Problem p = problem_for(scheme, theory, lattice, 0.5);
  StateRequest request;
  request.name = "noise", request.theory = theory, request.seed = 3, request.values["initial.amplitude"] = 0.5;
  Simulation simulation(p);
  start(simulation, p, *make_state(request, lattice), Start::centred);

  const Family family = make_family(theory, scheme);
  Patch patch({family}, p.time_step, Region::rectangle(lattice, {family->pattern()}, {0, last}, {0, N - 1}));
  for (int j = 0; j <= last; ++j) {
    while (simulation.newest() < std::max(j, 1)) simulation.step();
    const Row row = newest(simulation, lattice, j == 0 ? 1 : 0);
    for (int i = 0; i < N; ++i) patch.y[patch.U().place({j, i})] = row[i];
  }
  return patch;
}

/// max_b |E_b| / max_b Σ_a |∂E_b/∂y_a y_a|, by the library and by hand: the larger one
double left_over(const Patch& patch) {
  const ByHand plain = by_hand(patch);
  const Eigen::Map<const Eigen::VectorXd> y(patch.y.data(), static_cast<Eigen::Index>(patch.y.size()));
  double left = plain.equations().lpNorm<Eigen::Infinity>();
  for (const Balance& E : patch.on.residual(patch.y)) left = std::max(left, std::abs(E.sum));
  return left / (plain.linearised().cwiseAbs() * y.cwiseAbs()).maxCoeff();
}

const std::vector<std::string> theory_names{"wave", "klein-gordon", "sine-gordon", "phi4", "double-sine-gordon"};

}  // namespace

TEST_CASE("stepped rows solve the discrete field equations of every scheme and theory, stencil by stencil") {
  for (const std::string& theory : theory_names)
    for (const SchemeName& scheme : all_schemes) {
      const double left = left_over(stepped(theory, scheme));
      CAPTURE(theory, scheme.text(), left);
      CHECK(left < 1e-13);
    }
}

TEST_CASE("the check of the equations can fail: one value of one row that is off by 1e-9") {
  for (const std::string& theory : theory_names)
    for (const SchemeName& scheme : all_schemes) {
      Patch patch = stepped(theory, scheme);
      patch.y[patch.U().place({6, 5})] += 1e-9;
      CAPTURE(theory, scheme.text());
      CHECK(left_over(patch) > 1e-11);
    }
}

// SPDX-License-Identifier: MIT
#include "tools/bench/collision.hpp"

#include <algorithm>

#include "schemes/state.hpp"

namespace delf::bench {

std::vector<std::vector<double>> Collision::rows() const {
  StateRequest request;
  request.name = "mps-collision";
  request.theory = "sine-gordon";
  request.values["initial.epsilon"] = 1e-6;
  const auto state = make_state(request, lattice());
  std::vector<std::vector<double>> both(2, std::vector<double>(sites));
  state->values(0, lattice(), both[0]);
  state->values(time_step(), lattice(), both[1]);
  return both;
}

Problem Collision::problem() const {
  Problem problem;
  problem.lattice = lattice();
  problem.time_step = time_step();
  problem.tolerance = tolerance;
  const auto& all = methods();
  const bool is_method = std::ranges::find(all, scheme, &NamedFormula::name) != all.end();
  (is_method ? problem.method : problem.stencil) = scheme;
  problem.threads = threads;
  return problem;
}

std::unique_ptr<Textbook> Collision::textbook() const {
  return make_textbook(scheme, sites, length, time_step(), tolerance);
}

int suited_sites(const std::string& scheme, int sites) {
  if (scheme == "hexagon") return sites - sites % 2;
  if (scheme == "rectangle-symmetric") return sites - 1 + sites % 2;
  return sites;
}

}  // namespace delf::bench

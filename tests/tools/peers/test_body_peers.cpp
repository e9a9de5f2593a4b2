// SPDX-License-Identifier: MIT
#ifdef DELF_HAS_PEERS
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "schemes/state.hpp"
#include "tests/catch.hpp"
#include "tools/peers/body_peers.hpp"

using delf::Lattice;
using delf::peers::body_peers;
using delf::peers::BodyPeerInfo;
using Numbers = std::vector<double>;

namespace {

struct Motion {
  const char *theory, *state;
  double until;
};

/// The error at the end, in n steps, and that of the energy.
std::pair<double, double> errors(const Motion& motion, const BodyPeerInfo& info, int n) {
  delf::StateRequest request;
  request.name = motion.state, request.theory = motion.theory;
  const auto state = make_state(request, Lattice::point());
  const std::size_t d = state->components();
  Numbers q(d), v(d), exact(d), end(d), rate(d);
  state->values(0, Lattice::point(), q), state->velocities(0, Lattice::point(), v);
  state->values(motion.until, Lattice::point(), exact);
  const auto peer = info.make(1);
  peer->start(q, v);
  peer->advance(motion.until / n, n);
  peer->copy(end, rate);
  double most = 0;
  for (std::size_t a = 0; a < d; ++a) most = std::max(most, std::abs(end[a] - exact[a]));
  return {most, std::abs(info.energy(1, end, rate) - info.energy(1, q, v))};
}

}  // namespace

TEST_CASE("odeint's integrators step a pendulum and a planet, each with its order from both sides") {
  for (const Motion& motion : {Motion{"pendulum", "pendulum-swing", 4}, Motion{"kepler", "kepler-orbit", 2}}) {
    const auto all = body_peers(motion.theory);
    REQUIRE(all.size() == 3);
    for (const BodyPeerInfo& info : all) {
      const int n = info.order == 8 ? 24 : info.order == 4 ? 100 : 400;
      const auto coarse = errors(motion, info, n), fine = errors(motion, info, 2 * n);
      const double slope = std::log2(coarse.first / fine.first);
      CAPTURE(motion.theory, info.name, slope, coarse.first, fine.second);
      // of order 8 rounding leaves coarse steps only, and there the pendulum does better
      CHECK(slope > info.order - 0.5);
      CHECK(slope < info.order + (info.order == 8 ? 0.9 : 0.5));
      CHECK(fine.second < 1e-4);
    }
  }
}

TEST_CASE("bodies that are written for no peer have none") {
  CHECK(body_peers("henon-heiles").empty());
  CHECK(body_peers("sine-gordon").empty());
}
#endif

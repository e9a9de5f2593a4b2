// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "tools/peers/peer.hpp"

namespace delf::peers {

/// An integrator of mechanics on a body of d coordinates; fields and their rates are q and q_t.
struct BodyPeerInfo {
  std::string name;
  int order;
  std::size_t forces;  ///< evaluations of the force in a step
  std::unique_ptr<Peer> (*make)(double mass);
  double (*energy)(double mass, std::span<const double> q, std::span<const double> q_t);
  std::vector<std::string> sources = {};  ///< keys of tools/cite/references.bib
};

/// Boost.odeint's integrators of fixed step on the body that scenes call by this theory: pendulum, of m, or kepler. Empty
/// for another.
std::vector<BodyPeerInfo> body_peers(std::string_view theory);

}  // namespace delf::peers

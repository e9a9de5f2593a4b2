// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "tools/peers/peer.hpp"

namespace delf::peers {

/// Boost.odeint's integrators of fixed step on the method of lines, central differences of order 2, 4, 6, 8.
std::vector<PeerInfo> odeint_peers();

}  // namespace delf::peers

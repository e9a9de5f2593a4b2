// SPDX-License-Identifier: MIT
#include "tools/peers/peer.hpp"

#include "tools/peers/odeint_peers.hpp"
#include "tools/peers/split_step.hpp"

namespace delf::peers {

Peer::~Peer() = default;

const std::vector<PeerInfo>& peers() {
  static const std::vector<PeerInfo> all = [] {
    std::vector<PeerInfo> infos = odeint_peers();
#ifdef DELF_HAS_FFTW
    for (PeerInfo& info : split_step_peers()) infos.push_back(std::move(info));
#endif
    return infos;
  }();
  return all;
}

}  // namespace delf::peers

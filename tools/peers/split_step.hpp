// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "tools/peers/peer.hpp"
#include "tools/peers/splitting.hpp"

namespace delf::peers {

/// The flow in which the curvature of the potential at φ = 0 acts.
enum class MassIn {
  kick,  ///< flow φ_tt = φ_xx, kick −V′(φ)
  flow  ///< flow φ_tt = φ_xx − m²φ, kick m²φ − V′(φ): sine-Gordon without monodromy; of Klein–Gordon no kick is left
};

/// Fourier split-step: a splitting whose flow is exact, mode by mode. The wave equation and Klein–Gordon are one flow a
/// step, without an error in time. Throws std::invalid_argument for a mass in the flow where that is of no use: for φ⁴,
/// whose vacua are not at φ = 0, and for a field that winds.
std::unique_ptr<Peer> make_split_step(const WaveEquation&, const Splitting&, MassIn = MassIn::kick);

/// One for each order and place of the mass, with the splitting that served the sine-Gordon breather best there.
std::vector<PeerInfo> split_step_peers();

}  // namespace delf::peers

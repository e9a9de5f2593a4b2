// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "tools/peers/wave_equation.hpp"

namespace delf::peers {

/// An integrator from outside delf, with a solution that it steps.
class Peer {
 public:
  virtual ~Peer();
  /// φ and φ_t at x_i = iL/N; throws std::invalid_argument unless there are N of each.
  virtual void start(std::span<const double> phi, std::span<const double> phi_t) = 0;
  /// `steps` steps of length h. What depends on h alone is computed when h changes. Allocates nothing.
  virtual void advance(double h, std::int64_t steps) = 0;
  /// The present φ and φ_t; sizes as in start().
  virtual void copy(std::span<double> phi, std::span<double> phi_t) const = 0;
};

struct PeerInfo {
  std::string name;
  int order_time;
  int order_space;        ///< 0: spectral
  double stable_courant;  ///< h/k, k = L/N, below which it may be run, masses aside; 0 if none is known
  std::size_t forces;     ///< evaluations of the force in a step
  std::unique_ptr<Peer> (*make)(const WaveEquation&);  ///< throws std::invalid_argument for what it cannot run
  bool processed = false;                              ///< by a processor of its own at the start, undone on copies
  std::vector<std::string> sources = {};               ///< keys of tools/cite/references.bib
};

/// All peers of this build.
const std::vector<PeerInfo>& peers();

}  // namespace delf::peers

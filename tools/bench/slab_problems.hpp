// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/bench/by_hand/packed_systems.hpp"

namespace delf::bench {

/// Rows 0 and 1, as the engine takes them.
using TwoRows = std::vector<std::vector<double>>;

/// A kink of velocity 0.9 between two walls, on a mesh that follows it: Tyranowski–Desbrun (154)–(160).
struct MovingMesh {
  static constexpr double length = 25, time_step = 0.01, alpha = 2.5, velocity = 0.9;
  static constexpr long steps = 600;  ///< until then the kink is far from the wall

  int nodes;  ///< between the walls
  double tolerance;

  Problem problem() const;
  TwoRows rows() const;
  std::shared_ptr<PackedSlab<PackedMovingMesh>> by_hand(bool keeps_jacobian) const;
};

/// A wave on a great circle of the sphere.
struct WaveMapOnCircle {
  static constexpr long steps = 500;

  int sites;
  double tolerance;

  Lattice lattice() const;
  double time_step() const { return 0.5 * lattice().space_step(); }
  Problem problem() const;
  TwoRows rows() const;
  std::shared_ptr<PackedSlab<PackedWaveMap>> by_hand(bool keeps_jacobian) const;
};

/// The breather of sine-Gordon by spacetime elements of degree (2, 2), from where it turns back.
struct SpacetimeBreather {
  static constexpr double length = 40, time_step = 0.2;

  int cells;
  double tolerance;

  double space_step() const { return length / cells; }
  Problem problem() const;
  std::vector<double> phi() const;  ///< at the vertices and the nodes between them in turn; φ_t is zero
};

struct Mechanics {
  std::string theory, stencil;
  double time_step, tolerance;
  std::vector<std::string> fields = {"q"};

  Problem problem() const;
  Problem gauss(int points) const;  ///< `scheme.method = cgvi`: Gauss's method of so many stages
  TwoRows rows(const std::string& state) const;
};

}  // namespace delf::bench

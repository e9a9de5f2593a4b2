// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/bench/textbook/textbook.hpp"

namespace delf::bench {

/// The problem that is stepped: the collision of Marsden–Patrick–Shkoller §5.2 on a circle of length 40, h = k/8, by a
/// scheme named as a stencil or as a method.
struct Collision {
  static constexpr double length = 40;

  std::string scheme;
  int sites;
  double tolerance = 1e-13;
  int threads = 1;

  double space_step() const { return length / sites; }
  double time_step() const { return space_step() / 8; }
  Lattice lattice() const { return Lattice::circle(sites, length); }
  /// y₀ and y₁, in which each soliton is translated exactly; ε = 1e-6.
  std::vector<std::vector<double>> rows() const;

  Problem problem() const;
  std::unique_ptr<Textbook> textbook() const;  ///< not started
};

/// The sites nearest below that suit the scheme: even for bricks, odd for (5.12), which with an even number carries a
/// ghost Σ(−1)ⁱy_i.
int suited_sites(const std::string& scheme, int sites);

}  // namespace delf::bench

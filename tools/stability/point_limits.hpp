// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The question asked of the schemes of mechanics.
struct PointRequest {
  std::vector<NamedScheme> schemes;
  double most = 8;           ///< ωh is checked up to this
  double agreement = 0.01;   ///< of theory and runs, relative
  int steps = 2000;          ///< of a run
  double theory_factor = 1;  ///< a planted fault
};

/// The request of a scene's keys; its schemes are to be chosen still.
PointRequest point_request(const Scene&);

/// A scheme of mechanics: where it is stable on q_tt = −ω²q, how accurate it is, and what a step costs.
struct PointFinding {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scheme;
  std::string left_out;                           ///< why, if it was
  std::vector<std::pair<double, double>> stable;  ///< intervals of ωh, by the eigenvalues of a step
  double theory = unknown, observed = unknown;    ///< the first limit; infinite: none up to the most
  bool agrees = true;                             ///< a run stays just below the limit, and does not just above it
  bool too_narrow = false;  ///< stability returns so soon that no run of bearable length grows between
  double order = unknown;   ///< of the largest error of a pendulum let go at 2, to t = 10
  double microseconds = unknown, iterations = unknown;  ///< of a step of that pendulum, h = 0.1
};

PointFinding find_point_limit(const NamedScheme&, const PointRequest&);

/// `delf stability` on lattice.space = point: a table on stdout, stability.json and methods.md in `folder`. Exit code 1 if
/// runs disagree with theory.
ExitCode point_stability(const Scene&, const std::filesystem::path& folder);

}  // namespace delf

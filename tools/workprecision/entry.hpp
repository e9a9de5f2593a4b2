// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "tools/scene/scene.hpp"
#include "tools/workprecision/run_limit.hpp"
#include "tools/workprecision/workprecision_request.hpp"

namespace delf {

/// N and h of a run; `steps` of them end exactly at run.until.
struct Resolution {
  int sites = 0;
  std::int64_t steps = 0;
  double time_step = 0;
};

/// The scene's lattice with another number of sites.
Lattice lattice_of(const Scene&, int sites);

/// A scheme on a lattice, started: what is timed when it moves on.
class StartedEntry {
 public:
  virtual ~StartedEntry() = default;
  /// Index of its newest row.
  virtual std::int64_t newest() const = 0;
  /// So many steps more, or fewer if the limit is reached: nothing but newest() is to be called then.
  /// Throws NumericalFailure.
  virtual void advance(std::int64_t steps, const RunLimit&) = 0;
  /// The fields of the newest row: out[i·d + a].
  virtual void copy(std::span<double> out) const = 0;
  /// The places of its sites in the newest row; empty: on the lattice.
  virtual std::vector<double> positions() const { return {}; }
  /// The energy of the newest row; not a number if there is none.
  virtual double energy() const = 0;
  /// Evaluations of the force at each site in the last step; not a number if that is not known.
  virtual double forces() const = 0;
};

/// A scheme of the engine, or another program, that can run the scene at any resolution.
struct WorkPrecisionEntry {
  std::string name;
  bool peer = false;
  bool processed = false;  ///< a peer with a processor of its own
  bool tuned = false;      ///< a scheme of the engine that knows the solution
  int nodes = 1;           ///< that a cell has in space: how much coarser its lattices may begin
  int rank = 0;            ///< the more, the sooner it is to be the reference; 0: never
  bool own = false;        ///< the scheme that the scene itself states
  /// Builds and starts it. Throws BadInput or NumericalFailure.
  std::function<std::unique_ptr<StartedEntry>(const Resolution&)> start;
};

/// The entries that the request names, the engine's first: every scheme of the registry, and the peers that the scene
/// has an equation for. They refer to the scene. Throws BadScene for names that there are none of.
std::vector<WorkPrecisionEntry> entries(const Scene&, const WorkPrecisionRequest&);

/// All schemes of the engine, the scene's own among them, under a name of its own if it is none of the named ones.
std::vector<WorkPrecisionEntry> engine_entries(const Scene&);
/// Programs by other people; empty if the scene has another equation than theirs, or this build has none.
std::vector<WorkPrecisionEntry> peer_entries(const Scene&);

}  // namespace delf

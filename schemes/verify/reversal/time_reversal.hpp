// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "schemes/verify/check.hpp"

namespace delf {

class LatticeSystem;
class Simulation;

/// True if the equations are the same with time running backwards: at random rows, y_{j+s} ↦ y_{j−s} leaves E of every
/// field at row j as it is, or turns its sign at all sites together. Bricks lie half a brick apart from row to row, so
/// that theirs is the mirror between two rows: E at row j of the one is E at row j + 1 of the other. Equations of
/// multipliers are not asked, only their part in those of the fields. Where equations read t, `mirrored` has T − t in its
/// place, T twice the time of the middle row: mirror_time().
bool reversible(const LatticeSystem&, const LatticeSystem& mirrored, std::uint64_t seed);
bool reversible(const LatticeSystem&, std::uint64_t seed);
double mirror_time(const LatticeSystem&);

/// Forward, the last two rows exchanged, and back: to rows 2 and 3, the first that the scheme itself has made. Elements in
/// time go from (q, p) to (q, -p) and back; under a constraint their rows alone are compared.
struct Reversal {
  /// True if the way back must end at the start: the equations are reversible, or have no Lagrangian to excuse them. A
  /// variational scheme need not be reversible; the distances of one that is not are measured, and `check` is empty.
  bool promised = false;
  std::vector<std::int64_t> steps;  ///< m = 1, 2, 4, … and the whole way; even ones for brick walls
  std::vector<double> distance;     ///< max |y − start| / max |start| after m steps forward and m back
  double growth =
      std::numeric_limits<double>::quiet_NaN();  ///< slope of log distance against log m, three points or more
  Check check;                                   ///< of the smallest m: later distances are what rounding has grown to
  std::string end;                               ///< why the distances end early, if they do
};

/// A fresh simulation that has not started; of the equations with T − t in place of t, if T is given.
using MakeSimulation = std::function<std::unique_ptr<Simulation>(std::optional<double> T)>;

/// `start_rows` are rows 0 and 1 of all components, of which a
/// start reads the fields; the way forward takes steps + 2 steps. Nothing where
/// neither these are the whole state: schemes of more rows, traces, processed kernels with nodes inside. A step that fails, on
/// either way, is a check that fails.
std::optional<Reversal> time_reversal(const MakeSimulation& make, const std::vector<std::vector<double>>& start_rows,
                                      std::int64_t steps, double tolerance);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tools/compare/solution_error.hpp"
#include "tools/workprecision/entry.hpp"
#include "tools/workprecision/workprecision_outcome.hpp"

namespace delf {

/// A resolution at which an entry has been run, once, untimed.
struct TriedRun {
  std::size_t entry;
  Resolution resolution;
  WorkPrecisionRun result;  ///< its seconds are those of this first run
  std::int64_t newest = 0;  ///< row that it got to
};

/// Runs each entry once at the resolutions that a request names, or at those that turn out to matter:
///
/// Coarse first. N and h are refined by √2: each alone and both together from every run that no cheaper one of the same
/// scheme equals, and both together as long as that still helps; with given Courant numbers, both together. It ends for
/// a scheme at its floor, or where the smallest accuracy asked for is reached. Of all schemes' next runs the one with
/// the cheapest steps is taken first, so that each gets as far as any other for the same cost of a run, until the time
/// is used up. What fails is tried again at smaller steps, and with more sites up to those of the scene.
///
/// Before all others the scene's own scheme runs at the scene's own N and h, and in a tenth of the time at others near
/// those. Costs are those of StepClock: a busy machine does not make a scheme expensive.
class ResolutionSearch {
 public:
  using Clock = std::chrono::steady_clock;
  ResolutionSearch(const Scene&, const WorkPrecisionRequest&, const std::vector<WorkPrecisionEntry>&,
                   const ComparedSolution&);

  /// Until there is nothing left to run, `until` has come, or Ctrl-C. `at` is called after each run.
  void run(Clock::time_point until, const std::function<void()>& at);

  /// The runs to be timed: all of a given ladder; of a chosen one, those that no other of the scheme clearly beats.
  std::vector<TriedRun> worth_timing() const;
  /// The number of resolutions that were run.
  std::size_t tried() const { return tried_.size(); }
  /// Schemes without any run worth timing, and why.
  std::vector<WorkPrecisionOutcome::LeftOut> left_out() const;

 private:
  struct Next {
    std::size_t entry;
    int space, time;     ///< times that N and h were refined by √2
    double courant;      ///< 0: h is refined on its own
    int sites;           ///< if given; else 0
    double cost, setup;  ///< predicted, in seconds: of the steps, and before them
    double before;       ///< the error before N and h were refined together; not a number if they were not
  };
  bool chosen() const;  ///< no resolution is given
  std::int64_t scene_steps() const;
  bool is_scenes_own(std::size_t entry, const Resolution&) const;
  void run_own(std::size_t entry, double seconds, const std::function<void()>& at);
  void run_cheapest(Clock::time_point until, const std::function<void()>& at);
  void retry(const Next&, const Resolution&, double cost);
  void seed(std::size_t entry);
  Resolution resolution(const Next&) const;
  void attempt(const Next&);
  void refine(const Next&, const WorkPrecisionRun&);
  void push(const Next&);
  /// Another run of the scheme, as accurate, took less than this share of the seconds.
  bool worth(const TriedRun&) const;
  bool beaten(const TriedRun&, double share) const;
  bool too_coarse(const Next&, const WorkPrecisionRun&) const;

  const Scene& scene_;
  const WorkPrecisionRequest& request_;
  const std::vector<WorkPrecisionEntry>& entries_;
  const ComparedSolution& solution_;
  double field_scale_ = 1;
  std::vector<Next> queue_;
  std::vector<TriedRun> tried_;
  std::vector<std::string> reasons_;
  std::vector<std::vector<std::pair<int, std::int64_t>>> seen_;
  bool out_of_time_ = false;
  Clock::time_point until_;  ///< no run goes on after it
  double most_of_one_ = 0;   ///< seconds of a run
};

/// Builds it and runs it once: errors against the solution, the energy at some fifty rows, and seconds that leave these
/// out; these stay unknown if the limit ends it. Throws BadInput or NumericalFailure.
TriedRun run_once(const Scene&, const std::vector<WorkPrecisionEntry>&, std::size_t entry, const Resolution&,
                  double until, const ComparedSolution&, const RunLimit&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"
#include "tools/workprecision/workprecision_request.hpp"

namespace delf {

/// One scheme at one resolution, from row 0 to the end: its errors, and the cost of its steps.
struct WorkPrecisionRun {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scheme;
  bool peer = false;  ///< another program
  bool processed = false, tuned = false, own = false;  ///< as of the entry
  int sites = 0;
  double space_step = 1, time_step = 0;
  std::int64_t steps = 0;
  double error_linf = unknown, error_l2 = unknown;            ///< of all fields of the last row; L2 = √(k Σ e²)
  double energy_error_max = unknown;                          ///< the largest |E − E₀|/|E₀| of some fifty rows
  double forces_per_step = unknown;  ///< evaluations of the force at each site in a step, the mean of some fifty steps
  double position_error = unknown, velocity_error = unknown;  ///< of the centre of φ_x²
  double seconds = unknown, seconds_min = unknown,
         seconds_max = unknown;  ///< of the steps, by StepClock: median, least, most
  double seconds_setup = unknown;                                          ///< to build and start it, the first time
  int repeats = 0;           ///< timed runs; 0: the seconds are those of the untimed first
  bool on_envelope = false;  ///< no run of its side, engine or peers, is both cheaper and at least as accurate
};

/// A scheme over its resolutions.
struct WorkPrecisionLine {
  std::string scheme;
  bool peer = false, own = false;
  std::vector<std::size_t> front;            ///< its runs that no other of them beats, from cheap to accurate
  double slope = WorkPrecisionRun::unknown;  ///< of log error over log seconds along the front
  double order = WorkPrecisionRun::unknown;  ///< observed: error ∝ N^−order at a fixed h/k, or steps^−order on a point
};

/// The cost of an accuracy: the cheapest run with at most that error. Nothing is interpolated.
struct WorkPrecisionCost {
  double accuracy = 0;
  /// Indices of runs: of the engine, of peers without a processor; of tuned schemes, of processed peers.
  std::optional<std::size_t> engine, peer, tuned, processed_peer;
  /// Seconds of the peer over seconds of the engine; the same over the tuned scheme; of the processed peer over the engine.
  double ratio = WorkPrecisionRun::unknown, tuned_ratio = ratio, processed_ratio = ratio;
};

/// Everything in workprecision.json, the tables and the figure.
struct WorkPrecisionOutcome {
  std::string status = "done";  ///< or interrupted
  std::string reference;        ///< what errors are measured against, in words
  double reference_error = 0;   ///< how far that may be off; 0 for an exact solution
  std::vector<WorkPrecisionRun> runs;
  std::vector<WorkPrecisionLine> lines;
  std::vector<WorkPrecisionCost> costs;
  struct LeftOut {
    std::string scheme, reason;
  };
  std::vector<LeftOut> left_out;
  std::size_t tried = 0;       ///< resolutions that were run once or more
  bool fewer_repeats = false;  ///< long runs were repeated less often, for the budget
  std::size_t unsteady = 0;    ///< runs of which one round took three times as long as another, or more
  double seconds = 0;          ///< of it all
};

std::string workprecision_json(const Scene&, const WorkPrecisionRequest&, const WorkPrecisionOutcome&);
std::string workprecision_csv(const WorkPrecisionOutcome&);
/// The table by scheme for a paper, as Markdown and as LaTeX.
std::string workprecision_markdown(const Scene&, const WorkPrecisionRequest&, const WorkPrecisionOutcome&);
std::string workprecision_latex(const Scene&, const WorkPrecisionRequest&, const WorkPrecisionOutcome&);
/// The report for the terminal.
std::string workprecision_report(const Scene&, const WorkPrecisionRequest&, const WorkPrecisionOutcome&);
/// Draws `folder`/figures/workprecision; returns what is missing, in one line, or an empty string.
std::string draw_workprecision(const Scene&, const WorkPrecisionOutcome&, const std::filesystem::path& folder);

}  // namespace delf

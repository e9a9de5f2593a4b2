// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "schemes/stepping/step_method.hpp"
#include "tools/outcome/error_estimate.hpp"
#include "tools/outcome/named_number.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

class SavedState;

/// A sum that a symmetry conserves, over the rows that are measured.
struct Conserved {
  std::string name;
  double initial, final;
  double error_max;       ///< the largest |J − J_0|, relative to Σ |terms of J|: the sum itself may be zero
  bool at_walls = false;  ///< ends are no symmetry of it, and give or take it

  /// At a further row; what is not a number, as at row 0 of a start from that row alone, tells nothing.
  void take(double J, double terms);
};

/// The result of a run: everything in summary.json and in the report on stdout.
struct Outcome {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string status = "done";  ///< done, interrupted, no-convergence, not-finite, mesh-crossing or system-failure
  std::string failure;          ///< in words, if it failed
  double break_time = unknown;  ///< of the step that the numerics failed in
  std::string state, solve, solve_kind;
  std::string limit;    ///< of the step, at the start, in words; empty: none is known
  std::string threads;  ///< in words, if the scene asks for more than one
  StartRule start = StartRule::exact;
  int winding = 0;
  std::size_t bytes = 0;

  std::int64_t steps = 0;        ///< the last row
  std::int64_t steps_taken = 0;  ///< without the starting rows
  std::int64_t records = 0;
  std::int64_t updates = 0;  ///< of asynchronous cells
  double time = 0;
  double seconds = 0;                ///< of the steps alone
  double shortest = 0, longest = 0;  ///< step, where steps have lengths of their own
  double iterations_mean = 0, residual_max = 0;
  int iterations_max = 0;
  bool iterates = false;                        ///< a step is not one solve
  std::map<Continued, std::int64_t> continued;  ///< steps that were solved by continuation, by the reason
  double energy_initial = unknown, energy_final = unknown, energy_error_max = unknown;
  std::string energy_of;         ///< what observes the energy of a row, in words; empty: not said
  bool reads_time = false;       ///< the density changes its energy
  double energy_work = unknown;  ///< by this up to the last row, where records tell
  double momentum_initial = unknown, momentum_final = unknown, charge_final = unknown;
  double constraint_max = unknown;  ///< the largest |G|, if the scheme has constraints
  std::string maxima_over;          ///< the rows that these maxima, and those below, are over, in words
  std::vector<double> of_method;    ///< the largest of each monitor of the method, or the least
  std::vector<Conserved> conserved;
  double error_linf = unknown, error_l2 = unknown;
  std::vector<NamedNumber> measures;            ///< measure.NAME
  std::optional<ErrorEstimate> error_estimate;  ///< output.estimate
  std::vector<std::string> warnings;            ///< why the result may be wrong although the status is done

  /// Visits what grows with the run.
  void visit(SavedState&);

  double ns_per_site_step(int sites) const {
    return steps_taken == 0 ? unknown : 1e9 * seconds / (static_cast<double>(steps_taken) * sites);
  }
};

/// The subject of a run, a lattice or a mesh, as summary.json and the report name it.
struct Subject {
  static constexpr double none = Outcome::unknown;

  std::string where;   ///< "a circle of length 40"
  std::string scheme;  ///< in words; empty: the mesh says it
  std::string stencil, method, space;
  int sites = 0;
  std::optional<int> cells = {};                              ///< of a mesh
  double length = none, space_step = none, time_step = none;  ///< without time there is no step
};
Subject subject_of(const Problem&);

/// summary.json; what is not a number is null.
std::string summary_json(const Subject&, const Scene&, const Outcome&);
/// The report for people, in a dozen lines.
std::string report(const Subject&, const Scene&, const Outcome&);
/// "rectangle-symmetric, N = 255, h/k = 0.125"; on a point "midpoint, h = 0.01"
std::string scheme_in_words(const Problem&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/sweep/sweep_request.hpp"
#include "tools/sweep/sweep_row.hpp"
#include "tools/sweep/threshold.hpp"

namespace delf {

/// The results of a sweep: everything in its files, its report and its figure.
struct SweepOutcome {
  std::string scene;
  std::string status = "done";                   ///< or interrupted, or bad-input if no run can have sweep.number
  std::vector<std::vector<std::string>> values;  ///< of the keys, for each row
  std::vector<SweepRow> rows;                    ///< whole ones only
  std::size_t asked = 0, reused = 0;
  std::string number;  ///< that is drawn; empty if there is none
  std::optional<Threshold> threshold;
  double seconds = 0;

  std::size_t done() const;  ///< runs that ended well
};

/// The number that a sweep draws if none is named: the first measure, the error, or the energy's error.
std::string usual_number(const std::vector<SweepRow>&);

std::string sweep_csv(const SweepRequest&, const SweepOutcome&);
std::string sweep_json(const SweepRequest&, const SweepOutcome&);
std::string sweep_report(const SweepRequest&, const SweepOutcome&);
/// True if energies and errors of the runs are shown side by side, over time: of `delf compare`, and where all values
/// are words.
bool is_side_by_side(const SweepRequest&, const SweepOutcome&);
/// Figures over the keys with numbers for values: a line over one, for each value of a key with words; a map over two.
/// Side by side: energies and errors over time, a line for each run. Returns what is missing, in one line.
std::string draw_sweep(const SweepRequest&, const SweepOutcome&, const FigureForm&,
                       const std::filesystem::path& folder);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/scene/scene.hpp"

namespace delf {

/// A run of a sweep: its scene, and the values of the keys that are swept, in their order.
struct SweptRun {
  Scene scene;
  std::vector<std::string> values;
};

/// A request to `delf sweep`, or to `delf compare`.
struct SweepRequest {
  std::filesystem::path file;
  std::vector<Setting> common;                   ///< on the command line, with one value; the same for all runs
  std::vector<std::string> keys;                 ///< that are swept
  std::vector<std::vector<std::string>> values;  ///< of these keys, for each run
  int jobs = 1;
  bool table = false;  ///< keep rows only
  bool resume = true;
  bool compare = false;  ///< show the runs side by side whatever their values are
  std::string number;    ///< that is drawn and bisected; empty: chosen
  struct Bisection {
    double low, high, accuracy;
    std::optional<double> level;
  };
  std::optional<Bisection> bisection;  ///< of the one key

  /// The scene of these values. Throws BadScene.
  SweptRun run(const std::vector<std::string>& values) const;
};

/// Most runs of a sweep: more are a slip of the pen.
inline constexpr std::size_t most_runs = 100000;

/// The values of `a,b,c` or `from:to:step`, as text; one value where it is neither. Throws BadScene for a bad range.
std::vector<std::string> swept_values(const Setting&);

/// Reads the command line and the keys [sweep]. `command` is the one that asks. Throws BadScene.
SweepRequest read_sweep_request(const std::filesystem::path& scene, const std::vector<Setting>& on_command_line,
                                std::string_view command = "sweep");

}  // namespace delf

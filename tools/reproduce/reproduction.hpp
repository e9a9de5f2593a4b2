// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "tools/reproduce/published_result.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// reproduced: as expected; misprint: as corrected; differs: from both, for the reason that the result gives; failed: from
/// both without a reason, or without a number.
enum class Reproduced { yes, misprint, differs, failed };
std::string words_of(Reproduced);

/// A published result beside what this program finds.
struct Reproduction {
  PublishedResult result;
  std::string command;  ///< that finds it
  Reproduced verdict = Reproduced::failed;
  double value;        ///< not a number where there is none
  std::string reason;  ///< for a verdict that is not `yes`
  double seconds = 0;
};

/// The words after `delf` for a result, with the folder that it writes to, and further keys in place of its own. The scene
/// is the shipped one, whatever file of that name the working folder has.
std::vector<std::string> words_for(const PublishedResult&, const std::filesystem::path& folder,
                                   const std::vector<Setting>& keys);
/// The words as a line of shell.
std::string shell_line(const std::vector<std::string>& words);

/// Judges what the command of a result left in its folder, with run.log, all that it printed; `code` is its exit code, and
/// `keys` were given in place of the result's own, which a reason says.
Reproduction judged(const PublishedResult&, const std::vector<std::string>& words, const std::filesystem::path& folder,
                    int code, const std::vector<Setting>& keys);

/// The numbers that a print stands for: 3 with a tolerance, `< 1e-13`, `> 1000`, `1.2 to 1.3`. Throws BadInput.
struct Printed {
  double low, high;
  bool holds(double value) const { return value >= low && value <= high; }
};
Printed numbers_of(const std::string& printed, const std::string& tolerance);

}  // namespace delf

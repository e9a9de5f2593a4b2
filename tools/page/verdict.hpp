// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/results/result_folder.hpp"

namespace delf {

/// The outcome of a command in a sentence, and what there is to say about it.
struct PageVerdict {
  bool good = false;
  std::string sentence;
  std::vector<std::string> points;  ///< warnings, or failed checks with the reasons, the likeliest cause first
};

/// One for each result of the folder.
std::vector<PageVerdict> verdicts_of(const ResultFolder&);

}  // namespace delf

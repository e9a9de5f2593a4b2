// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/results/result_folder.hpp"

namespace delf {

/// A number of summary.json for a page.
struct PageNumber {
  std::string name, value, meaning, worry;  ///< worry: when to
  bool worrying = false;                    ///< it is beyond that
};
/// The numbers of a run that are there, with its measures and what it conserves.
std::vector<PageNumber> numbers_of(const ResultFolder&);

}  // namespace delf

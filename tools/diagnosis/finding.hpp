// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// Something that was found out about rows whose equations fail.
struct Finding {
  std::string kind;  ///< "coefficients", "seam", …
  std::string words;
  /// It explains every failure: nothing more need be looked for.
  bool settles = true;
  /// True if the equations hold with it; else it says how near they come.
  bool exact = true;
};

}  // namespace delf

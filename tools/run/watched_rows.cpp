// SPDX-License-Identifier: MIT
#include "tools/run/watched_rows.hpp"

#include <fmt/format.h>

namespace delf {

std::string WatchedRows::in_words(std::int64_t steps, std::int64_t recorded) const {
  if (steps <= first_ || apart_ == 1 || recorded == 1) return "all steps";
  std::string words = "recorded rows and one row of every " + fmt::to_string(apart_) + ", drawn by run.seed";
  if (first_ > 0) words += first_ == 1 ? "; the first one, too" : fmt::format("; the first {} all", first_);
  return words;
}

}  // namespace delf

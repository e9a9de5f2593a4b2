// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf::bench {

/// Everything but the name of the program; returns the exit code: 0 done, 2 bad options, 3 the numerics
/// failed, 4 out of memory.
int run(const std::vector<std::string>& words);

}  // namespace delf::bench

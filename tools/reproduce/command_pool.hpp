// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"

namespace delf {

/// A command line of this program, and the folder of its results, where run.log gets what it prints.
struct PooledCommand {
  std::vector<std::string> words;
  std::filesystem::path folder;
};

/// Carries out commands, so many side by side, each in a process of its own, and hands the place, the exit code and the
/// seconds of each to `ended` as it ends. After Ctrl-C those under way are given up, and no other begins.
void carry_out_side_by_side(const std::vector<PooledCommand>&, int jobs,
                            ExitCode (*program)(const std::vector<std::string>&),
                            const std::function<void(std::size_t, int, double)>& ended);

}  // namespace delf

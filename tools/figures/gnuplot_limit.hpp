// SPDX-License-Identifier: MIT
#pragma once
#include <chrono>
#include <filesystem>
#include <string>

namespace delf {

/// run_gnuplot(), which is ended after so long.
std::string run_gnuplot_within(std::chrono::milliseconds limit, const std::filesystem::path& folder,
                               const std::string& script);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// `delf reproduce`: computes the published results of these ids, or papers, or all fast ones, each by its own command in a
/// process of its own, and says which come out as expected. `program` carries out the words of a command line; keys that are
/// none of [reproduce] go to every command. Writes results.json, results.csv and report.html into the folder.
ExitCode reproduce(const std::vector<std::string>& names, const std::vector<Setting>& keys,
                   const std::optional<std::string>& out, ExitCode (*program)(const std::vector<std::string>&));

/// A line for each published result.
void list_results();

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

namespace delf::bench {

/// The parsed command line; an empty list stands for the command's own default.
struct Request {
  std::vector<int> sites;
  std::vector<double> tolerances;
  std::vector<std::string> schemes;
  int repeats = 15;

  std::vector<int> sites_or(std::vector<int> own) const { return sites.empty() ? own : sites; }
  std::vector<double> tolerances_or(std::vector<double> own) const { return tolerances.empty() ? own : tolerances; }
  std::vector<std::string> schemes_or(std::vector<std::string> own) const { return schemes.empty() ? own : schemes; }
};

}  // namespace delf::bench

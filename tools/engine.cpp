// SPDX-License-Identifier: MIT
#include "tools/engine.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <new>
#include <stdexcept>

#include "tools/run/in_words.hpp"

namespace delf {

Simulation build(const Scene& scene, int winding) {
  Problem problem = scene.problem;
  problem.winding = winding;
  try {
    return Simulation(problem);
  } catch (const BadInput& bad) {
    throw scene.settings.located(bad);
  }
}

ExitCode with_memory_for(const Scene& scene, const std::function<ExitCode()>& work) {
  constexpr double least_of_a_site = 64;  // rows, increments, work space: no scheme holds less
  const int sites = scene.problem.lattice.sites();
  const double least = least_of_a_site * sites;
  const double there = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  const auto failure = [&] {
    return SystemFailure(
        fmt::format("out of memory: {} sites need {} at least, and this machine has {}; lower "
                    "lattice.sites",
                    sites, bytes_in_words(least), bytes_in_words(there)));
  };
  if (there > 0 && least > there) throw failure();
  try {
    return work();
  } catch (const std::bad_alloc&) {
    throw failure();
  } catch (const std::length_error&) {
    throw failure();
  }
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/rows/engine.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <fstream>
#include <new>
#include <stdexcept>

#include "schemes/stepping/undetermined.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/in_words.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace {

// The number among those given that is farthest from 1, where it is out of all proportion; empty if there is none.
std::string extreme_number(const Settings& settings) {
  double farthest = 60;  // powers of ten: squares and products of two of them still fit
  std::string found;
  for (const Parameter& key : settings.all_keys()) {
    const Setting* s = type_of(key) == KeyType::real ? settings.find(key.key) : nullptr;
    if (!s) continue;
    const double value = std::abs(Values(settings).real(key.key));
    if (const double powers = value > 0 ? std::abs(std::log10(value)) : 0; powers > farthest)
      farthest = powers, found = key.key;
  }
  return found;
}

}  // namespace

Simulation build(const Scene& scene, int winding) {
  Problem problem = scene.problem;
  problem.winding = winding;
  try {
    if (problem.lattice.left() == Wall::clamped || problem.lattice.right() == Wall::clamped)
      InitialRows(scene).keep_slopes(problem);
    return Simulation(problem);
  } catch (const BadInput& bad) {
    if (bad.key() == "theory.name" || bad.key() == "lattice.stencil")  // that no equation is left by rounding
      if (const auto extreme = extreme_number(scene.settings); !extreme.empty())
        throw scene.settings.error(extreme, "the field equations overflow double precision; use a number nearer to 1");
    throw scene.settings.located(bad);
  }
}

namespace {

// The bytes that a run takes for each site, measured on one of the same cells and fewer sites; 0 where there is none.
double bytes_of_a_site(const Scene& scene) {
  constexpr int few = 1 << 14;
  const Lattice& lattice = scene.problem.lattice;
  Problem p = scene.problem;
  p.threads = 1;
  p.lattice = lattice.is_circle() ? Lattice::circle(few, few * lattice.space_step())
                                  : Lattice::interval(few, (few - 1) * lattice.space_step());
  try {
    const Simulation simulation(p);
    // the rows that a start is made of, twice, and those that are checked
    const double rows = 2.0 * simulation.starting_rows() + 2;
    return static_cast<double>(simulation.bytes_of_run({})) / few +
           rows * static_cast<double>(simulation.components().size() * sizeof(double));
  } catch (const BadInput&) {
    return 0;
  }
}

// Bytes that programs may still have, or 0 where the system does not tell.
double available_memory() {
  std::ifstream in("/proc/meminfo");
  std::string name, unit;
  for (double kilobytes = 0; in >> name >> kilobytes; std::getline(in, unit))
    if (name == "MemAvailable:") return 1024 * kilobytes;
  return 0;
}

// Throws SystemFailure for a lattice that the system would end the program for.
void foresee_memory(const Scene& scene) {
  constexpr int many = 1 << 20;
  const Lattice& lattice = scene.problem.lattice;
  if (lattice.space() == Space::point || lattice.sites() < many) return;
  const double free = available_memory(), needed = bytes_of_a_site(scene) * lattice.sites();
  if (free > 0 && needed > free)
    throw SystemFailure(fmt::format("out of memory: {} sites need {}, and {} are free; lower lattice.sites",
                                    lattice.sites(), bytes_in_words(needed), bytes_in_words(free)));
}

}  // namespace

void require_determined(const Scene& scene, const Simulation& simulation) {
  try {
    require_determined(simulation.evolution());
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
  const auto of_work = [&] {
    return SystemFailure(
        fmt::format("out of memory: {} steps of {} asked for more than this machine, with {}, can give now; lower "
                    "lattice.sites, or raise output.every",
                    scene.steps, scheme_in_words(scene.problem), bytes_in_words(there)));
  };
  if (there > 0 && least > there) throw failure();
  try {
    foresee_memory(scene);
    return work();
  } catch (const std::bad_alloc&) {
    throw least > 0.1 * there ? failure() : of_work();
  } catch (const std::length_error&) {
    throw least > 0.1 * there ? failure() : of_work();
  }
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/diagnosis/from_values.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "tools/diagnosis/findings.hpp"

namespace delf {
namespace {

constexpr std::int64_t most_frames = 6;

/// True if the scheme takes frame 0 to those after it.
bool gives(const Problem& p, const Evidence& e, double tolerance) {
  try {
    Simulation simulation(p);
    const auto& components = simulation.components();
    const std::size_t d = simulation.count(Role::field), C = components.size();
    const std::vector<double> first = e.row(0);
    if (simulation.starting_rows() != 1 || d != delf::at(e.system.components())) return false;
    std::vector<double> row(first.size() / d * C);
    for (std::size_t at = 0; at < row.size(); ++at)
      if (const Component& c = components[at % C]; c.role != Role::multiplier)
        row[at] = first[at / C * d + delf::at(c.field)];
    simulation.start({row});
    std::vector<double> found(first.size());
    for (std::int64_t j = 1; j < std::min(e.rows, most_frames + 1); ++j) {
      while (simulation.newest() < j) simulation.step();
      simulation.copy_row(static_cast<int>(simulation.newest() - j), found);
      const std::vector<double> there = e.row(j);
      double size = 0, off = 0;
      for (std::size_t n = 0; n < there.size(); ++n) {
        size = std::max(size, std::abs(there[n]));
        if (const double by = std::abs(found[n] - there[n]); !(by <= off)) off = by;
      }
      if (!(off <= tolerance * size)) return false;
    }
    return true;
  } catch (const BadInput&) {  // not for this theory or space
    return false;
  } catch (const NumericalFailure&) {
    return false;
  }
}

}  // namespace

std::optional<Finding> find_from_values(const Evidence& e) {
  constexpr int most_sites = 64;  // such steps are solved slab by slab
  if (e.rows < 4 || e.system.lattice().sites() > most_sites) return std::nullopt;
  const double tolerance = std::max(10 * e.tolerance, 1e-12);
  for (const NamedScheme& scheme : named_schemes(e.problem)) {
    const auto& starts = find_method(scheme.problem.method).starts;
    if (starts.size() != 1 || starts[0] != StartRule::values || !gives(scheme.problem, e, tolerance)) continue;
    return Finding{
        "from-values",
        fmt::format("A run of {} ({}) from frame 0 alone, with the same value on both sides of the first jump, "
                    "gives the {} frames after it.",
                    scheme.name, keys_of(scheme.problem, e.problem), std::min(e.rows - 1, most_frames))};
  }
  return std::nullopt;
}

}  // namespace delf

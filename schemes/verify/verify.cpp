// SPDX-License-Identifier: MIT
#include "schemes/verify/verify.hpp"

#include <string>

#include "lattice/error.hpp"
#include "schemes/verify/equation_check.hpp"
#include "schemes/verify/form_check.hpp"
#include "schemes/verify/noether_check.hpp"

namespace delf {

std::vector<Check> verify(const LatticeSystem& system, const SolvePlan& plan, const Window& rows,
                          const VerifyOptions& options) {
  std::vector<RegionRequest> regions;
  for (const RegionKind kind : region_kinds()) regions.push_back({to_string(kind), kind, {}});
  const int wanted = FormCheck::rows_wanted(system, plan, regions), given = static_cast<int>(rows.rows.size());
  if (given < wanted)
    throw BadInput("run.steps", "verify: regions of this scheme take " + std::to_string(wanted) +
                                    " rows, and there are " + std::to_string(given) + "; give more");

  EquationCheck equations(system, plan, options.tolerance, options.data_rows);
  for (std::int64_t row = rows.first_row + equations.reach(); row <= rows.last_row() - equations.reach(); ++row)
    equations.at(rows, row);
  std::vector<Check> checks = equations.checks();
  const auto add = [&](const std::vector<Check>& more) { checks.insert(checks.end(), more.begin(), more.end()); };

  std::mt19937_64 random(options.seed);
  FormCheck forms(
      system, plan, given,
      {.regions = regions, .pairs = options.variations, .tolerance = options.tolerance, .monodromy = rows.monodromy});
  forms.at(rows, random);
  add(forms.checks());

  NoetherCheck noether(system, options.symmetries, options.tolerance, false, options.seed);
  noether.at(rows, RegionDrawer(system, forms.solved_rows()), regions, random);
  add(noether.checks());
  return checks;
}

}  // namespace delf

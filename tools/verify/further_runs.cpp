// SPDX-License-Identifier: MIT
#include "tools/verify/further_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "schemes/methods/kernel_alone.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/mirrored_in_time.hpp"
#include "schemes/verify/stress_balance.hpp"
#include "tools/compare/refined_scene.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/rows/section_source.hpp"

namespace delf {

void measure_orders(const Scene& scene, int winding, std::vector<Measured> balances, std::int64_t rows,
                    Verdict& verdict) {
  try {
    if (scene.from_file()) throw BadInput("initial.file", "its rows come from a file");
    const Scene fine = refined(scene);
    const InitialRows initial(fine);
    Simulation simulation = build(fine, winding);
    initial.start(simulation);
    StressBalance balance(simulation.theory(), fine.problem.lattice, fine.problem.time_step,
                          2 * std::numbers::pi * winding + gain_of(fine.problem.parameters));
    ComputedRows source(simulation, 2 * (rows - 1) + 1);
    for (std::int64_t j = 0; auto row = source.next(); ++j) {
      balance.add(j, fields_of(simulation.evolution().system(), *row));
      if (Interrupt::asked()) break;
    }
    balances = with_orders(std::move(balances), balance.results());
  } catch (const Error& error) {
    verdict.left_out.push_back(
        fmt::format("order of the balances: the scene cannot be run at half of its steps ({})", error.what()));
  }
  for (Measured& measured : balances) verdict.measured.push_back(std::move(measured));
}

void reverse_time(const Scene& scene, int winding, const std::vector<std::vector<double>>& first_rows, double tolerance,
                  Verdict& verdict) {
  Scene alone = scene;  // a start applies a kernel's processor, and the state at the turning point has it behind it
  if (build(scene, winding).is_processed()) alone.problem = kernel_alone(scene.problem);
  const auto fresh = [&](std::optional<double> T) {
    Scene seen = alone;
    if (T) seen.problem = mirrored_in_time(seen.problem, *T);
    return std::make_unique<Simulation>(build(seen, winding));
  };
  reverse_time(scene, fresh, first_rows, tolerance, verdict);
}

void reverse_time(const Scene& scene, const MakeSimulation& fresh, const std::vector<std::vector<double>>& first_rows,
                  double tolerance, Verdict& verdict) {
  const bool by_rows = fresh(std::nullopt)->evolution().stepper().layout() != nullptr;
  const std::int64_t most = most_updates / (by_rows ? 1 : 40) / scene.problem.lattice.sites();
  const std::int64_t steps = std::clamp<std::int64_t>(scene.steps, 8, std::max<std::int64_t>(8, most));
  const auto reversal = time_reversal(fresh, first_rows, steps, tolerance);
  if (!reversal) {
    verdict.left_out.emplace_back("time reversal: two rows of fields are not the whole state of this scheme");
    return;
  }
  verdict.reversal = {reversal->steps, reversal->distance};
  if (reversal->promised) verdict.checks.push_back(reversal->check);
  if (reversal->distance.empty()) return;
  constexpr double least = 0.05;  // the fit of a distance that is rounding at any number of steps
  std::string remark = !std::isfinite(reversal->growth)     ? "too few steps to see it grow"
                       : std::abs(reversal->growth) < least ? "does not grow with the steps"
                                                            : fmt::format("grows like steps^{:.2g}", reversal->growth);
  if (!reversal->promised) remark += "; these equations change under t -> -t";
  if (!reversal->end.empty()) remark += "; " + reversal->end;
  verdict.measured.push_back({.name = "time reversal, distance",
                              .region = fmt::format("{} steps forward and back", reversal->steps.back()),
                              .value = reversal->distance.back(),
                              .remark = remark});
}

std::int64_t steps_of_run(const Scene& scene, Simulation& simulation) {
  try {
    while (!scene.is_over(simulation.newest(), simulation.time(simulation.newest())) && !Interrupt::asked())
      simulation.step();
  } catch (const NumericalFailure&) {  // which the rows that are checked will meet again
    return simulation.newest() + 1;
  }
  return simulation.newest();
}

}  // namespace delf

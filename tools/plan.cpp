// SPDX-License-Identifier: MIT
#include "tools/plan.hpp"

#include <fmt/format.h>

#include "tools/engine.hpp"
#include "tools/in_words.hpp"
#include "tools/initial_rows.hpp"
#include "tools/outcome.hpp"

namespace delf {

namespace {

std::string recording(const Scene& scene) {
  if (scene.every == 0) return "the last row only";
  return fmt::format("every {} of {} rows: {} records", scene.every, scene.steps + 1,
                     (scene.steps + scene.every - 1) / scene.every + 1);
}

std::string output(const Scene& scene, std::size_t components) {
  const double records = scene.every == 0 ? 1 : static_cast<double>((scene.steps + scene.every - 1) / scene.every + 1);
  std::string kept = "scene.ini, series.csv, summary.json", left_out;
  if (scene.fields)
    kept += fmt::format(
        ", fields.h5 ({})",
        bytes_in_words(8 * records * (static_cast<double>(components) * scene.problem.lattice.sites() + 1)));
  else left_out += "  left out   fields.h5: HDF5 is not touched\n";
  if (scene.figures) kept += ", figures";
  else left_out += "  left out   figures: no rows are kept for them, and gnuplot is not started\n";
  return fmt::format("  written    {}\n{}", kept, left_out);
}

}  // namespace

ExitCode plan(const Scene& scene) {
  return with_memory_for(scene, [&] {
    const InitialRows initial(scene);
    const Simulation simulation = build(scene, initial.winding());
    initial.check(simulation);
    fmt::print("{}: {}, {}, {} steps to t = {:.6g}\n", scene.name, scene.problem.theory, scheme_in_words(scene.problem),
               scene.steps, static_cast<double>(scene.steps) * scene.problem.time_step);
    fmt::print("  state      {}; row 1 is {}\n", initial.description(),
               initial.rule() == StartRule::exact     ? "known"
               : initial.rule() == StartRule::centred ? "solved for, with y(-1) = y(1) - 2 h phi_t"
                                                      : "solved for, by the discrete Legendre transform");
    fmt::print("  recorded   {}\n{}\n{}", recording(scene), output(scene, simulation.components().size()),
               simulation.plan_report());
    return ExitCode::done;
  });
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "jets/fibre.hpp"
#include "tools/run/in_words.hpp"

namespace delf {

double area_of(const CellSpace& space) {
  double area = 0;
  for (const double A : space.masses) area += A;
  return area;
}

std::string threads_in_words(const ComplexSolver& solver, int asked) {
  if (asked == 1) return {};
  const int shared = solver.shared_levels(), levels = solver.plan().levels;
  const std::string why = fmt::format("a level is shared by parts of {} unknowns or more, in blocks of their own",
                                      ComplexSolver::Options{}.unknowns);
  if (shared == 0) return fmt::format("1 of {}: {}", asked, why);
  return shared == levels ? fmt::to_string(asked)
                          : fmt::format("{} on {} of {} levels: {}", asked, shared, levels, why);
}

std::string summary_json(const ComplexScene& c, const MeshOutcome& o) {
  const Scene& scene = c.scene;
  nlohmann::ordered_json json;
  const auto null = nlohmann::ordered_json();
  const auto of_mesh = [&](const auto& number) { return c.space ? nlohmann::ordered_json(number(*c.space)) : null; };
  json["version"] = DELF_VERSION;
  json["scene"] = scene.name;
  json["status"] = o.status;
  json["failure"] = o.failure.empty() ? null : nlohmann::ordered_json(o.failure);
  json["break_time"] = o.break_time;
  json["break_reason"] = std::isnan(o.break_time) ? null : nlohmann::ordered_json(o.status);
  json["theory"] = scene.problem.theory;
  json["fibre"] = scene.problem.circle_valued ? "S1" : "R";
  json["stencil"] = c.mesh_in_words();
  json["method"] = c.time == MeshTime::cells   ? "asynchronous"
                   : c.time == MeshTime::none  ? "elliptic"
                   : c.time == MeshTime::sites ? "complex"
                                               : scene.problem.method;
  json["space"] = "complex";
  json["length"] = of_mesh(area_of);
  json["sites"] = c.sites();
  json["cells"] = c.cells();
  json["space_step"] = of_mesh([](const CellSpace& space) { return shortest_edge(space.mesh); });
  json["time_step"] = c.is_one_problem() ? null : nlohmann::ordered_json(scene.problem.time_step);
  if (o.longest > 0) json["time_step_min"] = o.shortest, json["time_step_max"] = o.longest;
  json["state"] = o.state;
  json["seed"] = scene.initial.seed;
  json["steps"] = o.steps;
  json["time"] = o.time;
  json["records"] = o.records;
  json["seconds"] = o.seconds;
  json["ns_per_site_step"] = o.ns_per_site_step(c.sites());
  if (c.time == MeshTime::cells) {
    json["updates"] = o.updates;
    json["ns_per_update"] = 1e9 * o.seconds / static_cast<double>(o.updates);
  }
  json["solve"] = o.solve;
  json["solve_kind"] = o.solve_kind;
  json["bytes"] = o.bytes;
  json["iterations_mean"] = o.iterations_mean;
  json["iterations_max"] = o.iterations_max;
  json["residual_max"] = o.residual_max;
  json["energy_initial"] = o.energy_initial;
  json["energy_final"] = o.energy_final;
  json["energy_error_max"] = o.energy_error_max;
  json["constraint_max"] = o.constraint_max;
  auto& conserved = json["conserved"] = nlohmann::ordered_json::array();
  for (const Conserved& sum : o.conserved)
    conserved.push_back(
        {{"name", sum.name}, {"initial", sum.initial}, {"final", sum.final}, {"error_max", sum.error_max}});
  json["error_linf"] = o.error_linf;
  json["error_l2"] = o.error_l2;
  json["warnings"] = scene.warnings;
  for (const std::string& warning : o.warnings) json["warnings"].push_back(warning);
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string report(const ComplexScene& c, const MeshOutcome& o) {
  std::string text = fmt::format("{}: {} on {} {}, {}\n", c.scene.name, c.scene.problem.theory, c.sites(),
                                 c.stencils ? "sites" : "points", c.mesh_in_words());
  const auto line = [&](const char* name, const std::string& what) {
    text += fmt::format("  {:<10} {}\n", name, what);
  };
  line("state", o.state);
  line("solve", o.solve);
  if (!o.threads.empty()) line("threads", o.threads);
  if (!c.is_one_problem())
    line("steps", fmt::format("{} to t = {:.6g}{}", o.steps, o.time,
                              o.longest > 0 ? fmt::format(", {:.4g} to {:.4g} long{}", o.shortest, o.longest,
                                                          c.step_control() ? ", chosen by the field" : "")
                                            : ""));
  if (o.steps_taken > 0)
    line("speed", fmt::format("{} for the steps, {}", duration_in_words(o.seconds),
                              cost_in_words(o.ns_per_site_step(c.sites()))));
  if (o.updates > 0)
    line("speed", fmt::format("{} for {} updates of cells, {:.4g} ns an update", duration_in_words(o.seconds),
                              o.updates, 1e9 * o.seconds / static_cast<double>(o.updates)));
  if (o.iterations_max > 1)
    line("iterations", fmt::format("{:.3g} a step, {} at most", o.iterations_mean, o.iterations_max));
  line("residual", std::isfinite(o.residual_max)
                       ? fmt::format("{:.2g} at most, relative to the terms of the equations", o.residual_max)
                       : "not measured; `delf verify` does");
  if (std::isfinite(o.energy_final))
    line("energy", fmt::format("{:.10g}{}", o.energy_final,
                               std::isfinite(o.energy_error_max)
                                   ? fmt::format("; relative error {:.3g} at most", o.energy_error_max)
                                   : ""));
  for (const Conserved& sum : o.conserved)
    line("conserved", fmt::format("{} = {:.10g}; error {:.3g} at most", sum.name, sum.final, sum.error_max));
  if (std::isfinite(o.constraint_max)) line("constraint", fmt::format("{:.3g} at most", o.constraint_max));
  if (std::isfinite(o.error_linf))
    line("error",
         fmt::format("{:.4g} in the maximum norm, {:.4g} in L2, against the exact solution", o.error_linf, o.error_l2));
  for (const std::string& warning : o.warnings) line("warning", warning);
  line("status", o.status);
  return text;
}

void measure_error(const ComplexScene& c, std::span<const double> values, double t, Outcome& o) {
  if (!c.has_solution()) return;
  const std::vector<double> exact = c.solution(t);
  const std::size_t d = c.fields.size();
  o.error_linf = 0;
  double sum = 0;
  for (std::size_t n = 0; n < exact.size(); ++n) {
    const double apart = values[n] - exact[n];
    const double error = std::abs(c.scene.problem.circle_valued ? wrap(apart) : apart);
    o.error_linf = std::max(o.error_linf, error);
    sum += (c.space ? c.space->masses[n / d] : 1 / static_cast<double>(c.sites())) * error * error;
  }
  o.error_l2 = std::sqrt(sum);
}

}  // namespace delf

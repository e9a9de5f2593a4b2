// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "schemes/driven_ends.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/in_words.hpp"

namespace delf {

std::string scheme_in_words(const Problem& p) {
  const std::string scheme = scheme_label(p);
  if (p.lattice.space() == Space::point) return fmt::format("{}, h = {:.6g}", scheme, p.time_step);
  return fmt::format("{}, N = {}, h/k = {:.4g}", scheme, p.lattice.sites(), p.time_step / p.lattice.space_step());
}

Subject subject_of(const Problem& p) {
  const Space space = p.lattice.space();
  Subject subject;
  subject.where =
      space == Space::point
          ? "a point"
          : fmt::format("{} of length {:g}", p.lattice.is_circle() ? "a circle" : "an interval", p.lattice.length());
  subject.scheme = scheme_in_words(p) + (space == Space::point ? "" : fmt::format(", h = {:.6g}", p.time_step));
  subject.stencil = p.stencil;
  subject.method = p.method;
  subject.space = space == Space::point ? "point" : p.lattice.is_circle() ? "circle" : "interval";
  subject.sites = p.lattice.sites();
  subject.length = p.lattice.length();
  subject.space_step = p.lattice.space_step();
  subject.time_step = p.time_step;
  return subject;
}

/// The energy of the last row, its observer, and what it is compared with.
std::string energy_in_words(const Outcome& o) {
  std::string words = fmt::format("{:.10g}", o.energy_final);
  if (!o.energy_of.empty()) words += fmt::format(" of row {}, by {}", o.steps, o.energy_of);
  // There is no error relative to an energy of zero, and none against row 0 where the density does work.
  if (o.reads_time)
    return words + "; the density reads t" +
           (std::isfinite(o.energy_work) ? fmt::format(", and its work is {:.4g} of that", o.energy_work)
                                         : ", whose work more records would tell");
  if (!std::isfinite(o.energy_error_max)) return words;
  words += fmt::format("; relative error {:.3g} at most", o.energy_error_max);
  for (const Conserved& c : o.conserved)
    if (c.name.starts_with("energy_own") && c.error_max < 0.1 * o.energy_error_max)
      words += fmt::format(", and of the scheme's own, energy_own, {:.3g}", c.error_max);
  return words;
}

std::string report(const Subject& subject, const Scene& scene, const Outcome& o) {
  const Problem& p = scene.problem;
  std::string text =
      fmt::format("{}: {} on {}{}\n", scene.name, p.theory, subject.where, p.circle_valued ? ", values in S1" : "");
  const auto line = [&](const char* name, const std::string& what) {
    text += fmt::format("  {:<10} {}\n", name, what);
  };
  line("state", o.state);
  if (!subject.scheme.empty()) line("scheme", subject.scheme);
  line("solve", o.solve);
  if (!o.limit.empty()) line("limit", o.limit + ", at the start");
  if (!std::isnan(subject.time_step))
    line("steps", fmt::format("{} to t = {:.6g}{}", o.steps, o.time,
                              o.longest > 0 ? fmt::format(", {:.4g} to {:.4g} long{}", o.shortest, o.longest,
                                                          p.step_control ? ", chosen by the field" : "")
                                            : ""));
  if (o.steps_taken > 0)
    line("speed", fmt::format("{} for the steps, {}", duration_in_words(o.seconds),
                              cost_in_words(o.ns_per_site_step(subject.sites))));
  if (o.updates > 0)
    line("updates",
         fmt::format("{} of cells, {:.4g} ns each", o.updates, 1e9 * o.seconds / static_cast<double>(o.updates)));
  if (!o.threads.empty()) line("threads", o.threads);
  if (o.updates == 0)
    line("iterations", o.iterations_max == 0 ? "none"
                       : std::isnan(subject.time_step)
                           ? fmt::to_string(o.iterations_max)
                           : fmt::format("{:.3g} a step, {} at most", o.iterations_mean, o.iterations_max));
  for (const auto& [why, steps] : o.continued)
    line("continued", fmt::format("{} of {} steps took Newton's method: {}", steps, o.steps_taken, in_words(why)));
  // Two measures: of the equations, and of the field.
  line("residual",
       std::isnan(o.residual_max)
           ? "not measured; `delf verify` does"
           : fmt::format(
                 "{:.2g} at most, relative to the terms of the equations{}", o.residual_max,
                 o.iterates ? fmt::format("; scheme.tolerance = {:.3g} is of the last change of the field", p.tolerance)
                            : ""));
  if (std::isfinite(o.energy_final)) line("energy", energy_in_words(o));
  for (const Conserved& c : o.conserved)
    if (c.at_walls)
      line("at walls", fmt::format("{} = {:.10g}; {}", c.name, c.final,
                                   has_driven_boundary(p) ? "the ends give or take it" : "fixed walls take it"));
    else if (std::isfinite(c.final))
      line("conserved", fmt::format("{} = {:.10g}; error {:.3g} at most", c.name, c.final, c.error_max));
  if (std::isfinite(o.constraint_max)) line("constraint", fmt::format("{:.3g} at most", o.constraint_max));
  if (!o.maxima_over.empty()) line("maxima", "of " + o.maxima_over);
  if (std::isfinite(o.error_linf))
    line("error",
         fmt::format("{:.4g} in the maximum norm, {:.4g} in L2, against the exact solution", o.error_linf, o.error_l2));
  for (const NamedNumber& m : o.measures) line("measure", fmt::format("{} = {:.10g}", m.name, m.value));
  if (o.error_estimate)
    for (const std::string& estimated : in_words(*o.error_estimate)) line("estimate", estimated);
  for (const std::string& warning : o.warnings) line("warning", warning);
  line("status", o.status);
  return text;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/complex/mesh_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "jets/fibre.hpp"

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

Subject subject_of(const ComplexScene& c) {
  Subject subject;
  const std::string shape = c.topology_in_words();
  subject.where = fmt::format("{} {}, {}{}{}", c.sites(), c.stencils ? "sites" : "points", c.mesh_in_words(),
                              shape.empty() ? "" : "; ", shape);
  if (c.has_method()) subject.where += "; " + scheme_label(c.problem_on_mesh());
  subject.stencil = c.mesh_in_words();
  subject.method = c.time == MeshTime::cells   ? "asynchronous"
                   : c.time == MeshTime::none  ? "elliptic"
                   : c.time == MeshTime::sites ? "complex"
                                               : c.scene.problem.method;
  subject.space = "complex";
  subject.sites = c.sites();
  subject.cells = c.cells();
  if (c.space) subject.length = area_of(*c.space), subject.space_step = shortest_edge(c.space->mesh);
  if (!c.is_one_problem()) subject.time_step = c.scene.problem.time_step;
  return subject;
}

std::string scheme_in_words(const ComplexScene& c) {
  const double h = c.scene.problem.time_step, k = c.space ? shortest_edge(c.space->mesh) : 1;
  return fmt::format("{}, N = {}, h/k = {:.4g}, h = {:.6g}",
                     c.has_method() ? scheme_label(c.scene.problem) : c.mesh_in_words(), c.sites(), h / k, h);
}

FieldError error_on(const ComplexScene& c, std::span<const double> values, std::span<const double> others) {
  const std::size_t d = c.fields.size();
  double largest = 0, sum = 0;
  for (std::size_t n = 0; n < std::min(values.size(), others.size()); ++n) {
    const double apart = values[n] - others[n], error = std::abs(c.scene.problem.circle_valued ? wrap(apart) : apart);
    largest = std::max(largest, error);
    sum += (c.space ? c.space->masses[n / d] : 1 / static_cast<double>(c.sites())) * error * error;
  }
  return {largest, std::sqrt(sum)};
}

void measure_error(const ComplexScene& c, std::span<const double> values, double t, Outcome& o) {
  if (!c.has_solution()) return;
  const FieldError error = error_on(c, values, c.solution(t));
  o.error_linf = error.linf, o.error_l2 = error.l2;
}

}  // namespace delf

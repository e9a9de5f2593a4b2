// SPDX-License-Identifier: MIT
#include "schemes/stepping/plan_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "schemes/stability/constraint_ghost.hpp"
#include "schemes/stepping/bytes_in_words.hpp"
#include "schemes/stepping/gauge.hpp"

namespace delf {
namespace {

/// Rows of the table are times, the latest on top; columns are sites. Nonlinear coefficients are marked: the number is
/// that of the constant part.
void append_table(std::string& out, const LatticeSystem& system, Site site, const char* title) {
  if (system.components() > 1) return;  // one table for each pair of components is no table
  const auto coefficients = system.linearised(site, 0);
  if (coefficients.empty()) return;
  const auto [first_t, last_t] = std::ranges::minmax(coefficients, {}, [](auto& c) { return c.offset.time; });
  const auto [first_x, last_x] = std::ranges::minmax(coefficients, {}, [](auto& c) { return c.offset.space; });
  const double scale = system.time_step() * system.lattice().space_step();
  const bool linear = std::ranges::all_of(coefficients, [](auto& c) { return c.dependence == Dependence::linear; });
  out += fmt::format("\nlinearised field equation{}, divided by hk{}\n", title,
                     linear ? "" : "; n: plus what the nonlinear part adds");
  out += fmt::format("  {:>8}", "");
  for (int x = first_x.offset.space; x <= last_x.offset.space; ++x)
    out += fmt::format("{:>15}", fmt::format("i{:+d}", x));
  out += '\n';
  for (int t = last_t.offset.time; t >= first_t.offset.time; --t) {
    out += fmt::format("  {:>8}", fmt::format("j{:+d}", t));
    for (int x = first_x.offset.space; x <= last_x.offset.space; ++x) {
      const auto it = std::ranges::find_if(coefficients, [&](const Coefficient& c) {
        return c.offset == Site{t, x} && c.component == 0;
      });
      if (it == coefficients.end()) out += fmt::format("{:>15}", ".");
      else out += fmt::format("{:>13.6g}{:<2}", it->value / scale, it->dependence == Dependence::nonlinear ? " n" : "");
    }
    out += '\n';
  }
}

const char* in_words(Placement placement) {
  switch (placement) {
    case Placement::every_site:
      break;
    case Placement::brick_wall:
      return " in a brick wall";
    case Placement::left_wall:
      return " at the left wall";
    case Placement::right_wall:
      return " at the right wall";
    case Placement::left_mirror:
      return " at the left wall, pairs with mirror images";
    case Placement::right_mirror:
      return " at the right wall, pairs with mirror images";
  }
  return "";
}

}  // namespace

std::string solve_in_words(const SolvePlan& plan, const Stepper& stepper) {
  std::string words = plan.describe();
  const StepReport report = stepper.report(false);
  const std::string& solver = report.solver;
  if (!report.follows_plan) return solver;
  if (plan.kind == SolveKind::explicit_ && !stepper.iterates())
    return words + "; solved at once, no iteration" +
           (stepper.is_processed() ? "; rows of a kernel, processed where recorded" : "");
  if (!stepper.iterates() && !stepper.layout()) return words + "; " + solver;
  if (!stepper.layout()) return words + "; Newton's method: " + solver;
  words += stepper.iterates() ? "; iterated with the constant part: " : "; solved at once, no iteration: ";
  return words + solver;
}

std::string plan_report(const LatticeSystem& system, const SolvePlan& plan, const Stepper& stepper,
                        std::size_t monitor_bytes) {
  std::string out;
  const StepReport asked = stepper.report(true);
  const std::string& solver = asked.solver;
  const Lattice& lattice = system.lattice();
  out += fmt::format("lattice      {} {} on {}, k = {:.10g}, h = {:.10g}, h/k = {:.6g}\n", lattice.sites(),
                     lattice.sites() == 1 ? "site" : "sites",
                     lattice.is_circle()               ? "a circle"
                     : lattice.space() == Space::point ? "a point"
                     : lattice.space() == Space::mesh  ? "a mesh"
                                                       : "an interval with both walls",
                     lattice.space_step(), system.time_step(), system.time_step() / lattice.space_step());
  if (system.components() > 1) {
    out += "components  ";
    for (const Component& c : system.all_components())
      out += fmt::format(" {}{}", c.name,
                         c.role == Role::field   ? ""
                         : c.role == Role::inner ? " (inner node)"
                                                 : fmt::format(" ({})", to_string(c.role)));
    out += '\n';
  }
  std::string last;  // families of one kind, such as those of the nodes of an element, are one line
  int equal = 1;
  const auto finish = [&] {
    if (equal > 1) last.insert(last.find('\n'), fmt::format("  ({} of them)", equal));
    out += last;
    equal = 1;
  };
  for (const auto& family : system.families()) {
    std::string one = "stencil      ";
    std::vector<std::pair<int, int>> sites;  // each once, however many nodes of its cell there are
    for (const Site& v : family->pattern().vertices)
      if (std::ranges::find(sites, std::pair(v.time, v.space)) == sites.end()) sites.emplace_back(v.time, v.space);
    for (const auto& [time, space] : sites) one += fmt::format("({:+d},{:+d}) ", time, space);
    one += in_words(family->pattern().placement);
    one += family->is_variational() ? "\nresidual     dL/dy of a discrete Lagrangian\n"
                                    : "\nresidual     given directly: no Lagrangian, not multisymplectic\n";
    if (one == last) {
      ++equal;
      continue;
    }
    finish();
    last = one;
  }
  finish();
  std::istringstream lines(plan.report());
  const char* head = "solve        ";
  for (std::string line; std::getline(lines, line); head = "             ") out += head + line + '\n';
  if (const std::vector<int> means = undetermined_means(system, plan); !means.empty())
    out += fmt::format("gauge        {}; site 0 has no equation{}, which the others imply\n",
                       gauge_in_words(system, means),
                       static_cast<int>(means.size()) < system.components() ? " of it" : "");
  if (!stepper.iterates() && !stepper.layout()) out += "step         " + solver + '\n';
  else if (!stepper.layout())
    out +=
        "step         extrapolated seed; Newton's method slab by slab, block after block; a factored Jacobian is kept\n"
        "             while it contracts by ten; else exit 3\n";
  else
    out += stepper.iterates() ? "step         extrapolated seed; simplified Newton with the constant part while it "
                                "contracts; else the root is\n"
                                "             followed from a small h by full Newton steps; else exit 3\n"
                              : "step         one solve, no iteration\n";
  out += fmt::format("matrix       {}{}\n", stepper.matrix_free() ? "none: " : "", solver);
  const Site bulk{0, lattice.sites() / 2 / 2 * 2};
  if (system.placement() == Placement::brick_wall) {
    append_table(out, system, bulk, " where i + j is even");
    append_table(out, system, {bulk.time, bulk.space + 1}, " where i + j is odd");
  } else {
    append_table(out, system, bulk, "");
  }
  if (!lattice.is_circle() && lattice.space() != Space::mesh)
    for (int i : {0, lattice.sites() - 1})
      append_table(out, system, {0, i}, i == 0 ? " at the left wall" : " at the right wall");
  if (const auto ghost = ghost_under_constraint(system))
    out += fmt::format("\nghost        {};\n             {}\n", in_words_under_constraint(*ghost),
                       without_ghost_under_constraint);
  const std::size_t all = asked.bytes + asked.bytes_to_come + monitor_bytes;
  out += fmt::format("\nmemory       {}, {} bytes: {}, monitors {} B\n", bytes_in_words(all), all, asked.memory,
                     monitor_bytes);
  if (!stepper.layout() && stepper.report(false).bytes_to_come > 0 && solver.find("sparse") != std::string::npos)
    out += "             besides the sparse LU, whose size is known when it is there\n";
  out += "left out     ";
  std::vector<std::string> absent;
  if (!stepper.iterates()) absent.push_back("iterations and seeds");
  if (stepper.matrix_free()) absent.push_back("any matrix");
  if (plan.linear) absent.push_back("the density (its constant Hessian is enough)");
  if (std::ranges::none_of(system.families(), [](const auto& f) { return f->is_placed(); }))
    absent.push_back("positions of sites");
  if (stepper.layout()) absent.push_back("Jacobians of the full Newton method, until a step needs one");
  if (std::ranges::none_of(system.all_components(), [](const auto& c) { return c.role == Role::multiplier; }))
    absent.push_back("constraints and multipliers");
  if (std::ranges::none_of(system.all_components(), [](const auto& c) { return c.role == Role::inner; }))
    absent.push_back("nodes inside cells");
  absent.push_back("monitors between recorded rows");
  for (std::size_t i = 0; i < absent.size(); ++i) out += (i ? ", " : "") + absent[i];
  return out + '\n';
}

}  // namespace delf

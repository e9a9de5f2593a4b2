// SPDX-License-Identifier: MIT
#include "tools/report/modified.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <vector>

#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/report/equations.hpp"

namespace delf {
namespace {

using expressions::Notation;

[[noreturn]] void refuse(const std::string& key, const std::string& value, const std::string& reason) {
  throw BadInput(key, fmt::format("{} = {}: has no modified Lagrangian, for {}", key, value, reason));
}

/// Work on a density whose terms may be too many.
auto within_a_page(const auto& work) {
  try {
    return work();
  } catch (const expressions::TooLarge&) {
    throw BadInput("theory.density",
                   "the terms of its modified Lagrangian fill more than a page; ask for a lower order, down to 2");
  }
}

/// The one family that the action is made of; those of walls are its terms at the ends.
const DensityOnTable& action_of(const Problem& p, const Simulation& simulation) {
  const auto families = simulation.evolution().system().families();
  const DensityOnTable* of = families[0]->made_of();
  const bool alone =
      std::ranges::all_of(families.subspan(1), [](const auto& family) { return family->pattern().is_of_wall(); });
  if (!families[0]->is_variational())
    refuse("scheme.method", p.method, "its equations are no derivatives of an action; use a variational method");
  if (!of) refuse("scheme.method", p.method, "its action is no density on a table; use multisymplectic or composition");
  if (!alone)
    refuse("scheme.method", p.method,
           "its action has other parts beside the density, such as multipliers; use multisymplectic or composition");
  if (of->density != simulation.theory().shared_density())
    refuse("scheme.method", p.method, "it adds terms to the density; use multisymplectic or composition");
  return *of;
}

/// h^2*k^2
std::string step_powers(const ModifiedLagrangian::Part& part, Notation notation) {
  std::string text;
  for (const auto& [letter, exponent] : {std::pair{'h', part.in_h}, {'k', part.in_k}}) {
    if (exponent == 0) continue;
    if (!text.empty()) text += notation == Notation::plain ? "*" : " ";
    text += letter;
    if (exponent > 1)
      text += notation == Notation::plain ? fmt::format("^{}", exponent) : fmt::format("^{{{}}}", exponent);
  }
  return text;
}

std::string scale_in_latex(const ModifiedLagrangian::Part& part) {
  const std::string scale = step_powers(part, Notation::latex);
  return part.denominator == 1 ? scale : fmt::format("\\frac{{{}}}{{{}}}", scale, part.denominator);
}

/// h^2/24*(…); the term without h and k as it is.
std::string term_of(const ModifiedLagrangian::Part& part, Notation notation) {
  std::string scale = step_powers(part, notation);
  if (scale.empty()) return part.numerator;
  if (notation == Notation::latex) return fmt::format("{}\\bigl({}\\bigr)", scale_in_latex(part), part.numerator);
  if (part.denominator != 1) scale += fmt::format("/{}", part.denominator);
  return fmt::format("{}*({})", scale, part.numerator);
}

std::string sum_of(const std::vector<ModifiedLagrangian::Part>& parts, Notation notation) {
  std::string text;
  for (const ModifiedLagrangian::Part& part : parts) text += (text.empty() ? "" : " + ") + term_of(part, notation);
  return text;
}

}  // namespace

ModifiedLagrangian modified_lagrangian(const Problem& p, const Simulation& simulation, int order) {
  if (simulation.theory().constraint())
    throw BadInput(
        "theory.constraint",
        "theory.constraint: fields that multipliers hold to a constraint have no modified Lagrangian; take a "
        "theory without one, such as that of an angle");
  if (p.lattice.space() == Space::mesh)
    refuse("lattice.space", "mesh", "its cells differ; use circle, interval or point");
  if (p.step_control || !p.time_steps.empty())
    refuse("lattice.time_steps", p.step_control ? "reversible" : "a list", "its steps differ; use lattice.time_step");
  if (p.cell_courant != 0)
    refuse("lattice.cell_courant", fmt::format("{}", p.cell_courant), "its cells step by themselves");
  const auto density = text_of(p, simulation.theory());
  if (!density)
    throw BadInput("theory.name",
                   fmt::format("theory.name = {}: is compiled, and has no formula to expand; write it as "
                               "theory.density for --modified",
                               p.theory));
  const DensityOnTable& of = action_of(p, simulation);
  return within_a_page([&] { return ModifiedLagrangian(*density, of.table, order); });
}

ModifiedEnergy modified_energy(const Problem& p, const Simulation& simulation, int order, double gain) {
  ModifiedLagrangian modified = modified_lagrangian(p, simulation, order);
  return within_a_page([&] {
    return ModifiedEnergy(std::move(modified), action_of(p, simulation).table, simulation.count(Role::field),
                          p.time_step, p.lattice, gain);
  });
}

std::string modified_in_words(ModifiedLagrangian& modified, const SymbolicDensity& density) {
  constexpr std::size_t indent = 13;
  std::string text;
  const char* head = "  modified   ";
  for (const ModifiedLagrangian::Part& part : within_a_page([&] { return modified.parts(Notation::plain); })) {
    const bool first = step_powers(part, Notation::plain).empty();
    const std::string scale =
        first ? "" : fmt::format("+ {}", term_of({part.in_h, part.in_k, part.denominator, ""}, Notation::plain));
    // h^2/24*( … ) with its lines under the bracket
    const std::size_t opened = first ? 0 : scale.size() - 1;
    text += head + scale.substr(0, opened) + broken(part.numerator, indent + opened) + (first ? "\n" : ")\n");
    head = "             ";
  }
  for (int a = 0; a < static_cast<int>(density.names().fields.size()); ++a)
    if (const auto parts = modified.between_kinds(a, Notation::plain); !parts.empty()) {
      const std::string& name = density.names().fields[at(a)];
      text += fmt::format("  sites      {0} + d where i + j is even, {0} - d where it is odd, d = {1}\n", name,
                          broken(sum_of(parts, Notation::plain), indent));
    }
  return text;
}

std::string modified_in_latex(ModifiedLagrangian& modified, const SymbolicDensity& density) {
  constexpr std::size_t width = 180;  // of the source
  std::vector<std::string> lines;
  for (const ModifiedLagrangian::Part& part : within_a_page([&] { return modified.parts(Notation::latex); })) {
    const std::vector<std::string> terms = lines_of_terms(part.numerator, width);
    const std::string scale = scale_in_latex(part);
    for (std::size_t n = 0; n < terms.size(); ++n) {
      std::string line = n > 0 ? "\\qquad" : scale.empty() ? "\\tilde\\ell = " : "\\quad + " + scale + "\\bigl(";
      line += terms[n];
      if (n + 1 == terms.size() && !scale.empty()) line += "\\bigr)";
      lines.push_back(std::move(line));
    }
  }
  std::string text =
      fmt::format("\\[\n  \\begin{{aligned}}\n  &{}\n  \\end{{aligned}}\n\\]\n", fmt::join(lines, " \\\\\n  &"));
  for (int a = 0; a < static_cast<int>(density.names().fields.size()); ++a)
    if (const auto parts = modified.between_kinds(a, Notation::latex); !parts.empty()) {
      const std::string name = expressions::latex_name(density.names().fields[at(a)]);
      text += displayed(fmt::format("{0}_i^j = {0} + (-1)^{{i+j}} \\delta, \\quad \\delta = {1}", name,
                                    sum_of(parts, Notation::latex)));
    }
  return text;
}

}  // namespace delf

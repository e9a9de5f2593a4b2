// SPDX-License-Identifier: MIT
#include "tools/report/equations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "jets/expressions/equations.hpp"
#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/theories/theory_text.hpp"

namespace delf {
namespace {

using expressions::Notation;

/// The table of the stencil that the method solves the equations of; null for methods that do not read lattice.stencil.
const StencilTable* table_of(const Problem& p, const Simulation& simulation) {
  if (!find_method(p.method).reads_stencil) return nullptr;
  const DensityOnTable* jets = simulation.evolution().system().families()[0]->made_of();
  return jets ? &jets->table : nullptr;
}

/// The letters of MathML that are seen: those outside of tags.
std::size_t seen_letters(std::string_view mathml) {
  std::size_t letters = 0;
  bool in_tag = false;
  for (const char c : mathml)
    if (c == '<') in_tag = true;
    else if (c == '>') in_tag = false;
    else if (!in_tag && (c & 0xC0) != 0x80) ++letters;  // the first byte of each code point
  return letters;
}

/// A displayed formula in MathML, broken between the terms that begin lines of its text.
std::string displayed_in_mathml(const std::string& formula) {
  constexpr std::size_t width = 90;  // of letters, most of which are small indices
  std::vector<std::string> lines{""};
  for (std::size_t begin = 0; begin < formula.size();) {
    const std::size_t end = std::min(formula.find('\n', begin), formula.size());
    const std::string term = formula.substr(begin, end - begin);
    if (!lines.back().empty() && seen_letters(lines.back()) + seen_letters(term) > width) lines.emplace_back();
    lines.back() += term;
    begin = end + 1;
  }
  if (lines.size() == 1) return fmt::format("<math display=\"block\"><mrow>{}</mrow></math>", lines[0]);
  std::string rows;
  for (const std::string& line : lines) rows += fmt::format("<mtr><mtd><mrow>{}</mrow></mtd></mtr>", line);
  return fmt::format("<math display=\"block\"><mtable displaystyle=\"true\">{}</mtable></math>", rows);
}

/// A formula of its own in a notation.
std::string displayed_in(Notation notation, const std::string& formula) {
  constexpr std::size_t indent = 4;
  return notation == Notation::latex    ? displayed(formula)
         : notation == Notation::mathml ? displayed_in_mathml(formula)
                                        : std::string(indent, ' ') + broken(formula, indent) + "\n";
}

std::optional<DisplayedEquations> equations_on(const StencilTable* table, Notation notation, const Problem& p,
                                               const FieldTheory& theory) {
  const auto density = text_of(p, theory);
  if (!density) return std::nullopt;
  const char* const is = notation == Notation::latex    ? "\\ell = "
                         : notation == Notation::mathml ? "<mi>ℓ</mi><mo>=</mo>"
                                                        : "l = ";
  DisplayedEquations shown{displayed_in(notation, is + density_formula(*density, notation)), {}, {}};
  for (const std::string& equation : field_equations(*density, notation))
    shown.of_fields.push_back(displayed_in(notation, equation));
  if (table)
    for (const std::string& equation : discrete_field_equations(*density, *table, notation))
      shown.discrete.push_back(displayed_in(notation, equation));
  return shown;
}

}  // namespace

std::shared_ptr<const SymbolicDensity> text_of(const Problem& p, const FieldTheory& theory) {
  const std::shared_ptr<const BatchDensity>& density = theory.shared_density();
  if (const SymbolicDensity* own = density->formula()) return {density, own};
  return text_of(p.theory, p.parameters);
}

std::vector<std::string> lines_of_terms(const std::string& sum, std::size_t width) {
  std::vector<std::string> lines{""};
  std::size_t begin = 0;
  int depth = 0;
  const auto put = [&](std::size_t end) {
    if (!lines.back().empty() && lines.back().size() + end - begin > width) lines.emplace_back();
    lines.back().append(sum, begin, end - begin);
    begin = end;
  };
  for (std::size_t i = 0; i < sum.size(); ++i) {
    if (sum[i] == '(' || sum[i] == '{') ++depth;
    if (sum[i] == ')' || sum[i] == '}') --depth;
    const bool between =
        sum[i] == ' ' && i + 2 < sum.size() && sum[i + 2] == ' ' && (sum[i + 1] == '+' || sum[i + 1] == '-');
    if (depth == 0 && between) put(i);
  }
  put(sum.size());
  return lines;
}

std::string broken(const std::string& sum, std::size_t indent) {
  constexpr std::size_t width = 110;
  return fmt::format("{}", fmt::join(lines_of_terms(sum, width - indent), "\n" + std::string(indent, ' ')));
}

std::string displayed(const std::string& formula) {
  constexpr std::size_t width = 220;  // of the source: indices and fractions take little room on paper
  const std::vector<std::string> lines = lines_of_terms(formula, width);
  if (lines.size() == 1) return fmt::format("\\[\n  {}\n\\]\n", formula);
  return fmt::format("\\[\n  \\begin{{aligned}}\n  &{}\n  \\end{{aligned}}\n\\]\n",
                     fmt::join(lines, " \\\\\n  &\\quad"));
}

std::string equations_in_words(const Problem& p, const Simulation& simulation) {
  constexpr std::size_t indent = 13;
  const auto density = text_of(p, simulation.theory());
  const bool is_compiled = density.get() != &simulation.theory().density();
  const StencilTable* table = table_of(p, simulation);
  std::string text;
  if (table && p.stencil == stencil_as_text) {
    // The stencil as it is given: the family of a density of t and x may have cut its points.
    constexpr auto sites = "stencil.sites", point = "stencil.point";
    const StencilTable given =
        stencil_of(p.parameters.get<std::string>(sites), p.parameters.get<std::string>(point), sites, point);
    text += fmt::format("  stencil    {} sites, {} point{}; consistent, of order {} in h and k for linear equations\n",
                        given.pattern.size(), given.points.size(), given.points.size() == 1 ? "" : "s",
                        order_of_consistency(given));
  }
  if (is_compiled) text += fmt::format("  equations  {}\n", find_theory(p.theory).formula);
  if (!density) return text;
  const auto add = [&](const char* head, const std::string& formula) {
    text += fmt::format("  {:<{}}{}\n", head, indent - 2, broken(formula, indent));
  };
  add("density", density->text());
  if (!is_compiled)
    for (const std::string& equation : field_equations(*density, Notation::plain)) add("equations", equation);
  if (table)
    for (const std::string& equation : discrete_field_equations(*density, *table, Notation::plain))
      add("at (j,i)", equation);
  return text;
}

std::string equations_in_latex(const Problem& p, const Simulation& simulation) {
  const auto equations = equations_in(Notation::latex, p, simulation);
  if (!equations)
    throw BadInput("theory.name",
                   fmt::format("theory.name = {}: is compiled, and has no formulas to print; write it as "
                               "theory.density for --latex",
                               p.theory));
  return fmt::format("{}{}{}", equations->density, fmt::join(equations->of_fields, ""),
                     fmt::join(equations->discrete, ""));
}

std::optional<DisplayedEquations> equations_in(Notation notation, const Problem& p, const Simulation& simulation) {
  return equations_on(table_of(p, simulation), notation, p, simulation.theory());
}

std::optional<DisplayedEquations> equations_in(Notation notation, const Problem& p, const FieldTheory& theory) {
  return equations_on(nullptr, notation, p, theory);
}

}  // namespace delf

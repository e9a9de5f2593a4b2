// SPDX-License-Identifier: MIT
#include "tools/cite/theory_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <regex>
#include <utility>

#include "jets/expressions/print.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/declared.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/theories/theory_text.hpp"
#include "tools/cite/state_formulas.hpp"
#include "tools/scene/values.hpp"

namespace delf {
namespace {

constexpr auto density_key = "theory.density", constraint_key = "theory.constraint", sources_key = "cite.sources";

/// The text of a theory of the registry; null if it has none, as the solar system.
const TheoryText* text_of_entry(const std::string& theory) {
  const auto found = std::ranges::find(theory_texts(), theory, &TheoryText::theory);
  return found == theory_texts().end() ? nullptr : &*found;
}

/// A name stands in a text as a whole word.
bool occurs(const std::string& name, const std::string& text) {
  const auto in_name = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
  for (std::size_t at = 0; (at = text.find(name, at)) != text.npos; at += name.size())
    if ((at == 0 || !in_name(text[at - 1])) && (at + name.size() == text.size() || !in_name(text[at + name.size()])))
      return true;
  return false;
}

/// The formulas of a theory that the scene gives itself.
std::string given_formulas(const Scene& scene) {
  const Values values(scene.settings);
  return values.text(density_key).value_or("") + " " + values.text(constraint_key).value_or("");
}

/// The names of the theory's parameters that the scene declares, with their keys.
std::vector<std::pair<std::string, std::string>> declared_parameters(const Scene& scene) {
  std::vector<std::pair<std::string, std::string>> names;
  for (const DeclaredKey& declared : scene.settings.declared())
    if (declared.kind == DeclaredBy::theory) {
      const std::string& key = declared.parameter.key;
      names.emplace_back(key.substr(key.find('.') + 1), key);
    }
  return names;
}

/// "$m = 1$ and $\lambda = 2$": the parameters of the density, by its own names.
std::string parameters_in_force(const Scene& scene, const TheoryText* text) {
  std::vector<std::string> values;
  const ParameterValues in_force = completed(scene.problem).parameters;
  const auto add = [&](const std::string& name, const std::string& key) {
    if (const auto value = in_force.maybe<double>(key))
      values.push_back(equal_in_paper(expressions::latex_name(name), *value));
  };
  if (text)
    for (const auto& [name, key] : text->parameters) add(name, key);
  else {
    const std::string formulas = given_formulas(scene);
    for (const auto& [name, key] : declared_parameters(scene))
      if (scene.settings.find(density_key) == nullptr || occurs(name, formulas)) add(name, key);
  }
  return listed(values);
}

/// A formula of an entry, "q_i,tt = Σ_j …: what it is", in LaTeX.
std::string latex_of_entry(std::string formula) {
  formula = formula.substr(0, formula.find(": "));
  static const std::pair<const char*, const char*> signs[] = {{"Σ", "\\sum"},    {"−", "-"},        {"²", "^2"},
                                                              {"³", "^3"},       {"φ", "\\varphi"}, {"θ", "\\theta"},
                                                              {"λ", "\\lambda"}, {"μ", "\\mu"},     {"·", "\\cdot "}};
  for (const auto& [sign, latex] : signs)
    for (std::size_t at = 0; (at = formula.find(sign, at)) != formula.npos;)
      formula.replace(at, std::string(sign).size(), latex);
  return std::regex_replace(formula, std::regex("_(\\w)(,\\w+)?"), "_{$1$2}");
}

void show(PaperText& text, const std::vector<std::string>& latex, const std::vector<std::string>& plain) {
  for (std::size_t e = 0; e < latex.size(); ++e) text.display(latex[e], plain[e], ",");
}

}  // namespace

void say_theory(PaperText& text, const Scene& scene, const std::optional<EquationsForPaper>& equations,
                const std::string& where) {
  const Problem& p = scene.problem;
  const TheoryEntry& entry = find_theory(p.theory);
  const bool given = scene.settings.find(density_key) != nullptr;
  std::vector<std::string> sources = given ? std::vector<std::string>{} : entry.sources;
  for (const std::string& key : parts_of(Values(scene.settings).text(sources_key).value_or(""), ','))
    if (!key.empty()) sources.push_back(key);
  const bool several = equations && equations->latex.of_fields.size() > 1;
  const std::string named = entry.words.empty() || given ? several ? "the equations" : "the equation" : entry.words;
  const bool moves = p.lattice.space() == Space::point;  // mechanics
  text.say(fmt::format("We {} {}{}", moves ? "integrate" : "solve", named, citation_of(sources)));
  if (equations) show(text, equations->latex.of_fields, equations->plain.of_fields);
  else text.display("\\[\n  " + latex_of_entry(entry.formula) + "\n\\]\n", "    " + entry.formula + "\n");
  std::string constraint = Values(scene.settings).text(constraint_key).value_or("");
  const TheoryText* own = given ? nullptr : text_of_entry(p.theory);
  if (own) constraint = own->constraint;
  const std::string parameters = parameters_in_force(scene, own);
  std::string rest;
  if (!constraint.empty())
    rest += fmt::format(", under the constraint{} {}", constraint.find(';') == constraint.npos ? "" : "s",
                        with_formulas(constraint.find('=') == constraint.npos ? constraint + " = 0" : constraint));
  if (!parameters.empty()) rest += ", with " + parameters;
  if (!where.empty()) rest += (rest.empty() ? " " : ", ") + where;
  if (p.circle_valued) rest += ", with values in $S^1$";
  if (equations) {
    text.say(fmt::format("{} of the Lagrangian density{}",
                         several ? "the Euler–Lagrange equations" : "the Euler–Lagrange equation",
                         given ? ", given as a formula," : ""));
    text.display(equations->latex.density, equations->plain.density, rest.empty() ? "." : ",");
    if (rest.starts_with(", ")) rest.erase(0, 2);
    else if (rest.starts_with(' ')) rest.erase(0, 1);
    if (!rest.empty()) text.say(rest + ".");
  } else text.say((rest.starts_with(", ") ? rest.substr(2) : rest.empty() ? rest : rest.substr(1)) + ".");
}

std::string parameters_of_start(const Scene& scene) {
  if (!scene.settings.find(density_key)) return {};
  std::string formulas;
  for (const Setting& s : scene.settings.all())
    if (s.key.starts_with("initial.") || s.key.starts_with("exact.") || s.key == left_end || s.key == right_end)
      formulas += s.value + " ";
  const ParameterValues in_force = completed(scene.problem).parameters;
  std::vector<std::string> values;
  for (const auto& [name, key] : declared_parameters(scene))
    if (occurs(name, formulas) && !occurs(name, given_formulas(scene)))
      if (const auto value = in_force.maybe<double>(key))
        values.push_back(equal_in_paper(expressions::latex_name(name), *value));
  return values.empty() ? "" : ", where " + listed(values);
}

std::string with_names_of_equations(std::string words, const Scene& scene, const std::vector<std::string>& fields) {
  const TheoryText* own = scene.settings.find(density_key) ? nullptr : text_of_entry(scene.problem.theory);
  if (!own) return words;
  const std::vector<std::string> names = parts_of(own->fields, ',');
  if (names.size() != fields.size()) return words;
  for (std::size_t a = 0; a < names.size(); ++a)
    if (names[a] != fields[a])
      words = std::regex_replace(words, std::regex("\\b" + fields[a] + "(?![A-Za-z0-9])"), names[a]);
  return words;
}

void write_for_more_dimensions(EquationsForPaper& equations) {
  const auto in_latex = [](std::string& formula) {
    const std::string name = "(\\\\?[A-Za-z]+)";
    formula = std::regex_replace(formula, std::regex(name + "_\\{xx\\}"), "\\Delta $1");
    formula = std::regex_replace(formula, std::regex(name + "_\\{x\\}\\^\\{2\\}"), "|\\nabla $1|^{2}");
    formula = std::regex_replace(formula, std::regex(name + "_\\{x\\}\\\\,\\s*" + name + "_\\{x\\}"),
                                 "\\nabla $1\\cdot\\nabla $2");
  };
  const auto in_plain = [](std::string& formula) {
    formula = std::regex_replace(formula, std::regex("([A-Za-z]+)_xx"), "Laplace($1)");
    formula = std::regex_replace(formula, std::regex("([A-Za-z]+)_x\\^2"), "|grad $1|^2");
    formula = std::regex_replace(formula, std::regex("([A-Za-z]+)_x\\*([A-Za-z]+)_x"), "grad $1 . grad $2");
  };
  in_latex(equations.latex.density), in_plain(equations.plain.density);
  for (std::string& formula : equations.latex.of_fields) in_latex(formula);
  for (std::string& formula : equations.plain.of_fields) in_plain(formula);
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/page/solved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <optional>

#include "schemes/methods/method_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/page/markup.hpp"
#include "tools/report/equations.hpp"
#include "tools/rows/engine.hpp"
#include "tools/scene/values.hpp"
#include "tools/warnings/waves_in_words.hpp"

namespace delf {
namespace {

std::string formula(const char* label, const std::string& mathml) {
  return fmt::format("<div class=\"formula\" tabindex=\"0\" role=\"group\" aria-label=\"{}\">{}</div>\n", label,
                     mathml);
}

std::string in_mathml(const DisplayedEquations& equations, bool on_point) {
  std::string html = "<h3>Density</h3>\n" + formula("The Lagrangian density", equations.density);
  html += equations.of_fields.size() > 1 ? "<h3>Field equations</h3>\n" : "<h3>Field equation</h3>\n";
  for (const std::string& equation : equations.of_fields) html += formula("A field equation", equation);
  if (equations.discrete.empty())
    return html +
           paragraph("The equations of this scheme on the lattice have no stencil, and are not written out here.");
  html +=
      "<h3>Discrete equations</h3>\n" +
      paragraph(
          on_point
              ? "They hold at every row j, and are divided by the time step h."
              : "They hold at every row j and site i, and are divided by hk: h is the time step, k the space step.");
  for (const std::string& equation : equations.discrete) html += formula("A discrete field equation", equation);
  return html;
}

/// The value of a key in force, or what the results say.
std::string said(const ResultFolder& folder, const char* key, const char* in_summary) {
  const Json* summary = folder.result("summary");
  if (const std::string text = text_in(summary, in_summary); !text.empty()) return text;
  if (const auto number = number_in(summary, in_summary)) return number_text(number);
  const auto found = folder.keys.find(key);
  return found == folder.keys.end() ? "" : found->second;
}

}  // namespace

SolvedProblem solved_problem(const ResultFolder& folder) {
  SolvedProblem solved;
  std::string waves, scheme;
  const std::string method = said(folder, "scheme.method", "method"), space = said(folder, "lattice.space", "space");
  const bool on_point = space == space_of_mechanics, on_cells = space == "complex";
  try {
    if (folder.scene.empty()) throw BadScene("there is no scene.ini");
    Settings settings = read_settings(folder.scene_file, {});
    const bool on_mesh = is_on_mesh(settings);
    const std::string theory = Values(settings).choice("theory.name");
    if (folder.keys.contains("theory.density"))
      solved.what += paragraph("The theory is given by its density, as text.");
    else solved.what += paragraph(fmt::format("The theory is {}: {}.", theory, find_theory(theory).formula));
    if (on_mesh) {
      if (folder.keys.contains("theory.density"))
        solved.what += code_block("The Lagrangian density", folder.keys.at("theory.density"));
      solved.what += paragraph(
          method == "complex" ? "Spacetime is a complex of cells, and the equations differ from site to site."
          : method == "elliptic"
              ? "Space is a mesh and there is no time: φ_tt is left out, φ_xx stands for the Laplacian, and the equations "
                "differ from site to site."
              : "Space is a mesh, where φ_xx stands for the Laplacian, and the equations differ from site to site.");
    } else {
      const Scene read = read_scene(std::move(settings));
      constexpr int most_sites = 200000;  // of which a simulation is made in no time
      scheme = scheme_in_words(read.problem);
      if (read.problem.lattice.sites() > most_sites)
        throw BadScene(fmt::format("`delf plan` prints the equations of more than {} sites", most_sites));
      const Simulation simulation =
          build(read, static_cast<int>(number_in(folder.result("summary"), "winding").value_or(0)));
      if (const auto equations = equations_in(expressions::Notation::mathml, read.problem, simulation))
        solved.what += in_mathml(*equations, on_point);
      else solved.what += paragraph("The theory is compiled, and its density has no text to be printed.");
      waves = waves_in_words(read, simulation);
    }
  } catch (const std::exception& error) {
    solved.what += paragraph(fmt::format("No equations are printed here: {}.", error.what()));
  }
  PageTable how{"The scheme and its steps", {}, {}};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) how.rows.push_back({name, value});
  };
  add("initial state", said(folder, "initial.state", "state"));
  add("scheme", scheme);
  add("method", method);
  const auto named = std::ranges::find(method_entries(), method, &MethodEntry::name);
  if (on_cells || (named != method_entries().end() && (*named)->reads_stencil))  // others have one of their own
    add(on_cells ? "cells" : "stencil", said(folder, "lattice.stencil", "stencil"));
  add("space", space);
  if (!on_point) {
    add("length", said(folder, "lattice.length", "length"));
    add("sites", said(folder, "lattice.sites", "sites"));
    add("space step k", said(folder, "", "space_step"));
  }
  add("time step h", said(folder, "lattice.time_step", "time_step"));
  add("limit of the step", said(folder, "", "step_limit"));
  add("waves, by linear theory", waves);
  add("solution of a step", said(folder, "", "solve"));
  add("tolerance of a step", said(folder, "scheme.tolerance", "tolerance"));
  add("first rows", said(folder, "initial.start", "start"));
  add("rows that maxima are over", said(folder, "", "maxima_over"));
  if (folder.scene_file != folder.path / "scene.ini") solved.how = paragraph("These are the values of the first run.");
  solved.how += table(how);
  return solved;
}

}  // namespace delf

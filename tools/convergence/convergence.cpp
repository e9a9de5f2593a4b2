// SPDX-License-Identifier: MIT
#include "tools/convergence/convergence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numbers>
#include <optional>
#include <type_traits>
#include <vector>

#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "tools/compare/convergence_table.hpp"
#include "tools/convergence/convergence_figure.hpp"
#include "tools/convergence/convergence_verdict.hpp"
#include "tools/convergence/mesh_convergence.hpp"
#include "tools/figures/drawing.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/in_words.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/rows/engine.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

// The orders of the lines beside the errors: those asked for, or the scheme's, or whole numbers around the measured.
std::vector<double> drawn_orders(const OrderRequest& request, double measured) {
  if (request.order) return {*request.order};
  if (request.of_scheme) return {static_cast<double>(*request.of_scheme)};
  if (!std::isfinite(measured)) return {};
  const double below = std::max(1.0, std::floor(measured));
  return {below, below + 1};
}

// The reason for a missing figure, in one line. A figure that cannot be drawn does not fail the command.
// The order that the method declares.
std::optional<int> order_of_scheme(const Problem& asked) {
  const Problem problem = completed(asked);
  const auto order = find_method(problem.method).order;
  return order ? order(problem) : std::nullopt;
}

// A line where errors of the table are not the scheme's alone, though its order is met.
std::string floor_in_words(const Scene& scene, const ConvergenceTable& table) {
  if (!table.exact || table.all_sites || table.levels.empty()) return {};
  const double least = table.levels.back().linf;
  const EndChange ends = off_at_ends(scene);
  if (!(ends.change > 0.1 * least)) return {};
  return fmt::format(
      "  ends       the exact solution {}, by {:.2g}, and the last error is {:.2g}: finer lines will not fall below "
      "that; keep the pulse away from both ends of lattice.length\n",
      ends.words, ends.change, least);
}

std::string number(const char* format, double value) {
  return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
}

std::string report(const Scene& scene, const std::string& label, const ConvergenceTable& table) {
  std::string text = fmt::format("{}: {} at halved steps; errors are {}\n", scene.name, label,
                                 table.all_sites ? "those of all sites, against the exact solution"
                                 : table.exact   ? "those of the last row, against the exact solution"
                                                 : "differences from the last row of the next line");
  text += fmt::format("  {:>7} {:>10} {:>10} {:>10} {:>10} {:>7} {:>9}", "N", "k", "h", "max error", "L2 error",
                      "order", "time");
  if (!table.levels.empty())
    for (const NamedNumber& m : table.levels[0].measures) text += fmt::format(" {:>14}", m.name);
  text += "\n";
  for (std::size_t i = 0; i < table.levels.size(); ++i) {
    const ConvergenceLevel& l = table.levels[i];
    // the order that has led to this line
    text += fmt::format("  {:>7} {:>10.4g} {:>10} {:>10} {:>10} {:>7} {:>9}", l.sites, l.space_step,
                        number("{:.4g}", l.time_step), number("{:.3e}", l.linf), number("{:.3e}", l.l2),
                        i == 0 ? "-" : number("{:.3f}", table.levels[i - 1].order), duration_in_words(l.seconds));
    for (const NamedNumber& m : l.measures) text += fmt::format(" {:>14.8g}", m.value);
    text += "\n";
  }
  return text;
}

std::string json_of(const Scene& scene, const std::string& label, const OrderRequest& request,
                    const ConvergenceTable& table, const ConvergenceVerdict& verdict, bool passed) {
  Json json = json_head(scene);
  json["scheme"] = label;
  json["status"] = table.status;
  json["error"] = table.exact ? "exact" : "difference";
  json["order"] = table.order();
  json["order_expected"] = request.order ? Json(*request.order) : Json();
  json["order_of_scheme"] = request.of_scheme ? Json(*request.of_scheme) : Json();
  json["passed"] = passed;
  json["verdict"] = to_string(verdict.kind);
  json["reason"] = text_or_null(verdict.reason);
  json["ended"] = text_or_null(table.ended);
  auto& levels = json["levels"] = Json::array();
  for (const ConvergenceLevel& l : table.levels) {
    Json measures = Json::object();
    for (const NamedNumber& m : l.measures) measures[m.name] = m.value;
    levels.push_back({{"sites", l.sites},
                      {"space_step", l.space_step},
                      {"time_step", l.time_step},
                      {"error_linf", l.linf},
                      {"error_l2", l.l2},
                      {"order", l.order},
                      {"seconds", l.seconds},
                      {"measures", measures}});
  }
  return json_text(json);
}

std::string csv_of(const ConvergenceTable& table) {
  std::string text = "sites,space_step,time_step,error_linf,error_l2,order,seconds";
  if (!table.levels.empty())
    for (const NamedNumber& m : table.levels[0].measures) text += "," + m.name;
  text += "\n";
  for (const ConvergenceLevel& l : table.levels) {
    text += fmt::format("{},{},{},{},{},{},{}", l.sites, l.space_step, l.time_step, l.linf, l.l2, l.order, l.seconds);
    for (const NamedNumber& m : l.measures) text += fmt::format(",{}", m.value);
    text += "\n";
  }
  return text;
}

// `scene` names the run, and `whole` is what is refined: itself, or the scene on a mesh that it is part of.
template <class Whole>
ExitCode converge_in(const fs::path& folder, const Scene& scene, const Whole& whole, const std::string& label,
                     std::optional<int> of_scheme) {
  const Interrupt interrupt;
  const Values values(scene.settings);
  const OrderRequest request{static_cast<int>(values.integer("convergence.levels")),
                             values.maybe_real("convergence.order"), of_scheme, values.real("convergence.agreement")};
  const ConvergenceTable table = converge(whole, request.levels);
  const bool failed = table.status != "done" && table.status != "interrupted";
  const Scene* const on_lattice = std::is_same_v<Whole, Scene> ? &scene : nullptr;
  ConvergenceVerdict verdict = judge(table, request, on_lattice);
  if (verdict.kind == ConvergenceVerdict::passed && !std::isfinite(verdict.order))
    verdict.kind = ConvergenceVerdict::not_measured;
  const double order = verdict.order;
  const bool passed = !failed && verdict.accepted(request);
  make_results_folder(folder);
  write_text_file(folder / "convergence.json", json_of(scene, label, request, table, verdict, passed));
  write_text_file(folder / "convergence.csv", csv_of(table));
  fmt::print("{}", report(scene, label, table));
  if (!table.ended.empty()) fmt::print("  ended      {}\n", table.ended);
  if (on_lattice && (verdict.kind == ConvergenceVerdict::passed || !std::isfinite(order)))
    fmt::print("{}", floor_in_words(scene, table));
  if (table.status == "interrupted")
    fmt::print("  not finished (interrupted): {} of {} lines\n", table.levels.size(), request.levels);
  else if (!std::isfinite(order)) fmt::print("  order      not known: fewer than two errors above rounding\n");
  if (request.order)
    fmt::print("  order      {}, {} expected: {}\n", number("{:.3f}", order), *request.order,
               passed ? "passed" : "FAILED");
  else if (request.of_scheme && std::isfinite(order))
    fmt::print("  order      {:.3f}, and the scheme's is {}: {}\n", order, *request.of_scheme,
               verdict.kind == ConvergenceVerdict::missed
                   ? "MISSED; begin with smaller steps, unless the solution is not smooth"
                   : to_string(verdict.kind));
  else if (std::isfinite(order))
    fmt::print("  order      {:.3f}, and the scheme declares none: convergence.order asks for one\n", order);
  if (!verdict.reason.empty()) fmt::print("  reason     {}\n", verdict.reason);
  remove_figures({convergence_figure}, folder);
  const std::string missing =
      scene.figures ? draw_convergence(scene, label, table, drawn_orders(request, order), folder) : std::string();
  std::error_code none;
  const fs::path figure =
      folder / "figures" / fmt::format("{}.{}", convergence_figure, scene.figure_form.formats.front());
  fmt::print("{}: convergence.json convergence.csv{}\n", folder.string(), fs::exists(figure, none) ? " figures" : "");
  if (!missing.empty()) fmt::print(stderr, "delf: no figures: {}\n", missing);
  if (table.status == "interrupted") return ExitCode::interrupted;
  if (failed) throw NumericalFailure(table.ended);
  if (verdict.kind == ConvergenceVerdict::unstable)
    throw NumericalFailure("the steps are not stable: " + verdict.reason);
  return passed ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace

ExitCode convergence(const Scene& scene, const fs::path& folder) {
  if (scene.steps == 0)
    throw scene.settings.error(Values(scene.settings).given("run.steps") ? "run.steps" : "run.until",
                               "nothing is stepped, so nothing converges; use more");
  return with_memory_for(scene, [&] {
    return converge_in(folder, scene, scene, scheme_label(scene.problem), order_of_scheme(scene.problem));
  });
}

ExitCode convergence(const ComplexScene& mesh, const fs::path& folder) {
  constexpr int order = 2;  // of steps in rows, of P1 and Q1
  // No order is asked of asynchronous steps: order 2 is known on one mesh alone (see Lew et al.).
  return converge_in(folder, mesh.scene, mesh, (mesh.space ? "mesh of " : "") + mesh.mesh_in_words(),
                     mesh.time == MeshTime::cells ? std::nullopt : std::optional(order));
}

}  // namespace delf

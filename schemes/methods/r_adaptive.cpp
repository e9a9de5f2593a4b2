// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "jets/expressions/parse.hpp"
#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/radau_element.hpp"
#include "jets/tables/space_table.hpp"
#include "jets/tables/table_product.hpp"
#include "jets/tables/time_tableau.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/families/mesh_constraint.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/methods/moving_parts.hpp"
#include "schemes/methods/slope_steps.hpp"
#include "schemes/methods/time_element_keys.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {
namespace {

/// An element in time that scheme.time names.
struct NamedTime {
  std::string name, tableau;  ///< of cgvi; none: Radau IIA
  bool multipliers;           ///< has both ends of a step among its points, or no others than their mean
  bool rows_alone;            ///< a slaved mesh is that of the rows
  bool rectangle = false;     ///< is what TheoryEntry::moving_rectangle has
  double most_phase = 0;      ///< ωh up to which it is stable, by the trace of a step; 0: always
};
const std::vector<NamedTime>& times() {
  static const std::vector<NamedTime> all{{"trapezoid", "stormer-verlet", true, true, true, 2},
                                          {"midpoint", "midpoint", true, true},
                                          {"gauss1", "gauss1", false, false},
                                          {"gauss2", "gauss2", false, false},
                                          {"lobatto2", "lobatto2", true, false, false, 2},
                                          {"lobatto3", "lobatto3", true, false, false, 2 * std::numbers::sqrt2},
                                          {"radau3", "", false, false}};
  return all;
}

/// Points of Gauss's rule that are exact to rounding for a sine over a cell.
constexpr int most_exact = 10;

StencilTable element(const NamedTime& time) {
  if (time.tableau.empty()) return radau_element(3);
  ParameterValues keys;
  keys["scheme.tableau"] = time.tableau;
  return TimeElementKeys(keys).element();
}

std::string strategy(const Problem& p) { return p.parameters.get<std::string>("scheme.strategy"); }
const NamedTime& time_of(const Problem& p) {
  return *std::ranges::find(times(), p.parameters.get<std::string>("scheme.time"), &NamedTime::name);
}
/// The sources of scheme.time.
std::vector<std::string> sources_of_time(const Problem& p) {
  const std::string& tableau = time_of(p).tableau;
  return tableau.empty() ? std::vector<std::string>{"hairer-wanner-1996"}
                         : std::ranges::find(time_tableaux(), tableau, &TimeTableau::name)->sources;
}

MeshMonitor monitor_of(const Problem& p, const std::vector<Component>& fields) {
  using Kind = MeshMonitor::Kind;
  const std::string text = p.parameters.get<std::string>("mesh.monitor");
  MeshMonitor monitor{.alpha = p.parameters.get<double>("mesh.alpha"), .beta = p.parameters.get<double>("mesh.beta")};
  for (const auto& [name, kind] :
       {std::pair{"arclength", Kind::arclength}, {"saturated", Kind::saturated}, {"uniform", Kind::uniform}})
    if (text == name) return monitor.kind = kind, monitor;
  monitor.kind = Kind::formula;
  expressions::Names names{{}, {{"alpha", monitor.alpha}, {"beta", monitor.beta}}};
  const int d = static_cast<int>(fields.size());
  for (int a = 0; a < d; ++a) {
    const std::string& name = fields[a].name;
    names.variables.emplace_back(name, a), names.variables.emplace_back(name + "_X", d + a);
  }
  expressions::Graph graph;
  const int root = expressions::parse(graph, text, names, "mesh.monitor");
  monitor.rho = std::make_shared<const expressions::Evaluation>(graph, root);
  // cells of equal ∫ρ dX: where ρ is 0 they have no bounds, and where it is below they fold
  double most = 0;
  for (const double phi : {0.0, 0.5, -1.0})
    for (const double slope : {0.0, 1.0, -2.0}) {
      const double rho = monitor.rho->operator()<double>([&](int v) { return v < d ? phi : slope; });
      most = std::max(most, rho);
      if (rho < 0)
        throw BadInput("mesh.monitor", fmt::format("must be positive, and is {:.3g} where the fields are {} and their "
                                                   "slopes {}; such as 1 + alpha*phi_X^2",
                                                   rho, phi, slope));
    }
  if (!(most > 0)) throw BadInput("mesh.monitor", "must be positive, and is 0 or no number; such as 1 + alpha*phi_X^2");
  return monitor;
}

/// Gauss's points in a cell that mesh.points asks for; none: the exact integral, where there is one.
std::optional<int> points_of(const Problem& p) {
  const std::string text = p.parameters.get<std::string>("mesh.points");
  if (text == "exact") return std::nullopt;
  int points = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), points);
  if (error != std::errc{} || end != text.data() + text.size() || points < 2 || points > 20)
    throw BadInput("mesh.points",
                   fmt::format("mesh.points = {}: give exact, or a number of Gauss's points from 2 to 20", text));
  return points;
}

/// τ of mesh.delay, where the mesh is that of the rows.
double delay_of(const Problem& p, const NamedTime& time) {
  const double delay = p.parameters.get<double>("mesh.delay");
  if (delay > 0 && (strategy(p) != "control" || !time.rows_alone))
    throw BadInput(
        "mesh.delay",
        "mesh.delay: a mesh that follows with a delay is no constraint of the field, and not for multipliers or "
        "stages; use scheme.strategy = control with scheme.time = midpoint or trapezoid, or mesh.delay = 0");
  return delay;
}

SchemeParts r_adaptive_parts(const FieldTheory& theory, const Problem& p) {
  if (p.lattice.space() != Space::interval || p.lattice.left() != Wall::fixed || p.lattice.right() != Wall::fixed)
    throw BadInput("lattice.space",
                   "scheme.method = r-adaptive: the mesh moves between two fixed walls; use "
                   "lattice.space = interval and fixed walls");
  if (theory.constraint())
    throw BadInput("theory.name", "scheme.method = r-adaptive: takes no constraint of the theory; use another method");
  const NamedTime& time = time_of(p);
  const std::optional<int> asked = points_of(p);
  const int points = asked.value_or(most_exact);
  if (strategy(p) == "uniform") {
    SchemeParts parts =
        element_parts(theory, product(element(time), element_space(lagrange_basis({0, 1}), gauss_rule(points))));
    if (time.tableau.empty()) parts.symmetries.clear();
    return parts;
  }
  if (const std::string key = key_of_driven_end(p); !key.empty() && time.tableau.empty())
    throw BadInput(key,
                   fmt::format("{}: the work of such an end on a mesh that moves is not known with scheme.time = {}; "
                               "use scheme.time = gauss2 with scheme.strategy = control",
                               key, time.name));
  const bool varied = strategy(p) == "multiplier";
  if (varied && !time.multipliers)
    throw BadInput(
        "scheme.time",
        fmt::format("scheme.time = {}: multipliers keep the mesh at the ends of a step, which are no points "
                    "of this rule; use trapezoid, midpoint, lobatto2 or lobatto3, or scheme.strategy = control",
                    time.name));
  MovingScheme scheme{.time = element(time),
                      .monitor = monitor_of(p, theory.fields()),
                      .varied = varied,
                      .rows_alone = time.rows_alone,
                      .delay = delay_of(p, time),
                      .most_phase = time.most_phase,
                      .points = points};
  if (const TheoryEntry& theory_entry = find_theory(p.theory); theory_entry.moving_stage && !asked) {
    if (time.rectangle) scheme.action = theory_entry.moving_rectangle(p.parameters);
    else scheme.stage = [&](double weight) { return theory_entry.moving_stage(p.parameters, weight); };
  }
  return moving_parts(theory, scheme);
}

MovingSites place_sites(const Problem& p, int components, const Profile& profile) {
  const auto theory = find_theory(p.theory).make(p.parameters);
  MovingSites sites = place_moving_sites(monitor_of(p, theory->fields()), p.lattice, components, profile);
  if (p.parameters.get<double>("mesh.delay") > 0) std::ranges::fill(sites.X_t, 0.0);  // τ X_t = G, which is 0
  return sites;
}

RowDensity row_density(const RowsInTime& rows, std::span<const double> momenta, double strength) {
  return density_of_slopes(rows, row_rates(rows, momenta), strength);
}

/// δ, the narrowest cell of the newest row: it limits the step of what is explicit.
double narrowest_cell(const RowsInTime& rows) {
  const LatticeSystem& system = rows.system;
  if (!system.moves()) return system.lattice().space_step();
  const auto& all = system.all_components();
  const int X = static_cast<int>(std::ranges::find(all, true, &Component::position) - all.begin());
  double least = std::numeric_limits<double>::infinity();
  for (int i = 0; i + 1 < system.lattice().sites(); ++i)
    least = std::min(least, rows.rows(rows.newest, i + 1, X) - rows.rows(rows.newest, i, X));
  return least;
}
constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// The distance of the newest row from having no mesh.
double mesh_margin(const RowsInTime& rows) {
  const MeshConstraint* mesh = find_mesh(rows.system.families());
  if (!mesh) return unknown;
  std::vector<double> y;
  const std::size_t d = rows.theory.components();
  for (int i = 0; i < rows.system.lattice().sites(); ++i)
    for (std::size_t a = 0; a < d; ++a) y.push_back(rows.rows(rows.newest, i, static_cast<int>(a)));
  return mesh->margin(y, d, rows.system.lattice().length()).value_or(unknown);
}
/// h over what is stable on the narrowest cell.
double step_over_limit(const RowsInTime& rows) {
  const MeshConstraint* mesh = find_mesh(rows.system.families());
  if (!mesh || std::isinf(mesh->stable_step)) return unknown;
  return rows.time_step / (mesh->stable_step * narrowest_cell(rows));
}
/// "h below 0.0764, 0.816 of the narrowest cell, which is 0.0936 wide, by linear theory"
std::string limit(const RowsInTime& rows) {
  const MeshConstraint* mesh = find_mesh(rows.system.families());
  if (!mesh || std::isinf(mesh->stable_step)) return {};
  const double of_width = mesh->stable_step, cell = narrowest_cell(rows);
  return fmt::format("h below {:.3g}, {:.3g} of the narrowest cell, which is {:.3g} wide, by linear theory",
                     of_width * cell, of_width, cell);
}
/// The largest |λ| that was found with the newest row; 0 without multipliers.
double largest_multiplier(const RowsInTime& rows) {
  double most = 0;
  for (int c = 0; c < rows.system.components(); ++c)
    for (int i = 0; rows.system.component(c).role == Role::multiplier && i < rows.system.lattice().sites(); ++i)
      most = std::max(most, std::abs(rows.rows(rows.newest - 1, i, c)));
  return most;
}

std::string r_adaptive_label(const Problem& p) {
  if (strategy(p) == "uniform") return fmt::format("linear elements, uniform mesh, {}", time_of(p).name);
  const std::string monitor = p.parameters.get<std::string>("mesh.monitor");
  return fmt::format("r-adaptive, {}, {}, {}{}", strategy(p), time_of(p).name, monitor,
                     monitor == "uniform" ? "" : fmt::format(", alpha = {:g}", p.parameters.get<double>("mesh.alpha")));
}

std::vector<std::string> time_names() {
  std::vector<std::string> names;
  for (const NamedTime& time : times()) names.push_back(time.name);
  return names;
}

std::string r_adaptive_words(const Problem& p) {
  const NamedTime& time = time_of(p);
  const std::string in_time = time.rectangle ? "the trapezoidal rule"
                              : time.tableau.empty()
                                  ? "the Radau IIA method of order 5"
                                  : std::ranges::find(time_tableaux(), time.tableau, &TimeTableau::name)->words;
  if (strategy(p) == "uniform") return "linear finite elements on a uniform mesh, stepped by " + in_time;
  const std::string monitor = p.parameters.get<std::string>("mesh.monitor");
  const bool formula = monitor != "arclength" && monitor != "saturated" && monitor != "uniform";
  return fmt::format(
      "linear finite elements on a moving mesh that equidistributes {}{}, {}, stepped by {}",
      monitor == "arclength"   ? "arclength"
      : monitor == "saturated" ? "a saturated arclength"
      : monitor == "uniform"   ? "length"
                               : "the monitor " + monitor,
      monitor == "uniform" || formula ? ""
                                      : fmt::format(" with $\\alpha = {:g}$", p.parameters.get<double>("mesh.alpha")),
      strategy(p) == "multiplier" ? "by Lagrange multipliers" : "slaved to the field (the control-theoretic strategy)",
      in_time);
}

}  // namespace

extern const MethodEntry r_adaptive_method;
const MethodEntry r_adaptive_method{
    .name = "r-adaptive",
    .formula = "moving mesh of any density, by multipliers or slaved to the field: Tyranowski-Desbrun",
    .build = r_adaptive_parts,
    .parameters = {{.key = "scheme.strategy",
                    .fallback = "multiplier",
                    .help = "the mesh is varied, with multipliers; slaved to the field (control); or stands still",
                    .choices = {"multiplier", "control", "uniform"}},
                   {.key = "scheme.time",
                    .fallback = "trapezoid",
                    .help = "the element in time; gauss1, gauss2 and radau3 are not for multipliers",
                    .choices = time_names()},
                   {.key = "mesh.monitor",
                    .fallback = "arclength",
                    .help = "what all cells have the same of: arclength, saturated, uniform, or a density as a formula "
                            "of phi and phi_X",
                    .without = {{"scheme.strategy", {"uniform"}}}},
                   {.key = "mesh.alpha",
                    .fallback = 1.0,
                    .help = "how much the mesh follows the field; 0: not at all",
                    .range = {.low = 0},
                    .without = {{"scheme.strategy", {"uniform"}}, {"mesh.monitor", {"uniform"}}}},
                   {.key = "mesh.beta",
                    .fallback = 0.1,
                    .help = "saturated: cells stay above beta/alpha of the arclength in one",
                    .range = {.low = 0, .open = true},
                    .without = {{"scheme.strategy", {"uniform"}}, {"mesh.monitor", {"arclength", "uniform"}}}},
                   {.key = "mesh.delay",
                    .fallback = 0.0,
                    .help = "the mesh follows the monitor as tau X_t = G, smoother in time; control with midpoint or "
                            "trapezoid; 0: at once",
                    .range = {.low = 0}},
                   {.key = "mesh.points",
                    .fallback = "exact",
                    .help = "Gauss's points in a cell, 2 to 20; exact: no points where theory and element have the "
                            "integral in closed form, and 10 elsewhere, exact to rounding for sine-gordon"}},
    .label = r_adaptive_label,
    .starts = {StartRule::legendre, StartRule::exact},
    .start = StartRule::legendre,
    .energy = &hamiltonian_of_row,
    .monitors = {{.name = "mesh_min_spacing", .value = narrowest_cell, .least = true},
                 {.name = "mesh_margin", .value = mesh_margin, .least = true},
                 {.name = "step_over_limit",
                  .value = step_over_limit,
                  .when_above_1 = "the step is beyond what linear theory allows on the narrowest cell; reduce "
                                  "lattice.time_step or mesh.alpha, or let scheme.strategy = control and scheme.time = "
                                  "gauss2 have no such limit"},
                 {.name = "multiplier_max", .value = largest_multiplier}},
    .limit = limit,
    .row_density = row_density,
    .place_sites = place_sites,
    .words = r_adaptive_words,
    .sources = {"tyranowski-desbrun-2019"},
    .further_sources = sources_of_time};

}  // namespace delf

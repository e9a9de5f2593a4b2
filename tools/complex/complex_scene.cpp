// SPDX-License-Identifier: MIT
#include "tools/complex/complex_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <set>
#include <span>
#include <utility>

#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "lattice/index.hpp"
#include "lattice/space/mesh_topology.hpp"
#include "schemes/complex/circle_fibre.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_on_space.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/complex/mesh_text.hpp"
#include "tools/rows/exact_solution.hpp"
#include "tools/scene/key_warning.hpp"
#include "tools/scene/steps_in_turn.hpp"
#include "tools/scene/values.hpp"

namespace delf {
namespace {

constexpr double usual_records = 100;
constexpr std::string_view reversible = "reversible";  // of lattice.time_steps: chosen by the field

/// Keys that scenes on a mesh read, besides those of the theory, initial.FIELD and exact.FIELD.
const std::set<std::string, std::less<>> read_keys{
    "theory.name",        "theory.fibre",      "lattice.space",         "lattice.mesh",        "lattice.merge",
    "lattice.time",       "lattice.courant",   "lattice.time_step",     "lattice.time_steps",  "lattice.step_control",
    "boundary.mesh",      "scheme.tolerance",  "scheme.max_iterations", "initial.state",       "run.until",
    "run.steps",          "run.seed",          "output.every",          "output.checkpoint",   "output.fields",
    "output.figures",     "output.format",     "output.titles",         "verify.variations",   "verify.moments",
    "verify.tolerance",   "verify.fault",      "verify.generator",      "verify.force",        "scheme.method",
    "convergence.levels", "convergence.order", "convergence.agreement", "stability.agreement", "stability.steps",
    "stability.fault"};

/// Keys of time, which lattice.time = none has none of.
const std::set<std::string, std::less<>> time_keys{"lattice.courant",      "lattice.time_step", "lattice.time_steps",
                                                   "lattice.step_control", "run.until",         "run.steps",
                                                   "output.every"};

/// Keys of stencils are of regular lattices.
bool has_keys_on_meshes(const MethodEntry& method) { return method.on_meshes && !method.reads_stencil; }

void refuse_unread(const Settings& settings, const TheoryEntry& theory, const ParameterValues& parameters,
                   const MethodEntry& method, const std::vector<Component>& fields, bool still, bool spacetime) {
  std::set<std::string, std::less<>> known = read_keys;
  if (has_keys_on_meshes(method))
    for (const Parameter& p : method.parameters) known.insert(p.key);
  for (const Parameter& p : parameters_of(theory, parameters)) known.insert(p.key);
  for (const Component& field : fields)
    known.insert({"exact." + field.name, "initial." + field.name, "initial." + field.name + "_t"});
  if (spacetime) known.insert("run.threads");
  for (const Setting& s : settings.all()) {
    if (s.key.starts_with("sweep.")) continue;  // of the command
    if (!known.contains(s.key))
      throw settings.error(s.key,
                           s.key.starts_with("exact.") || s.key.starts_with("initial.")
                               ? "has no effect on a mesh, where fields start from formulas; remove it"
                               : "needs a regular lattice (not applicable to lattice.space = complex); remove it");
    if ((still || spacetime) &&
        (time_keys.contains(s.key) || (s.key.starts_with("initial.") && s.key.ends_with("_t")) ||
         (spacetime && (s.key == "lattice.time" || s.key == "boundary.mesh"))))
      throw settings.error(s.key, spacetime ? "has no effect where sites have times of their own; remove it"
                                            : "has no effect with lattice.time = none; remove it");
  }
}

void read(ParameterValues& parameters, const Values& values, const std::vector<Parameter>& declared) {
  for (const Parameter& p : declared)
    if (values.given(p.key) || p.otherwise.empty()) parameters[p.key] = values.parameter(p);
}

ParameterValues read_parameters(const Values& values, const TheoryEntry& theory) {
  ParameterValues parameters;
  read(parameters, values, theory.parameters);
  if (theory.further)
    for (const Parameter& p : theory.further(parameters)) parameters[p.key] = values.parameter(p);
  return parameters;
}

std::string names_of_methods_on_meshes() {
  std::vector<std::string> names;
  for (const MethodEntry* entry : method_entries())
    if (has_keys_on_meshes(*entry)) names.push_back(entry->name);
  return fmt::format("{}", fmt::join(names, " or "));
}

std::vector<double> read_time_steps(const Settings& settings, const Values& values) {
  const auto text = values.text("lattice.time_steps");
  if (!text || *text == reversible) return {};
  return steps_in_turn(settings, *text);
}

/// Of a formula: the theory's parameters by their names.
std::vector<std::pair<std::string, double>> numbers_of(const ParameterValues& parameters) {
  std::vector<std::pair<std::string, double>> numbers;
  for (const auto& [key, value] : parameters)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with("theory."))
      numbers.emplace_back(key.substr(7), *number);
  return numbers;
}

void read_fields(ComplexScene& c, const Values& values, const ParameterValues& parameters) {
  const auto numbers = numbers_of(parameters);
  const Settings& settings = c.scene.settings;
  const auto formula = [&](const std::string& key) -> std::optional<PlaceFormula> {
    const auto text = values.given(key) ? values.text(key) : std::nullopt;
    if (!text) return std::nullopt;
    PlaceFormula read(*text, numbers, key);
    if (read.reads_time() && !c.stencils && !key.starts_with("exact."))
      throw settings.error(key, "reads t, and is of t = 0; give a solution of t as exact." + key.substr(8));
    return read;
  };
  std::vector<std::string> names;
  for (const Component& field : c.theory->fields()) names.push_back(field.name);
  const std::string of_all = names.size() > 1 ? fmt::format(" (the fields are {})", fmt::join(names, ", ")) : "";
  for (const std::string& name : names) {
    c.fields.push_back({name, formula("initial." + name), formula("initial." + name + "_t"), formula("exact." + name)});
    if (!c.fields.back().value && !c.fields.back().exact)
      throw settings.error("initial." + name, "must be given on a mesh, as a formula of x, y and z; or exact." + name +
                                                  " as one of t too" + of_all);
    if (c.fields.back().exact && !c.is_one_problem())
      for (const std::string& key : {"initial." + name, "initial." + name + "_t"})
        if (const Setting* s = settings.find(key))
          c.scene.warnings.push_back(key_warning(settings, *s, "no effect, as exact." + name + " gives the start too"));
    if (c.fields.front().exact.has_value() != c.fields.back().exact.has_value())
      throw settings.error("exact." + name, fmt::format("must be given for all of the fields {} or for none of them; "
                                                        "complete it",
                                                        fmt::join(names, ", ")));
  }
  if (values.given("initial.state") && !find_state(values.choice("initial.state")).further)
    throw settings.error("initial.state", "is of one coordinate; on a mesh give formulas, initial.phi or exact.phi");
}

/// The stencils of a file stand for the area that they cover, each part once.
void require_tiling(ComplexScene& c) {
  c.tiling = tiling_of(*c.stencils);
  if (const auto& fault = c.tiling.fault)
    throw BadInput("lattice.mesh", fmt::format("lattice.mesh = {}: {}:{}: {}", c.mesh_file.filename().string(),
                                               c.mesh_file.filename().string(), fault->line, fault->what));
}

/// Data are on G = 0: rows 0, or the fixed boundary where there is no time.
void require_constraint(const ComplexScene& c) {
  const std::vector<double> values = c.values();
  const std::string& name = c.fields.front().name;
  c.space->each_constraint(values, [&](std::size_t i, double G, std::span<const double> slopes) {
    if (c.time == MeshTime::none && !c.space->fixed[i]) return;
    double terms = 0;  // Σ |∂G/∂φ φ|
    for (std::size_t a = 0; a < slopes.size(); ++a) terms += std::abs(slopes[a] * values[i * slopes.size() + a]);
    constexpr double rounding = 1e-12;
    if (!(std::abs(G) <= rounding * std::max(1.0, terms)))
      throw c.scene.settings.error(
          (c.fields.front().exact ? "exact." : "initial.") + name,
          fmt::format("breaks the constraint at point {} of the mesh, where it is {:.3g} and not 0; give fields that "
                      "keep it",
                      c.space->mesh.point_number(i), G));
  });
}

/// A formula of t, x, y and z with its first and second derivative by each.
class DerivativesAlong {
 public:
  DerivativesAlong(std::string_view text, const std::vector<std::pair<std::string, double>>& numbers,
                   const std::string& key) {
    expressions::Graph graph;
    const int root = expressions::parse(graph, text, {{{"t", 0}, {"x", 1}, {"y", 2}, {"z", 3}}, numbers}, key);
    for (int v = 0; v < 4; ++v) {
      const int first = graph.differentiate(root, v);
      of_[v] = {expressions::Evaluation(graph, first), expressions::Evaluation(graph, graph.differentiate(first, v))};
    }
  }
  double operator()(int variable, int order, double t, const Mesh::Point& p) const {
    return of_[variable][order - 1].operator()<double>([&](int v) { return v == 0 ? t : p[v - 1]; });
  }

 private:
  std::array<std::array<expressions::Evaluation, 2>, 4> of_;
};

/// Tries exact.FIELD at points of a flat mesh and at random times. A density there is a sum of its parts along t and each
/// coordinate (schemes/README.md, Complexes), and so are its field equations:
///
///     E = [E(φ_t, φ_tt) − E(0)] + E(φ) + Σ_a [E(φ, ∂_aφ, ∂_a²φ) − E(φ)]
///
/// On a surface in space the derivatives along it are not those of the coordinates.
void require_solution(const ComplexScene& c, const ParameterValues& parameters) {
  const Mesh& mesh = c.space->mesh;
  const auto equations = FieldEquations::of(c.theory->density());
  if (!equations || equations->order() != 2 || c.theory->constraint() || mesh.coordinates() != mesh.dimension) return;
  const std::size_t d = c.fields.size();
  const bool still = c.time == MeshTime::none;
  std::vector<DerivativesAlong> derivatives;
  for (const ComplexScene::Field& field : c.fields) {
    const std::string key = "exact." + field.name;
    derivatives.emplace_back(*Values(c.scene.settings).text(key), numbers_of(parameters), key);
  }
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> part(0, 1);
  constexpr int tries = 128;
  std::vector<TriedPoint> points;
  for (int n = 0; n < tries; ++n) {
    const double t = still ? 0 : c.scene.end() * part(random);
    const Mesh::Point& p = mesh.points[random() % mesh.points.size()];
    std::vector<std::pair<int, std::vector<double>>> jets;  // with their signs in the sum
    const std::vector<double> zero(6 * d);
    std::vector<double> at_rest(zero);
    for (std::size_t a = 0; a < d; ++a) at_rest[a] = (*c.fields[a].exact)(t, p);
    jets.emplace_back(1, at_rest);
    for (int v = still ? 1 : 0; v <= mesh.coordinates(); ++v) {
      std::vector<double> jet = v == 0 ? zero : at_rest;
      jets.emplace_back(-1, jet);
      for (std::size_t a = 0; a < d; ++a) {
        jet[(v == 0 ? 1 : 2) * d + a] = derivatives[a](v, 1, t, p);
        jet[(v == 0 ? 3 : 5) * d + a] = derivatives[a](v, 2, t, p);
      }
      jets.emplace_back(1, std::move(jet));
    }
    std::vector<FieldEquations::Value> sums(d);
    bool finite = true;
    for (const auto& [sign, jet] : jets) {
      finite = finite && std::ranges::all_of(jet, [](double v) { return std::isfinite(v); });
      const auto values = (*equations)(jet, t, p[0]);
      for (std::size_t a = 0; a < d; ++a) sums[a].sum += sign * values[a].sum, sums[a].absolute += values[a].absolute;
    }
    if (!finite) continue;
    const auto floor = [&equations, jets, t, x = p[0]](double rounding) {
      std::vector<double> all;
      for (const auto& [sign, jet] : jets) {
        const std::vector<double> one = equations->rounding(jet, t, x, rounding);
        all.resize(one.size());
        for (std::size_t a = 0; a < one.size(); ++a) all[a] += one[a];
      }
      return all;
    };
    points.push_back(
        {fmt::format("t = {:.6g}, ({:.6g})", t, fmt::join(std::span(p).first(at(mesh.coordinates())), ", ")),
         std::move(sums), floor});
  }
  std::vector<std::string> names;
  for (const auto& field : c.fields) names.push_back(field.name);
  require_solved(points, names);
}

}  // namespace

bool is_on_mesh(const Settings& settings) {
  const Setting* const space = settings.find("lattice.space");
  return space && space->value == "complex";
}

ComplexScene read_complex_scene(Settings given, int halvings) {
  ComplexScene c((Scene(std::move(given))));
  Scene& scene = c.scene;
  Settings& settings = scene.settings;
  scene.name = settings.file().stem().string();
  const Values values(settings);
  for (const Parameter& key : settings.all_keys()) values.check(key);
  try {
    Problem& p = scene.problem;
    p.theory = values.choice("theory.name");
    const TheoryEntry& entry = find_theory(p.theory);
    const ParameterValues parameters = read_parameters(values, entry);
    c.theory = make_theory(entry, parameters);
    if (!values.given("lattice.mesh"))
      throw settings.error("lattice.mesh", "must be given with lattice.space = complex: a file, or icosahedron:4");
    auto mesh = named_mesh(*values.text("lattice.mesh"), settings.file().parent_path(), c.mesh_file, halvings,
                           values.maybe_real("lattice.merge"));
    if (const auto* list = std::get_if<StencilList>(&mesh)) c.stencils = std::make_unique<const StencilList>(*list);
    if (const Setting* merge = settings.find("lattice.merge"); merge && (c.stencils || c.mesh_file.empty()))
      scene.warnings.push_back(key_warning(settings, *merge, "no effect: it is for the points of a mesh file"));
    if (c.stencils && !c.mesh_file.empty() && !find_fault(*c.stencils, c.theory->density())) require_tiling(c);
    p.method = values.choice("scheme.method");
    const MethodEntry& method = find_method(p.method);
    p.parameters = parameters;
    if (has_keys_on_meshes(method)) read(p.parameters, values, method.parameters);
    refuse_unread(settings, entry, parameters, method, c.theory->fields(), values.choice("lattice.time") == "none",
                  c.stencils != nullptr);
    require_theory_on(*c.theory, Space::mesh);
    const bool by_method = c.has_method();
    if (by_method && !method.on_meshes)
      throw settings.error("scheme.method",
                           "needs a regular lattice; leave it out on a mesh, or use " + names_of_methods_on_meshes());
    double edge = 1;  // of the mesh as it is given
    if (!c.stencils) {
      edge = shortest_edge(std::get<Mesh>(mesh));
      c.space = std::make_unique<CellSpace>(
          finer_mesh(*values.text("lattice.mesh"), std::get<Mesh>(std::move(mesh)), halvings),
          c.theory->shared_density(), values.choice("boundary.mesh") == "fixed", c.theory->constraint());
    }
    const std::string time = values.choice("lattice.time");
    c.time = c.stencils        ? MeshTime::sites
             : time == "none"  ? MeshTime::none
             : time == "cells" ? MeshTime::cells
                               : MeshTime::rows;
    if (by_method && c.time != MeshTime::rows)
      throw settings.error("scheme.method", "is for lattice.time = rows; leave it out");
    if (c.theory->constraint() && c.time != MeshTime::rows && c.time != MeshTime::none)
      throw BadInput("theory.name", "theory.name = " + p.theory +
                                        ": a constraint on a mesh is for lattice.time = rows or none; choose one of "
                                        "these");
    p.circle_valued = values.choice("theory.fibre") == "S1";
    if (p.circle_valued && by_method)
      throw settings.error("theory.fibre", "S1 on a mesh is for the usual method; leave scheme.method out, or use R");
    if (p.circle_valued && (c.time != MeshTime::rows || c.theory->fields().size() > 1))
      throw settings.error("theory.fibre", "S1 on a mesh is for one field with lattice.time = rows; use R");
    p.tolerance = values.real("scheme.tolerance");
    p.max_iterations = static_cast<int>(values.integer("scheme.max_iterations"));
    p.threads = static_cast<int>(values.integer("run.threads"));
    p.lattice = Lattice::circle(std::max(2, c.sites()), edge * std::max(2, c.sites()));
    p.stencil = c.mesh_in_words();
    read_fields(c, values, parameters);
    if (c.theory->constraint()) require_constraint(c);
    scene.fields = values.toggle("output.fields");
    scene.figures = values.toggle("output.figures");
    scene.figure_form = read_figure_form(settings, values);
    scene.checkpoint = values.real("output.checkpoint");
    scene.initial.seed = static_cast<std::uint64_t>(values.integer("run.seed"));
    if (c.is_one_problem()) {
      if (c.space && c.has_solution()) require_solution(c, parameters);
      return c;
    }

    p.step_control = read_step_control(settings, values);
    if (p.step_control && !method.row_density)
      throw settings.error(
          "lattice.time_steps",
          "reversible steps are of the usual method on a mesh; leave scheme.method out, or give a list");
    if (p.step_control && c.time == MeshTime::cells)
      throw settings.error("lattice.time_steps", "cells have steps of their own; give lattice.courant");
    if (p.step_control && c.theory->constraint())
      throw settings.error("lattice.time_steps",
                           "reversible steps are for theories without a constraint; give a list of steps");
    for (const char* other : {"lattice.courant", "lattice.time_step"})
      if (values.given("lattice.time_steps") && !p.step_control && values.given(other))
        settings.keep_one_of("lattice.time_steps", other, {});
    c.time_steps = read_time_steps(settings, values);
    if (!c.time_steps.empty()) {
      if (c.time == MeshTime::cells)
        throw settings.error("lattice.time_steps", "cells have steps of their own; give lattice.courant");
      p.time_step = c.time_steps.front();
    } else {
      settings.keep_one_of("lattice.courant", "lattice.time_step", "give one of them, such as lattice.courant = 0.4");
      c.courant = values.given("lattice.courant") ? values.real("lattice.courant") : 0;
      if (c.time == MeshTime::cells && c.courant == 0)
        throw settings.error("lattice.time_step", "cells have steps of their own; give lattice.courant");
      p.time_step = c.courant > 0 ? c.courant * edge : values.real("lattice.time_step");
    }
    if (!(p.time_step > 0)) throw settings.error("lattice.time_step", "must be above 0 on a mesh; use a positive one");
    settings.keep_one_of("run.until", "run.steps", "give one of them, such as run.until = 10");
    if (values.given("run.steps")) {
      scene.steps = values.integer("run.steps");
    } else {
      const double until = values.real("run.until");
      if (until < 0) throw settings.error("run.until", "must be at least 0 on a mesh; use a later time");
      if (until / p.time_step > 1e12) throw settings.error("run.until", "is too many steps; use less");
      if (p.step_control) {
        scene.until = until;
        scene.steps = static_cast<std::int64_t>(std::ceil(until / p.time_step));
      } else if (c.time_steps.empty()) scene.steps = std::llround(until / p.time_step);
      else
        for (double t = 0; t < until * (1 - 1e-12); t += c.time_step(scene.steps)) ++scene.steps;
    }
    p.time_step = std::ldexp(p.time_step, -halvings);
    scene.steps <<= halvings;
    scene.every = values.maybe_integer("output.every")
                      .value_or(std::max(1LL, std::llround(static_cast<double>(scene.steps) / usual_records)));
    if (c.has_solution()) require_solution(c, parameters);
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
  return c;
}

bool ComplexScene::has_method() const { return scene.problem.method != fallback_of(*find_key("scheme.method")); }

Problem ComplexScene::problem_on_mesh() const {
  Problem problem = scene.problem;
  problem.lattice = Lattice::on(std::shared_ptr<const MeshSpace>(std::shared_ptr<const MeshSpace>(), space.get()));
  problem.stencil = Problem().stencil;
  problem.time_steps = time_steps;
  problem.circle_valued = false;  // values() are lifted to real numbers
  return problem;
}

int ComplexScene::sites() const { return stencils ? static_cast<int>(stencils->sites.size()) : space->sites(); }
int ComplexScene::cells() const { return stencils ? static_cast<int>(stencils->stencils.size()) : space->mesh.cells(); }
int ComplexScene::coordinates() const { return stencils ? stencils->coordinates() : space->mesh.coordinates(); }

std::vector<double> ComplexScene::places() const {
  std::vector<double> all;
  const int n = coordinates();
  const auto add = [&](const auto& point) { all.insert(all.end(), point.begin(), point.begin() + n); };
  if (stencils)
    for (const auto& site : stencils->sites) add(site.position);
  else
    for (const Mesh::Point& p : space->mesh.points) add(p);
  return all;
}

std::vector<double> ComplexScene::values() const {
  std::vector<double> all;
  if (stencils) {
    for (const auto& [position, role, line] : stencils->sites)
      for (const Field& f : fields)
        all.push_back((f.exact ? *f.exact : *f.value)(position[0], {position[1], position[2], position[3]}));
    return all;
  }
  for (const Mesh::Point& p : space->mesh.points)
    for (const Field& f : fields) all.push_back(f.exact ? (*f.exact)(0, p) : (*f.value)(0, p));
  return scene.problem.circle_valued ? lifted(space->mesh, std::move(all)) : all;
}
std::vector<double> ComplexScene::rates() const {
  std::vector<double> all;
  for (const Mesh::Point& p : space->mesh.points)
    for (const Field& f : fields) all.push_back(f.exact ? f.exact->by_t(0, p) : f.rate ? (*f.rate)(0, p) : 0.0);
  return all;
}
std::vector<double> ComplexScene::solution(double t) const {
  if (stencils) return values();
  std::vector<double> all;
  for (const Mesh::Point& p : space->mesh.points)
    for (const Field& f : fields) all.push_back((*f.exact)(t, p));
  return all;
}

std::string ComplexScene::mesh_in_words() const {
  if (stencils) {
    std::map<std::string, int> count;
    for (const auto& e : stencils->stencils) ++count[e.shape];
    std::string text;
    for (const auto& [shape, n] : count) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", n, shape);
    return "stencils " + text;
  }
  const Mesh& mesh = space->mesh;
  std::array<int, 5> count{};
  for (int c = 0; c < mesh.cells(); ++c) ++count[mesh.cell(c).size()];
  constexpr std::array<const char*, 5> names{"", "", "segments", "triangles", "quadrilaterals"};
  std::string text;
  for (std::size_t n = 2; n < count.size(); ++n)
    if (count[n] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : " and ", count[n], names[n]);
  return text;
}

std::string ComplexScene::topology_in_words() const {
  if (space) return in_words(topology(space->mesh), space->mesh.dimension);
  return tiling.cells ? in_words(topology(*tiling.cells), tiling.cells->dimension) : "";
}

std::string ComplexScene::state_in_words() const {
  std::string text;
  const auto add = [&](const std::string& key) {
    if (const Setting* s = scene.settings.find(key))
      text += fmt::format("{}{} = {}", text.empty() ? "" : "; ", key, s->value);
  };
  for (const Field& f : fields) add("exact." + f.name), add("initial." + f.name), add("initial." + f.name + "_t");
  return text;
}

std::string resolved_text(const ComplexScene& c) {
  const Settings& settings = c.scene.settings;
  return fmt::format("{}{} understood it: `delf run scene.ini` gives the same rows to the bit.\n",
                     resolved_scene_begins, DELF_VERSION) +
         sections_of(settings, [&](const Parameter& key) -> std::string {
           // of more steps the fallback is another
           if (key.key == "output.every" && !c.is_one_problem()) return fmt::format("{}", c.scene.every);
           const Setting* const given = settings.find(key.key);
           if (!given) return {};
           if (key.key == "lattice.mesh" && !c.mesh_file.empty()) return c.mesh_file.string();
           if (key.key == "lattice.time_steps")
             return c.scene.problem.step_control ? given->value : fmt::format("{}", fmt::join(c.time_steps, ", "));
           return given->value;
         });
}

}  // namespace delf

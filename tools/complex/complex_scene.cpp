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

#include "lattice/index.hpp"
#include "lattice/space/mesh_topology.hpp"
#include "schemes/complex/circle_fibre.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_on_space.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/complex/mesh_boundary.hpp"
#include "tools/complex/mesh_text.hpp"
#include "tools/rows/exact_solution.hpp"
#include "tools/scene/key_warning.hpp"
#include "tools/scene/keys_of_spaces.hpp"
#include "tools/scene/mesh_methods.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/steps_in_turn.hpp"

namespace delf {
namespace {

constexpr int usual_records = 100;

SpaceKind kind_of(const ComplexScene& c) {
  return c.stencils ? SpaceKind::spacetime : c.time == MeshTime::none ? SpaceKind::still : SpaceKind::mesh;
}

/// Keys of the program say themselves which spaces read them; those that the theory, the method and the fields declare are
/// read by every mesh, but for rates of a field without time.
void refuse_unread(const ComplexScene& c) {
  const Problem& p = c.scene.problem;
  std::set<std::string, std::less<>> declared, rates;
  if (const MethodEntry& method = find_method(p.method); is_named_on_meshes(method))
    for (const Parameter& parameter : method.parameters) declared.insert(parameter.key);
  for (const Parameter& parameter : parameters_of(find_theory(p.theory), p.parameters)) declared.insert(parameter.key);
  for (const Component& field : c.theory->fields()) {
    declared.insert({"exact." + field.name, "initial." + field.name});
    rates.insert("initial." + field.name + "_t");
  }
  for (const Setting& s : c.scene.settings.all()) {
    if (declared.contains(s.key)) continue;
    const SpaceKind kind = kind_of(c);
    const std::string why = rates.contains(s.key) ? why_without_time(kind) : why_unread(kind, s.key);
    if (!why.empty()) throw c.scene.settings.error(s.key, why + "; remove it");
  }
}

std::string names_of_methods_on_meshes() {
  std::vector<std::string> names;
  for (const MethodEntry* entry : method_entries())
    if (is_named_on_meshes(*entry)) names.push_back(entry->name);
  return fmt::format("{}", fmt::join(names, " or "));
}

/// Of a formula: the theory's parameters by their names.
std::vector<std::pair<std::string, double>> numbers_of(const ParameterValues& parameters) {
  std::vector<std::pair<std::string, double>> numbers;
  for (const auto& [key, value] : parameters)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with("theory."))
      numbers.emplace_back(key.substr(7), *number);
  return numbers;
}

void read_fields(ComplexScene& c, const Values& values) {
  const auto numbers = numbers_of(c.scene.problem.parameters);
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

/// Fields go on where the mesh is joined: the formulas of the start have the same value on both sides.
void require_periodic(const ComplexScene& c) {
  const Mesh& mesh = c.space->mesh;
  for (std::size_t n = 0; n < mesh.places.size(); ++n) {
    const Mesh::Point &here = mesh.points[at(mesh.vertices[n])], &there = mesh.places[n];
    if (here == there) continue;
    for (const ComplexScene::Field& field : c.fields)
      for (const auto& [key, formula] :
           {std::pair("exact." + field.name, &field.exact), std::pair("initial." + field.name, &field.value),
            std::pair("initial." + field.name + "_t", &field.rate)}) {
        if (!*formula) continue;
        const double value = (**formula)(0, here), other = (**formula)(0, there);
        constexpr double rounding = 1e-9;
        if (!(std::abs(other - value) <= rounding * std::max({1.0, std::abs(value), std::abs(other)})))
          throw c.scene.settings.error(
              key, fmt::format(
                       "jumps where the mesh is joined, from {:.6g} at ({:.6g}) to {:.6g} at ({:.6g}); give a formula "
                       "of their period",
                       value, fmt::join(here, ", "), other, fmt::join(there, ", ")));
      }
  }
}

/// The start, or the solution, is what driven points have: else it says so.
void warn_of_driven(ComplexScene& c) {
  const Settings& settings = c.scene.settings;
  const Mesh& mesh = c.space->mesh;
  for (std::size_t a = 0; a < c.fields.size(); ++a) {
    const auto& [name, start, rate, exact] = c.fields[a];
    const bool starts = !exact && c.time != MeshTime::none;
    if (!exact && !starts) continue;
    double worst = 0, when = 0, size = 0;
    std::int32_t where = -1;
    constexpr int times = 16;
    for (int n = 0; n <= (exact && !c.is_one_problem() ? times : 0); ++n) {
      const double t = n == 0 ? 0 : c.scene.end() * n / times;
      for (const auto& [point, given] : c.space->driven) {
        const double value = given->value(static_cast<int>(a), t);
        const double apart = std::abs((exact ? *exact : *start)(t, mesh.points[at(point)]) - value);
        size = std::max(size, std::abs(value));
        if (apart > worst) worst = apart, when = t, where = point;
      }
    }
    constexpr double rounding = 1e-9;
    if (!(worst > rounding * std::max(1.0, size))) continue;
    const Setting* const s = settings.find((exact ? "exact." : "initial.") + name);
    c.scene.warnings.push_back(
        key_warning(settings, *s,
                    fmt::format("differs by {:.3g} from what point {} is driven to at t = {:.6g}; the driven value counts", worst,
                                mesh.point_number(at(where)), when)));
  }
}

/// Data are on G = 0: rows 0, or the fixed boundary where there is no time.
void require_constraint(const ComplexScene& c) {
  const std::vector<double> values = c.values();
  const std::string& name = c.fields.front().name;
  c.space->each_constraint(values, [&](std::size_t i, double G, std::span<const double> slopes) {
    if (c.time == MeshTime::none && !c.space->fixed[i]) return;
    if (!keeps_constraint(G, slopes, std::span(values).subspan(i * slopes.size(), slopes.size())))
      throw c.scene.settings.error(
          (c.fields.front().exact ? "exact." : "initial.") + name,
          fmt::format("breaks the constraint at point {} of the mesh, where it is {:.3g} and not 0; give fields that "
                      "keep it",
                      c.space->mesh.point_number(i), G));
  });
}

/// Tries exact.FIELD at points of a flat mesh and at random times. A density there is a sum of its parts along t and each
/// coordinate (schemes/README.md, Complexes), and so are its field equations:
///
///     E = [E(φ_t, φ_tt) − E(0)] + E(φ) + Σ_a [E(φ, ∂_aφ, ∂_a²φ) − E(φ)]
///
/// On a surface in space the derivatives along it are not those of the coordinates.
void require_solution(const ComplexScene& c) {
  const Mesh& mesh = c.space->mesh;
  const auto equations = FieldEquations::of(c.theory->density());
  if (!equations || equations->order() != 2 || c.theory->constraint() || mesh.coordinates() != mesh.dimension) return;
  const std::size_t d = c.fields.size();
  const bool still = c.time == MeshTime::none;
  std::vector<std::vector<std::array<PlaceFormula, 2>>> derivatives;  // by t, x, y and z, of orders 1 and 2
  for (const ComplexScene::Field& field : c.fields) {
    auto& along = derivatives.emplace_back();
    for (int v = 0; v <= mesh.coordinates(); ++v) along.push_back({field.exact->by(v), field.exact->by(v).by(v)});
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
        jet[(v == 0 ? 1 : 2) * d + a] = derivatives[a][v][0](t, p);
        jet[(v == 0 ? 3 : 5) * d + a] = derivatives[a][v][1](t, p);
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

/// What the boundary of a mesh cannot be: driven where cells step by themselves, or on a circle of values.
void refuse_boundary(const ComplexScene& c, const MeshBoundary& boundary, const Values& values) {
  const Settings& settings = c.scene.settings;
  if (const std::string& key = boundary.key_that_reads_time(); c.time == MeshTime::none && !key.empty())
    throw settings.error(key, "reads t, and with lattice.time = none there is none; give a formula of x, y and z");
  if (boundary.key_of_formula().empty()) return;
  if (c.time == MeshTime::cells)
    throw settings.error(
        boundary.key_of_formula(),
        "cells with steps of their own have boundaries that are fixed or natural; use one of these, or "
        "lattice.time = rows");
  if (values.choice("theory.fibre") == "S1")
    throw settings.error(boundary.key_of_formula(),
                         "a formula gives real numbers, and theory.fibre = S1 angles; use theory.fibre = R");
}

/// A density that reads x has none where cells go on at another x.
void refuse_seam(const ComplexScene& c) {
  const Mesh& mesh = c.space->mesh;
  const BatchDensity& density = c.theory->density();
  const int x = density.variables() + 1;  // behind t
  bool reads_x = false;
  for (int v = 0; v < density.variables(); ++v) reads_x = reads_x || !density.is_zero(v, x);
  if (!reads_x || mesh.places.empty()) return;
  const double near = 1e-6 * shortest_edge(mesh);
  for (std::size_t n = 0; n < mesh.places.size(); ++n)
    if (std::abs(mesh.places[n][0] - mesh.points[at(mesh.vertices[n])][0]) > near)
      throw BadInput(
          "theory.density",
          "theory.density: reads x, which jumps where the mesh is joined; join sides of the same x, or use a "
          "density without it");
}

/// The mesh, or the complex, its method and its time. Returns the shortest edge of the mesh as it is given.
double read_space(ComplexScene& c, const Values& values, int halvings) {
  const Settings& settings = c.scene.settings;
  Problem& p = c.scene.problem;
  if (!values.given("lattice.mesh"))
    throw settings.error("lattice.mesh", "must be given with lattice.space = complex: a file, or icosahedron:4");
  const std::string name = *values.text("lattice.mesh"), time = values.choice("lattice.time");
  auto mesh =
      named_mesh(name, settings.file().parent_path(), c.mesh_file, halvings, values.maybe_real("lattice.merge"));
  if (const auto* list = std::get_if<StencilList>(&mesh)) c.stencils = std::make_unique<const StencilList>(*list);
  if (const Setting* merge = settings.find("lattice.merge"); merge && (c.stencils || c.mesh_file.empty()))
    c.scene.warnings.push_back(key_warning(settings, *merge, "no effect: it is for the points of a mesh file"));
  if (c.stencils && !c.mesh_file.empty() && !find_fault(*c.stencils, c.theory->density())) require_tiling(c);
  c.time = c.stencils        ? MeshTime::sites
           : time == "none"  ? MeshTime::none
           : time == "cells" ? MeshTime::cells
                             : MeshTime::rows;
  refuse_unread(c);
  if (c.has_method() && !find_method(p.method).on_meshes)
    throw settings.error("scheme.method",
                         "needs a regular lattice; leave it out on a mesh, or use " + names_of_methods_on_meshes());
  if (c.stencils) return 1;
  const double edge = shortest_edge(std::get<Mesh>(mesh));
  const bool fixed = values.choice("boundary.mesh") == "fixed";
  std::vector<std::string> fields;
  for (const Component& field : c.theory->fields()) fields.push_back(field.name);
  const Mesh apart = finer_mesh(name, std::get<Mesh>(std::move(mesh)), halvings);
  const MeshBoundary boundary(settings, apart, fixed, fields, numbers_of(p.parameters));
  refuse_boundary(c, boundary, values);
  const auto space = std::make_shared<CellSpace>(joined(apart, boundary.joined_parts()), c.theory->shared_density(),
                                                 fixed, c.theory->constraint());
  boundary.put_on(*space);
  boundary.require_constraint(settings, *space);
  c.space = space;
  refuse_seam(c);
  p.lattice = Lattice::on(c.space);
  return edge;
}

/// Steps of rows or cells, as many as the run has.
void read_steps(ComplexScene& c, const Values& values, const MethodEntry& method, double edge, int halvings) {
  Scene& scene = c.scene;
  Settings& settings = scene.settings;
  Problem& p = scene.problem;
  constexpr auto own_steps = "lattice.time_steps";
  p.step_control = read_step_control(settings, values);
  if (p.step_control && !method.row_density)
    throw settings.error(own_steps,
                         "reversible steps are of the usual method on a mesh; leave scheme.method out, or give a list");
  if (p.step_control && c.theory->constraint())
    throw settings.error(own_steps, "reversible steps are for theories without a constraint; give a list of steps");
  for (const char* other : {"lattice.courant", "lattice.time_step"})
    if (values.given(own_steps) && !p.step_control && values.given(other)) settings.keep_one_of(own_steps, other, {});
  if (values.given(own_steps) && c.time == MeshTime::cells)
    throw settings.error(own_steps, "cells have steps of their own; give lattice.courant");
  if (values.given(own_steps) && !p.step_control) p.time_steps = steps_in_turn(settings, *values.text(own_steps));
  if (!p.time_steps.empty()) {
    p.time_step = p.time_steps.front();
  } else {
    settings.keep_one_of("lattice.courant", "lattice.time_step", "give one of them, such as lattice.courant = 0.4");
    const double courant = values.given("lattice.courant") ? values.real("lattice.courant") : 0;
    if (c.time == MeshTime::cells && courant == 0)
      throw settings.error("lattice.time_step", "cells have steps of their own; give lattice.courant");
    if (c.time == MeshTime::cells) p.cell_courant = courant;
    p.time_step = courant > 0 ? courant * edge : values.real("lattice.time_step");
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
    } else if (p.time_steps.empty()) scene.steps = std::llround(until / p.time_step);
    else
      for (double t = 0; t < until * (1 - 1e-12); t += p.time_steps[at(scene.steps - 1) % p.time_steps.size()])
        ++scene.steps;
    require_a_step(settings, values, scene.steps, p.time_step);
  }
  p.time_step = std::ldexp(p.time_step, -halvings);
  scene.steps <<= halvings;
}

}  // namespace

bool is_on_mesh(const Settings& settings) {
  const Setting* const space = settings.find("lattice.space");
  return space && space->value == "complex";
}

AnyScene read_any_scene(Settings settings) {
  if (is_on_mesh(settings)) return read_complex_scene(std::move(settings));
  return read_scene(std::move(settings));
}

ComplexScene read_complex_scene(Settings given, int halvings) {
  ComplexScene c((Scene(std::move(given))));
  Scene& scene = c.scene;
  Settings& settings = scene.settings;
  scene.name = settings.file().stem().string();
  const Values values(settings);
  refuse_keys_of_lattices(settings);
  for (const Parameter& key : settings.all_keys()) values.check(key);
  try {
    Problem& p = scene.problem;
    p.theory = values.choice("theory.name"), p.method = values.choice("scheme.method");
    read_parameters(values, p);
    c.theory = make_theory(find_theory(p.theory), p.parameters);
    const double edge = read_space(c, values, halvings);
    const MethodEntry& method = find_method(p.method);
    require_theory_on(*c.theory, Space::mesh);
    const bool by_method = c.has_method();
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
    read_fields(c, values);
    if (c.space) require_periodic(c);
    if (c.theory->constraint()) require_constraint(c);
    scene.initial.seed = static_cast<std::uint64_t>(values.integer("run.seed"));
    if (!c.is_one_problem()) read_steps(c, values, method, edge, halvings);
    read_output(settings, values, usual_records, scene);
    if (c.space && c.has_solution()) require_solution(c);
    if (c.space) warn_of_driven(c);
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
  return c;
}

bool ComplexScene::has_method() const { return scene.problem.method != fallback_of(*find_key("scheme.method")); }

Problem ComplexScene::problem_on_mesh() const {
  Problem problem = scene.problem;
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

std::vector<double> ComplexScene::of_sites(double t, const std::vector<const PlaceFormula*>& formulas) const {
  std::vector<double> all;
  const auto add = [&](double at_time, const Mesh::Point& p) {
    for (const PlaceFormula* formula : formulas) all.push_back(formula ? (*formula)(at_time, p) : 0.0);
  };
  if (stencils)
    for (const auto& [at, role, line] : stencils->sites) add(at[0], {at[1], at[2], at[3]});
  else
    for (const Mesh::Point& p : space->mesh.points) add(t, p);
  return all;
}

namespace {

/// At driven points the numbers that are given there.
void take_driven(const CellSpace& space, double t, double (GivenInTime::*number)(int, double) const,
                 std::vector<double>& all) {
  const int d = space.fields();
  for (const auto& [point, given] : space.driven)
    for (int a = 0; a < d; ++a) all[at(point * d + a)] = ((*given).*number)(a, t);
}

}  // namespace

std::vector<double> ComplexScene::values() const {
  std::vector<const PlaceFormula*> formulas;
  for (const Field& f : fields) formulas.push_back(f.exact ? &*f.exact : &*f.value);
  std::vector<double> all = of_sites(0, formulas);
  if (space) take_driven(*space, 0, &GivenInTime::value, all);
  return scene.problem.circle_valued ? lifted(space->mesh, std::move(all)) : all;
}
std::vector<double> ComplexScene::rates() const {
  std::vector<PlaceFormula> of_solution;
  for (const Field& f : fields)
    if (f.exact) of_solution.push_back(f.exact->by(0));
  std::vector<const PlaceFormula*> formulas;
  for (std::size_t a = 0; a < fields.size(); ++a)
    formulas.push_back(has_solution() ? &of_solution[a] : fields[a].rate ? &*fields[a].rate : nullptr);
  std::vector<double> all = of_sites(0, formulas);
  if (space) take_driven(*space, 0, &GivenInTime::rate, all);
  return all;
}
std::vector<double> ComplexScene::solution(double t) const {
  std::vector<const PlaceFormula*> formulas;
  for (const Field& f : fields) formulas.push_back(&*f.exact);
  return of_sites(t, formulas);
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
             return c.scene.problem.step_control ? given->value
                                                 : fmt::format("{}", fmt::join(c.scene.problem.time_steps, ", "));
           return given->value;
         });
}

}  // namespace delf

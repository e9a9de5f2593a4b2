// SPDX-License-Identifier: MIT
#include "tools/scene/scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>

#include "jets/expressions/stencil_text.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/start_values.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/stepping/step_method.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/files/plain_rows.hpp"
#include "tools/scene/brick_rows.hpp"
#include "tools/scene/file_beside.hpp"
#include "tools/scene/key_warning.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/keys_of_spaces.hpp"
#include "tools/scene/scene_parts.hpp"
#include "tools/scene/suggestion.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr int usual_records = 400;

// The name that the scene gives for what declares keys: its theory, its method, or its state.
const std::string& chosen(const Scene& scene, DeclaredBy kind) {
  if (kind == DeclaredBy::state) return scene.initial.name;
  return kind == DeclaredBy::theory ? scene.problem.theory : scene.problem.method;
}

/// A wall that moves as a formula says has its value for data, and one where something flows in is natural.
Wall wall(const Values& values, const std::string& key) {
  const std::string wall = values.choice(key);
  if (values.given(key + ".flux") && !values.given(key)) return Wall::natural;
  return wall == "natural" ? Wall::natural : wall == "clamped" ? Wall::clamped : Wall::fixed;
}

SpaceKind kind_of(const Lattice& lattice) {
  return lattice.is_circle()                  ? SpaceKind::circle
         : lattice.space() == Space::interval ? SpaceKind::interval
                                              : SpaceKind::point;
}

/// The formulas of an end. Throws BadScene for what is neither a wall nor a formula, and for a flux where the value is kept.
void read_end(const Settings& settings, const Values& values, const std::string& key, Wall wall, Problem& p) {
  static const std::vector<std::string> walls{"fixed", "clamped", "natural"};
  const std::string flux = key + ".flux", given = values.choice(key);
  if (values.given(flux)) {
    if (wall != Wall::natural)
      throw settings.error(flux, fmt::format("is for a natural wall, and {} = {}; leave one of them out", key, given));
    p.parameters[flux] = values.text(flux).value_or("");
  }
  if (std::ranges::find(walls, given) != walls.end()) return;
  if (given.find_first_not_of("abcdefghijklmnopqrstuvwxyz") == std::string::npos && given != "t" && given != "pi")
    throw settings.error(key, "is not known" + suggestion(given, walls) + ", or a formula of t");
  p.parameters[key] = given;
}

Space read_space(const Values& values) {
  static const std::map<std::string, Space> spaces{
      {"circle", Space::circle}, {"interval", Space::interval}, {"point", Space::point}};
  return spaces.at(values.choice("lattice.space"));
}

Lattice read_lattice(const Settings& settings, const Values& values) {
  const Space space = read_space(values);
  if (space == Space::point) return Lattice::point();
  const auto sites = static_cast<int>(values.integer("lattice.sites"));
  const double length = values.real("lattice.length");
  const Lattice lattice = space == Space::circle ? Lattice::circle(sites, length)
                                                 : Lattice::interval(sites, length, wall(values, "boundary.left"),
                                                                     wall(values, "boundary.right"));
  if (!std::isnormal(lattice.space_step()))
    throw settings.error("lattice.length", "L/N is too small for double precision; use a longer one");
  return lattice;
}

Problem read_problem(const Settings& settings, const Values& values) {
  Problem p;
  p.theory = values.choice("theory.name");
  p.circle_valued = values.choice("theory.fibre") == "S1";
  p.lattice = read_lattice(settings, values);
  if (values.given(gain_key) && p.lattice.is_circle()) p.parameters[gain_key] = values.real(gain_key);
  if (p.circle_valued && gain_of(p.parameters) != 0)
    throw settings.error(gain_key, "on the fibre S1 a field gains multiples of 2 pi; use boundary.winding");
  p.stencil = stencil_name(values.choice("lattice.stencil"), p.lattice.space() == Space::point);
  p.method = values.choice("scheme.method");
  p.tolerance = std::max(values.real("scheme.tolerance"), smallest_tolerance);
  p.predictor_order = static_cast<int>(values.integer("scheme.seed_order"));
  p.max_iterations = static_cast<int>(values.integer("scheme.max_iterations"));
  p.threads = static_cast<int>(values.integer("run.threads"));
  const bool by_courant = values.given("lattice.courant");
  p.time_step = by_courant ? values.real("lattice.courant") * p.lattice.space_step() : values.real("lattice.time_step");
  if (p.time_step == 0)
    throw settings.error("lattice.time_step", "is no step; use a positive one, or a negative one to run backward");
  if (!std::isnormal(p.time_step))
    throw settings.error(by_courant ? "lattice.courant" : "lattice.time_step",
                         "the time step is outside the range of double precision; use another");
  if (const auto own = values.text("lattice.time_steps");
      values.given("lattice.time_steps") && own != "reversible" && own != "none")
    throw settings.error("lattice.time_steps",
                         "must be reversible, or none; steps in a list or a file are for lattice.space = complex");
  p.step_control = read_step_control(settings, values);
  read_parameters(values, p);
  if (p.lattice.space() == Space::interval) {
    read_end(settings, values, left_end, p.lattice.left(), p);
    read_end(settings, values, right_end, p.lattice.right(), p);
  }
  return p;
}

/// Throws BadScene for momenta beside a state that has its own, unless it is chosen in place of the one that reads them.
void refuse_unread_momenta(const Settings& settings, const StateEntry& state, const Problem& problem,
                           const std::vector<std::string>& fields) {
  const std::string momenta = "initial.p";
  const Setting *given = settings.find(momenta), *chosen = settings.find("initial.state");
  const auto parameters = parameters_of(state, fields);
  if (!given || (given->line > 0 && chosen && chosen->line == 0) ||
      std::ranges::find(parameters, momenta, &Parameter::key) != parameters.end())
    return;
  const bool on_point = problem.lattice.space() == Space::point;
  throw settings.error(
      momenta, fmt::format("is of initial.state = point or formula{}, and initial.state = {} does not read it; {}",
                           on_point ? "" : " on a point", state.name,
                           on_point ? "set initial.state = point and give initial.q too, or give the fields by formulas"
                                    : "leave it out"));
}

/// Momenta on the command line take the place of rates in a file, and rates of momenta: whatever of them the state reads.
void keep_rates_or_momenta(Settings& settings, const Values& values, const Problem& problem) {
  const std::string momenta = "initial.p";
  const StateEntry& entry = find_state(values.choice("initial.state"));
  std::vector<std::string> rates;
  if (std::ranges::find(entry.parameters, "initial.v", &Parameter::key) != entry.parameters.end())
    rates.emplace_back("initial.v");
  const auto theory = make_theory(find_theory(problem.theory), problem.parameters);
  std::vector<std::string> fields;
  for (const Component& field : theory->fields()) {
    if (field.name == "p") return;
    fields.push_back(field.name);
    if (entry.further) rates.push_back("initial." + field.name + "_t");
  }
  refuse_unread_momenta(settings, entry, problem, fields);
  for (const std::string& rate : rates)
    if (settings.find(momenta) && settings.find(rate)) settings.keep_one_of(rate, momenta, {});
}

StateRequest read_initial(const Values& values, const Problem& problem) {
  StateRequest r;
  r.name = values.choice("initial.state");
  r.theory = problem.theory;
  const TheoryEntry& entry = find_theory(problem.theory);
  ParameterValues in_force = problem.parameters;
  for (const Parameter& p : parameters_of(entry, problem.parameters))
    if (in_force.has(p.key)) r.values[p.key] = in_force[p.key];
  const std::shared_ptr<const FieldTheory> theory = make_theory(entry, problem.parameters);
  r.components = theory->components();
  r.fields.clear();
  for (const Component& field : theory->fields()) r.fields.push_back(field.name);
  for (const Parameter& p : parameters_of(find_state(r.name), r.fields))
    if (values.given(p.key)) r.values[p.key] = values.parameter(p);
  r.velocity_of = [theory](auto q, auto p) { return velocity_of(theory->density(), q, p); };
  if (const auto winding = values.maybe_integer("boundary.winding"); winding && problem.lattice.is_circle())
    r.winding = static_cast<int>(*winding);
  if (problem.parameters.has(gain_key)) r.values[gain_key] = gain_of(problem.parameters);
  r.seed = static_cast<std::uint64_t>(values.integer("run.seed"));
  return r;
}

fs::path find_initial_file(const Settings& settings, const Values& values) {
  const auto name = values.text("initial.file");
  if (!name) throw settings.error("initial.state", "needs initial.file, the fields.h5 or .csv to take rows from");
  const auto path = file_beside(settings, *name);
  if (!path)
    throw settings.error("initial.file",
                         "no such file, neither beside the scene nor here; check the path (# begins a comment)");
  if (std::error_code none; fs::is_directory(*path, none))
    throw settings.error("initial.file", "is a directory; name the file in it, such as fields.h5");
  const fs::path found = fs::absolute(*path).lexically_normal();
  if (found.string().find_first_of("#\n") != std::string::npos)
    throw settings.error("initial.file", "a path in a scene holds neither # nor line breaks; rename it");
  return found;
}

/// The last frame of the file that the rows come from, where a run backward begins.
int last_frame(const Scene& scene) {
  try {
    const int sites = scene.problem.lattice.sites();
    if (scene.initial_file.extension() != ".csv")
      if (const auto plain = open_plain_rows(scene.initial_file, sites, scene.initial.components))
        return plain->frames() - 1;
    return open_rows(scene.initial_file)->frames() - 1;
  } catch (const BadInput& bad) {
    throw scene.settings.located(bad);
  }
}

std::optional<StartRule> read_start(const Settings& settings, const Values& values, const Problem& problem) {
  if (!values.given("initial.start")) return std::nullopt;
  const std::string rule = values.choice("initial.start");
  for (const StartRule known : find_method(problem.method).starts)
    if (rule == to_string(known)) return known;
  std::vector<std::string> able, known;
  for (const MethodEntry* entry : method_entries())
    for (const StartRule start : entry->starts)
      if (rule == to_string(start)) able.insert(able.begin(), entry->name);
  // where values alone start the scheme, no rule that reads rates does
  const bool by_values = may_start_from_values(problem);
  for (const StartRule start : find_method(problem.method).starts)
    if ((start == StartRule::values) == by_values) known.emplace_back(to_string(start));
  throw settings.error("initial.start", fmt::format("needs scheme.method = {}; use {}", fmt::join(able, " or "),
                                                    fmt::join(known, " or ")));
}

std::int64_t read_steps(const Settings& settings, const Values& values, double time_step) {
  if (values.given("run.steps")) return values.integer("run.steps");
  const double until = values.real("run.until"), steps = std::round(until / time_step);
  if (until * time_step < 0)
    throw settings.error("run.until", fmt::format("is {} t = 0, and the time step is {:.6g}; use run.until = {:g}, or "
                                                  "run.steps",
                                                  until < 0 ? "before" : "after", time_step, -until));
  if (!(steps <= find_key("run.steps")->range.high))
    throw settings.error(
        "run.until", fmt::format("is {:.3g} steps of {:.3g}, more than can be counted; use less", steps, time_step));
  require_a_step(settings, values, static_cast<std::int64_t>(steps), time_step);
  return static_cast<std::int64_t>(steps);
}

// Beside a value of another key that does not read it.
std::string why_not_beside(const Scene& scene, const Parameter& parameter) {
  for (const auto& [key, values] : parameter.without) {
    const auto value = scene.problem.parameters.maybe<std::string>(key);
    if (value && std::ranges::find(values, *value) != values.end())
      return fmt::format("with {} = {} it has no effect", key, *value);
  }
  return {};
}

// A file may serve many schemes: a key of it is no mistake where the command line chooses what does not read it.
bool is_for_others(const Scene& scene, const Setting& given) {
  if (given.line == 0) return false;
  const auto on_command_line = [&](const Without& other) {
    const Setting* chosen = scene.settings.find(other.key);
    return chosen && chosen->line == 0;
  };
  for (const Declaration& declaration : declarations())
    for (const Parameter& parameter : declaration.parameters)
      if (parameter.key == given.key && std::ranges::any_of(parameter.without, on_command_line)) return true;
  return false;
}

// The reason for which a key that theories, methods or states declare is not read; empty for others, and where it is.
std::string why_not_read(const Scene& scene, std::string_view key) {
  std::optional<DeclaredBy> kind;
  for (const DeclaredKey& own : scene.settings.declared()) {
    if (own.parameter.key != key) continue;
    if (own.kind == DeclaredBy::scene || chosen(scene, own.kind) == own.owner) return {};
    kind = own.kind;
  }
  for (const Declaration& declaration : declarations()) {
    if (std::ranges::find(declaration.parameters, key, &Parameter::key) == declaration.parameters.end()) continue;
    if (chosen(scene, declaration.kind) == declaration.name)
      return why_not_beside(scene, *std::ranges::find(declaration.parameters, key, &Parameter::key));
    kind = kind.value_or(declaration.kind);
  }
  if (kind == DeclaredBy::theory) return fmt::format("the theory {} does not read it", scene.problem.theory);
  if (kind == DeclaredBy::state) return fmt::format("the state {} does not read it", scene.initial.name);
  if (kind == DeclaredBy::method)
    return fmt::format("only scheme.method = {} reads it", fmt::join(declared_by(key), " or "));
  return {};
}

}  // namespace

void read_parameters(const Values& values, Problem& p) {
  for (const Declaration& declaration : declarations()) {
    if (declaration.kind == DeclaredBy::state) continue;
    const std::string& name = declaration.kind == DeclaredBy::theory ? p.theory : p.method;
    for (const Parameter& parameter : declaration.parameters)
      // a key that is not given, and has no fallback, is left to what declares it
      if (name == declaration.name && (values.given(parameter.key) || parameter.otherwise.empty()))
        p.parameters[parameter.key] = values.parameter(parameter);
      else if (values.given(parameter.key) && !p.parameters.has(parameter.key))
        p.parameters[parameter.key] = values.parameter(parameter);
  }
  for (const char* unit : {"theory.speed", "theory.scale"})
    if (values.given(unit)) p.parameters[unit] = values.real(unit);
  const TheoryEntry& theory = find_theory(p.theory);
  if (theory.further)
    for (const Parameter& parameter : theory.further(p.parameters))
      p.parameters[parameter.key] = values.parameter(parameter);
}

void require_a_step(const Settings& settings, const Values& values, std::int64_t steps, double time_step) {
  if (steps > 0 || !(values.real("run.until") > 0)) return;
  throw settings.error(
      "run.until",
      fmt::format("is less than half a step, {:.4g}: no step would be taken; lower {}, or take run.steps", time_step,
                  values.given("lattice.time_step") ? "lattice.time_step"
                  : settings.find("lattice.mesh")   ? "lattice.courant"
                                                    : "lattice.courant, which is h/k"));
}

void read_output(const Settings& settings, const Values& values, int usual, Scene& scene) {
  const auto every = std::max(1LL, std::llround(static_cast<double>(scene.steps) / usual));
  scene.every = values.maybe_integer("output.every").value_or(every);
  scene.figures = values.toggle("output.figures");
  scene.figure_form = read_figure_form(settings, values);
  scene.fields = values.toggle("output.fields");
  scene.checkpoint = values.real("output.checkpoint");
}

std::optional<double> read_step_control(const Settings& settings, const Values& values) {
  if (values.text("lattice.time_steps") == "reversible") return values.real("lattice.step_control");
  if (values.given("lattice.step_control"))
    throw settings.error("lattice.step_control", "has no effect without lattice.time_steps = reversible; remove it");
  return std::nullopt;
}

FigureForm read_figure_form(const Settings& settings, const Values& values) {
  FigureForm form;
  form.titles = values.toggle("output.titles");
  form.formats.clear();
  for (std::string& format : parts_of(values.text("output.format").value_or(""), ','))
    if (std::ranges::find(form.formats, format) == form.formats.end()) form.formats.push_back(std::move(format));
  for (const std::string& format : form.formats)
    if (std::ranges::find(figure_formats, format) == figure_formats.end())
      throw settings.error("output.format", fmt::format("{} is none of {}", format.empty() ? "nothing" : format,
                                                        fmt::join(figure_formats, ", ")));
  return form;
}

Scene read_scene(const fs::path& file, const std::vector<Setting>& on_command_line) {
  return read_scene(read_settings(file, on_command_line));
}

Scene read_scene(Settings given) {
  Scene scene(std::move(given));
  Settings& settings = scene.settings;
  scene.name = settings.file().stem().string();
  const Values values(settings);
  for (const Parameter& key : settings.all_keys())
    values.check(key);  // in the order of the table, whatever reads them below
  if (const Setting* space = settings.find("lattice.space"); space && space->value == "complex")
    throw settings.error(
        "lattice.space",
        "works with run, resume, plan, verify, sweep, convergence and stability; use one of these, or another space");
  settings.keep_one_of("lattice.courant", "lattice.time_step", "give one of them, such as lattice.courant = 0.5");
  settings.keep_one_of("run.until", "run.steps", "give one of them, such as run.until = 100");
  try {
    scene.problem = read_problem(settings, values);
    keep_rates_or_momenta(settings, values, scene.problem);
    scene.initial = read_initial(values, scene.problem);
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
  if (!find_state(scene.initial.name).build) scene.initial_file = find_initial_file(settings, values);
  for (const char* unit : {"theory.speed", "theory.scale"})
    if (values.given(unit) &&
        (!scene.from_file() || find_method(scene.problem.method).place_sites || scene.problem.circle_valued))
      throw settings.error(unit,
                           "is of rows of a file, in units of their own: states and meshes have those of the theory. "
                           "Use delf verify --fields without [initial], or initial.state = file");
  scene.initial_frame = static_cast<int>(values.integer("initial.frame"));
  if (scene.from_file() && scene.problem.time_step < 0 && !values.given("initial.frame"))
    scene.initial_frame = last_frame(scene);
  if (scene.from_file()) take_first_row(scene, scene.initial_file, scene.initial_frame);
  scene.start = read_start(settings, values, scene.problem);
  scene.steps = read_steps(settings, values, scene.problem.time_step);
  if (scene.problem.step_control && !values.given("run.steps")) scene.until = values.real("run.until");
  read_output(settings, values, usual_records, scene);
  scene.times = values.times("output.times");
  scene.section = values.text("output.section").value_or("");
  const auto warn = [&](const Setting& s, const std::string& why) {
    scene.warnings.push_back(key_warning(settings, s, why));
  };
  for (const Parameter& key : settings.all_keys())
    if (const Setting* s = settings.find(key.key))
      if (const std::string why = why_without_effect(scene, key.key); !why.empty() && !is_for_others(scene, *s))
        warn(*s, why);
  // A scene serves many methods, and may have the stencil of one; what is asked for beside it is meant.
  if (const Setting* s = settings.find("lattice.stencil");
      s && s->line == 0 && !find_method(scene.problem.method).reads_stencil)
    warn(*s, fmt::format("scheme.method = {} has a stencil of its own", scene.problem.method));
  if (const double end = scene.end(); std::ranges::any_of(scene.times, [&](double t) { return t > end; }))
    warn(*settings.find("output.times"),
         fmt::format("the run ends at t = {:.6g}, and times after it have no row; raise run.until", end));
  if (values.real("scheme.tolerance") < smallest_tolerance)
    warn(*settings.find("scheme.tolerance"),
         fmt::format("rounding allows no less than {:.2g}, which is in force; raise it", smallest_tolerance));
  return scene;
}

std::string why_without_effect(const Scene& scene, std::string_view key) {
  if (const auto unread = why_not_read(scene, key); !unread.empty()) return unread;
  if (key.starts_with("stencil.") && scene.problem.stencil != stencil_as_text)
    return fmt::format("lattice.stencil = {} is in force", scene.problem.stencil);
  if ((key == "output.format" || key == "output.titles") && !scene.figures) return "output.figures = off is in force";
  if ((key == "output.xdmf" || key == "output.film") && !scene.fields) return "output.fields = off is in force";
  const bool of_steps = key == "lattice.time_steps" || key == "lattice.step_control";
  if (of_steps && scene.problem.step_control) return {};  // of moving sites
  return why_unread(kind_of(scene.problem.lattice), key);
}

}  // namespace delf

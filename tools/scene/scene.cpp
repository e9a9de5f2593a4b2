// SPDX-License-Identifier: MIT
#include "tools/scene/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/scene/keys.hpp"
#include "tools/scene/values.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr double usual_records = 400;

const TheoryInfo& theory_of(const Problem& problem) {
  const auto& all = theories();
  return *std::find_if(all.begin(), all.end(), [&](const TheoryInfo& t) { return t.name == problem.theory; });
}

Wall wall(const Values& values, std::string_view key) {
  return values.choice(key) == "natural" ? Wall::natural : Wall::fixed;
}

Lattice read_lattice(const Settings& settings, const Values& values) {
  const std::string space = values.choice("lattice.space");
  if (space == "point") return Lattice::point();
  const auto sites = static_cast<int>(values.integer("lattice.sites"));
  const double length = values.real("lattice.length");
  const Lattice lattice = space == "circle" ? Lattice::circle(sites, length)
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
  p.mass = values.real("theory.mass");
  p.lambda = values.real("theory.lambda");
  p.impurity_strength = values.real("theory.strength");
  p.impurity_width = values.real("theory.width");
  p.impurity_position = values.real("theory.position");
  p.lattice = read_lattice(settings, values);
  p.stencil = values.choice("lattice.stencil");
  p.method = values.choice("scheme.method");
  p.tolerance = values.real("scheme.tolerance");
  p.seed_order = static_cast<int>(values.integer("scheme.seed_order"));
  p.max_iterations = static_cast<int>(values.integer("scheme.max_iterations"));
  p.degree_time = static_cast<int>(values.integer("scheme.degree_time"));
  p.degree_space = static_cast<int>(values.integer("scheme.degree_space"));
  p.quadrature = values.choice("scheme.quadrature");
  p.order = static_cast<int>(values.integer("scheme.order"));
  p.space_order = static_cast<int>(values.integer("lattice.space_order"));
  p.alpha = values.real("scheme.alpha");
  p.threads = static_cast<int>(values.integer("run.threads"));
  const bool by_courant = values.given("lattice.courant");
  p.time_step = by_courant ? values.real("lattice.courant") * p.lattice.space_step() : values.real("lattice.time_step");
  if (!std::isnormal(p.time_step))
    throw settings.error(by_courant ? "lattice.courant" : "lattice.time_step",
                         "the time step is outside the range of double precision; use another");
  return p;
}

StateRequest read_initial(const Values& values, const Problem& problem) {
  StateRequest r;
  r.name = values.choice("initial.state");
  r.theory = problem.theory;
  r.mass = problem.mass;
  r.lambda = problem.lambda;
  r.components = theory_of(problem).components;
  r.position = values.maybe_real("initial.position");
  r.speed = values.maybe_real("initial.speed");
  r.separation = values.maybe_real("initial.separation");
  r.frequency = values.maybe_real("initial.frequency");
  r.wavenumber = values.maybe_real("initial.wavenumber");
  r.amplitude = values.maybe_real("initial.amplitude");
  r.epsilon = values.maybe_real("initial.epsilon");
  r.width = values.maybe_real("initial.width");
  r.eccentricity = values.maybe_real("initial.eccentricity");
  if (const auto winding = values.maybe_integer("boundary.winding"); winding && problem.lattice.is_circle())
    r.winding = static_cast<int>(*winding);
  r.seed = static_cast<std::uint64_t>(values.integer("run.seed"));
  return r;
}

// Beside the scene, where it is meant to be, or else from where the program is run.
fs::path find_initial_file(const Settings& settings, const Values& values) {
  const auto name = values.text("initial.file");
  if (!name) throw settings.error("initial.state", "needs initial.file, the fields.h5 or .csv to take rows from");
  std::error_code none;
  for (const fs::path& path : {settings.file().parent_path() / *name, fs::path(*name)})
    if (fs::exists(path, none)) {
      const fs::path found = fs::absolute(path).lexically_normal();
      if (found.string().find_first_of("#\n") == std::string::npos) return found;
      throw settings.error("initial.file", "a path in a scene holds neither # nor line breaks; rename it");
    }
  throw settings.error("initial.file", "no such file, neither beside the scene nor here; check the path");
}

std::optional<StartRule> read_start(const Settings& settings, const Values& values, const Problem& problem) {
  if (!values.given("initial.start")) return std::nullopt;
  const std::string rule = values.choice("initial.start");
  if (rule == "legendre" && problem.method != "spacetime" && problem.method != "composition")
    throw settings.error("initial.start", "needs scheme.method = spacetime or composition; use exact or centred");
  if (rule == "legendre") return StartRule::legendre;
  return rule == "exact" ? StartRule::exact : StartRule::centred;
}

std::int64_t read_steps(const Settings& settings, const Values& values, double time_step) {
  if (values.given("run.steps")) return values.integer("run.steps");
  const double steps = std::round(values.real("run.until") / time_step);
  if (!(steps <= find_key("run.steps")->range.high))
    throw settings.error(
        "run.until", fmt::format("is {:.3g} steps of {:.3g}, more than can be counted; use less", steps, time_step));
  return static_cast<std::int64_t>(steps);
}

}  // namespace

Scene read_scene(const fs::path& file, const std::vector<Setting>& on_command_line) {
  Scene scene(read_settings(file, on_command_line));
  scene.name = file.stem().string();
  Settings& settings = scene.settings;
  const Values values(settings);
  for (const Key& key : keys()) values.check(key);  // in the order of the table, whatever reads them below
  settings.keep_one_of("lattice.courant", "lattice.time_step", "give one of them, such as lattice.courant = 0.5");
  settings.keep_one_of("run.until", "run.steps", "give one of them, such as run.until = 100");
  try {
    scene.problem = read_problem(settings, values);
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
  scene.initial = read_initial(values, scene.problem);
  if (scene.initial.name == "file") scene.initial_file = find_initial_file(settings, values);
  scene.initial_frame = static_cast<int>(values.integer("initial.frame"));
  scene.start = read_start(settings, values, scene.problem);
  scene.steps = read_steps(settings, values, scene.problem.time_step);
  const auto every_default = std::llround(static_cast<double>(scene.steps) / usual_records);
  scene.every = values.maybe_integer("output.every").value_or(std::max(1LL, every_default));
  scene.figures = values.toggle("output.figures");
  scene.fields = values.toggle("output.fields");
  scene.times = values.times("output.times");
  for (const Key& key : keys())
    if (const Setting* s = settings.find(key.name))
      if (const std::string why = why_without_effect(scene, key.name); !why.empty())
        scene.warnings.push_back(fmt::format("{}: {}{} = {}: warning: {}", settings.place(key.name),
                                             s->line == 0 ? "--" : "", key.name, s->value, why));
  return scene;
}

const char* to_string(StartRule rule) {
  return rule == StartRule::exact ? "exact" : rule == StartRule::centred ? "centred" : "legendre";
}

std::string why_without_effect(const Scene& scene, std::string_view key) {
  const bool circle = scene.problem.lattice.is_circle(), point = scene.problem.lattice.space() == Space::point;
  if (key.starts_with("theory.") && key != "theory.name" && key != "theory.fibre") {
    const TheoryInfo& theory = theory_of(scene.problem);
    const bool read = std::find(theory.parameters.begin(), theory.parameters.end(), key) != theory.parameters.end();
    return read ? "" : "the theory " + theory.name + " does not read it";
  }
  if ((key == "lattice.sites" || key == "lattice.length") && point) return "a point has neither length nor sites";
  if ((key == "scheme.degree_time" || key == "scheme.degree_space" || key == "scheme.quadrature") &&
      scene.problem.method != "spacetime")
    return "only scheme.method = spacetime reads it";
  if ((key == "scheme.order" || key == "lattice.space_order") && scene.problem.method != "composition")
    return "only scheme.method = composition reads it";
  if (key == "scheme.alpha" && scene.problem.method != "r-adaptive") return "only scheme.method = r-adaptive reads it";
  if (key == "boundary.winding" && point) return "a point has no winding";
  if (key == "boundary.winding" && !circle) return "an interval has no winding";
  if ((key == "boundary.left" || key == "boundary.right") && point) return "a point has no walls";
  if ((key == "boundary.left" || key == "boundary.right") && circle) return "a circle has no walls";
  if ((key == "initial.file" || key == "initial.frame") && scene.initial.name != "file")
    return "only initial.state = file reads it";
  if (key.starts_with("initial.") && find_key(key)->type == KeyType::real) {
    const auto& all = states();
    const auto state =
        std::find_if(all.begin(), all.end(), [&](const StateInfo& s) { return s.name == scene.initial.name; });
    const bool read = state != all.end() && state->parameters.find(key.substr(8)) != std::string::npos;
    return read ? "" : "the state " + scene.initial.name + " does not read it";
  }
  return "";
}

}  // namespace delf

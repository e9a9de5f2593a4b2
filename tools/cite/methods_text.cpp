// SPDX-License-Identifier: MIT
#include "tools/cite/methods_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>

#include "schemes/driven_ends.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stability/stable_set.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "tools/cite/result_words.hpp"
#include "tools/cite/state_formulas.hpp"
#include "tools/cite/theory_words.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/scene/values.hpp"
#include "tools/warnings/vacuum_symbol.hpp"

namespace delf {
namespace {

using expressions::Notation;

template <class... Of>
std::optional<EquationsForPaper> equations_for_paper(const Of&... of) {
  auto latex = equations_in(Notation::latex, of...);
  auto plain = equations_in(Notation::plain, of...);
  if (!latex || !plain) return std::nullopt;
  plain->density = std::regex_replace(plain->density, std::regex("cosm1\\(([^()]*)\\)"), "(cos($1) - 1)");
  return EquationsForPaper{std::move(*latex), std::move(*plain)};
}

void say_discrete(PaperText& text, const std::optional<EquationsForPaper>& equations, bool on_point) {
  if (!equations || equations->latex.discrete.empty()) return;
  text.say(on_point ? "which, divided by the time step $h$, read at every row $j$"
                    : "which, divided by the time step $h$ and the space step $k$, read at every row $j$ and site $i$");
  const std::size_t count = equations->latex.discrete.size();
  for (std::size_t e = 0; e < count; ++e)
    text.display(equations->latex.discrete[e], equations->plain.discrete[e], e + 1 < count ? "," : ".");
}

std::vector<std::string> sources_of_method(const Problem& p) {
  const MethodEntry& method = find_method(p.method);
  std::vector<std::string> sources = method.sources;
  if (method.further_sources)
    for (const std::string& key : method.further_sources(p))
      if (std::ranges::find(sources, key) == sources.end()) sources.push_back(key);
  return sources;
}

/// The method with its order, and what it conserves; the equations of its stencil.
void say_method(PaperText& text, const Problem& p, const Simulation& simulation,
                const std::optional<EquationsForPaper>& equations) {
  const MethodEntry& method = find_method(p.method);
  const bool on_point = p.lattice.space() == Space::point;
  const bool shows = equations && !equations->latex.discrete.empty();
  text.say(fmt::format("We use {}{}{}", method.words ? method.words(p) : scheme_label(p),
                       citation_of(sources_of_method(p)), shows ? "," : "."));
  say_discrete(text, equations, on_point);
  if (const auto order = method.order ? method.order(p) : std::nullopt)
    text.say(fmt::format("The scheme is of order {}.", *order));
  std::vector<std::string> kept = simulation.conserved_names();
  for (std::string& name : kept) std::ranges::replace(name, '_', ' ');
  if (is_variational(simulation.evolution().system())) {
    const bool named = !kept.empty() && !kept[0].starts_with("symmetry"),
               is_quantity =
                   named && (kept[0].find("momentum") != kept[0].npos || kept[0].find("charge") != kept[0].npos);
    const std::string conserved = kept.size() > 1 ? fmt::format("the momenta of its {} symmetries{}", kept.size(),
                                                                named ? " (" + listed(kept) + ")" : "")
                                  : is_quantity   ? "the " + kept[0]
                                  : named         ? "the momentum of its symmetry, the " + kept[0]
                                                  : "the momentum of its symmetry";
    text.say(fmt::format("Being variational, it {}{}.",
                         on_point ? "is symplectic" : "satisfies the discrete multisymplectic form formula",
                         kept.empty() ? "" : ", and by the discrete Noether theorem it conserves " + conserved));
  } else
    text.say(on_point ? "It is not variational." : "It is not variational, and has no multisymplectic form formula.");
  if (const auto own = own_energy(simulation, p); own && method.own_energy == own->entry)
    text.say(fmt::format("Its rows have an energy of their own, the {}{}.", own->entry->name,
                         own->entry->formula.find("kept to ") == std::string::npos
                             ? ""
                             : ", " + own->entry->formula.substr(own->entry->formula.find("kept to "))));
}

/// The largest h/k, on a point h, of the first stable interval by linear theory; nothing where there is no such theory,
/// infinity where there is no limit up to `most`.
constexpr double most_courant = 3;
std::optional<double> linear_limit(const Scene& scene, const Simulation& simulation) {
  const auto vacuum = stable_vacuum(scene, simulation);
  if (!vacuum || !symbol_of(scene, simulation)) return std::nullopt;
  constexpr int sites = 32;
  const double k = scene.problem.lattice.space_step();
  try {
    const auto make = [&](double courant) {
      Problem p = scene.problem;
      if (p.lattice.space() != Space::point) p.lattice = Lattice::circle(sites, sites * k);
      p.winding = 0;
      for (const char* key : {left_end, right_end, left_flux, right_flux}) p.parameters[key] = std::string();
      p.time_step = courant * k;
      return Simulation(p).evolution().system();
    };
    const auto stable = stable_courants(make, most_courant,
                                        {.samples = 60, .tolerance = 1e-6, .constant = *vacuum, .wave_numbers = 65});
    if (stable.empty()) return std::nullopt;
    return stable.front().to >= most_courant ? std::numeric_limits<double>::infinity() : stable.front().to;
  } catch (const std::exception&) {  // what has no symbol on a circle has no limit here
    return std::nullopt;
  }
}

void say_lattice(PaperText& text, const Scene& scene, const Simulation& simulation, const ResultFolder* folder) {
  const Problem& p = scene.problem;
  const bool on_point = p.lattice.space() == Space::point;
  const double k = p.lattice.space_step();
  std::string words;
  const bool moves = simulation.evolution().system().moves();
  if (moves) words = fmt::format("The mesh has $N = {}$ nodes, which move with the field; ", p.lattice.sites());
  else if (!on_point)
    words = fmt::format("The lattice has {} sites, {} apart; ", fmt::format("$N = {}$", p.lattice.sites()),
                        equal_in_paper("k", k));
  if (p.step_control)
    words += fmt::format(
        "{} time steps are chosen by the field and run back the same{}, of the length $h = "
        "\\varepsilon/\\sqrt{{1 + s^2\\langle\\varphi_x^2\\rangle}}$ with {} and {}",
        words.empty() ? "The" : "the", citation_of({"hairer-soderlind-2005"}),
        equal_in_paper("\\varepsilon", p.time_step), equal_in_paper("s", *p.step_control));
  else if (!p.time_steps.empty())
    words += fmt::format("{} {} time steps of given lengths, in turn", words.empty() ? "There are" : "there are",
                         p.time_steps.size());
  else
    words += fmt::format("{} time step is {}{}", words.empty() ? "The" : "the", equal_in_paper("h", p.time_step),
                         on_point || moves ? "" : fmt::format(" ({})", equal_in_paper("h/k", p.time_step / k)));
  if (!scene.until) words += fmt::format(", and {} steps lead to {}", scene.steps, equal_in_paper("t", scene.end()));
  text.say(words + ".");
  const std::string limit = folder ? text_in(folder->result("summary"), "step_limit") : "";
  if (!limit.empty()) text.say(fmt::format("The step is limited at the start to {}.", limit));
  else if (const auto courant = linear_limit(scene, simulation))
    text.say(std::isinf(*courant) ? fmt::format("Linear theory finds no limit of the step up to {}.",
                                                equal_in_paper(on_point ? "h" : "h/k", most_courant))
                                  : fmt::format("By linear theory it is stable for ${} < {}.", on_point ? "h" : "h/k",
                                                number_in_paper(*courant, 4).substr(1)));
}

/// The initial state, "kink: phi = …" without the name, and the rule of the row behind it.
void say_start(PaperText& text, const Scene& scene, const InitialRows& initial) {
  std::string words = initial.description();
  std::vector<std::string> sources;
  if (scene.from_file()) words = "read from the file " + scene.initial_file.filename().string();
  else {
    const std::string& named = scene.initial.name;
    sources = find_state(named).sources;
    if (words.starts_with(named))
      if (const std::size_t end = words.find(": "); end != words.npos) words.erase(0, end + 2);
    if (sources == std::vector<std::string>{"delf"}) sources.clear();  // the scene says it
  }
  const char* const first_row =
      initial.rule() == StartRule::exact     ? "the second row is known with it"
      : initial.rule() == StartRule::centred ? "the second row solves the field equation at the first, with $y_{-1} = "
                                               "y_1 - 2h\\,\\varphi_t$"
      : initial.rule() == StartRule::values  ? "the first step needs no more than these values"
                                             : "the first step follows from the discrete Legendre transform";
  text.say(fmt::format("The initial state{} is {}; {}.", citation_of(sources), with_formulas(words), first_row));
}

/// How a step is solved, from the words of the plan.
void say_solution(PaperText& text, const std::string& solve, bool is_explicit, double tolerance) {
  const auto behind = [&](const std::string& mark) {
    const std::size_t at = solve.find(mark);
    return at == solve.npos ? std::string() : solve.substr(at + mark.size());
  };
  const std::string within =
                        fmt::format("to a last correction of at most {} of the field", number_in_paper(tolerance, 2)),
                    plan = citation_of({"hopcroft-karp-1973", "pothen-fan-1990"});
  const auto algebra = [](const std::string& matrix) {
    return matrix.find("LU") == matrix.npos ? matrix : matrix + citation_of({"eigen-2010"});
  };
  if (is_explicit || solve.empty()) {
    text.say("Each step is explicit.");
    return;
  }
  if (const std::string newton = behind("Newton's method: "); !newton.empty())
    text.say(fmt::format("Each step is solved by Newton's method, with {}, {}.", algebra(newton), within));
  else if (const std::string simplified = behind("iterated with the constant part: "); !simplified.empty())
    text.say(fmt::format(
        "Each step is solved by the simplified Newton method with the constant part of the Jacobian, inverted by "
        "{}, {}.",
        algebra(simplified), within));
  else if (const std::string once = behind("solved at once, "); !once.empty())
    text.say("The equations of a step are linear in its unknowns, and are solved at once.");
  else text.say(fmt::format("A step is solved by {}.", algebra(solve)));
  text.say(fmt::format(
      "Which equation determines which unknown, and in which blocks, is found by a maximum matching{}.", plan));
}

std::string end_in_words(const Scene& scene, const char* key) {
  const std::string value = Values(scene.settings).text(key).value_or("fixed");
  return value == "fixed"     ? "held fixed"
         : value == "natural" ? "free (the natural condition)"
         : value == "clamped" ? "clamped"
                              : "moved as " + with_formulas(value);
}

/// "on a circle of length 40 for 0 ≤ t ≤ 100"
std::string where_and_when(const Scene& scene, const InitialRows& initial) {
  const Problem& p = scene.problem;
  const std::string when = fmt::format("for $0\\le t\\le {}", number_in_paper(scene.end()).substr(1));
  if (p.lattice.space() == Space::point) return when;
  const std::string length = number_in_paper(p.lattice.length());
  if (p.lattice.is_circle()) {
    const double gain = initial.monodromy();
    return fmt::format("on a circle of length {}{} {}", length,
                       gain == 0 ? "" : fmt::format(", around which the field gains {},", number_in_paper(gain)), when);
  }
  const std::string left = end_in_words(scene, left_end), right = end_in_words(scene, right_end);
  return fmt::format(
      "on an interval of length {}, {}, {}", length,
      left == right ? "both ends " + left : fmt::format("the left end {} and the right end {}", left, right), when);
}

}  // namespace

PaperText methods_text(const Scene& scene, const ResultFolder* folder) {
  const InitialRows initial(scene);
  const Simulation simulation = build(scene, initial.winding());
  initial.check(simulation);
  const Problem& p = scene.problem;
  const auto equations = equations_for_paper(p, simulation);
  PaperText text;
  say_theory(text, scene, equations, where_and_when(scene, initial));
  say_method(text, p, simulation, equations);
  say_lattice(text, scene, simulation, folder);
  say_start(text, scene, initial);
  say_solution(text, simulation.solve_summary(), std::string(simulation.solve_kind()) == "explicit", p.tolerance);
  if (folder) say_results(text, *folder);
  say_program(text, folder, scene.fields);
  return text;
}

PaperText methods_text(const ComplexScene& c, const ResultFolder* folder) {
  const Scene& scene = c.scene;
  Problem p = scene.problem;
  std::optional<EquationsForPaper> equations = equations_for_paper(p, *c.theory);
  if (equations && c.space && c.space->mesh.dimension > 1) write_for_more_dimensions(*equations);
  std::string where = c.space ? fmt::format("on a mesh of {} points and {}", c.sites(), c.mesh_in_words())
                              : fmt::format("on a finite complex of spacetime of {} sites, with {} stencils", c.sites(),
                                            c.mesh_in_words().substr(std::string("stencils ").size()));
  if (!c.is_one_problem()) where += fmt::format(" for $0\\le t\\le {}", number_in_paper(scene.end()).substr(1));
  else if (c.time == MeshTime::none) where = "and seek its solutions at rest " + where;
  PaperText text;
  say_theory(text, scene, equations, where);

  std::optional<Simulation> simulation;
  if (c.time == MeshTime::rows) {
    p = c.problem_on_mesh();
    simulation.emplace(p);
    say_method(text, p, *simulation, std::nullopt);
  } else if (c.time == MeshTime::cells)
    text.say(fmt::format(
        "We use the asynchronous variational integrator{} with linear finite elements of lumped mass, in which "
        "each cell has its own step.",
        citation_of({"lew-marsden-ortiz-west-2003"})));
  else if (c.time == MeshTime::sites)
    text.say(fmt::format(
        "We use the discrete Euler–Lagrange equations of the cells{}: a site is interior if the complex holds "
        "all stencils that touch it, and they hold at all of these. Being variational, they satisfy the "
        "discrete multisymplectic form formula.",
        citation_of({"marsden-patrick-shkoller-1998"})));
  else
    text.say(
        "We use linear finite elements: the discrete field is a critical point of the action of the cells, with values "
        "given at the fixed points.");
  if (!c.is_one_problem()) {
    if (c.time == MeshTime::cells) {
      const std::vector<double> steps = cell_steps(c.space->mesh, p.cell_courant);
      const auto [least, largest] = std::ranges::minmax(steps);
      text.say(fmt::format("The steps of the cells are between {} and {} long.", number_in_paper(least),
                           number_in_paper(largest)));
    } else if (c.step_control())
      text.say(
          fmt::format("The time steps are chosen by the field and run back the same{}, of the length $h = "
                      "\\varepsilon/\\sqrt{{1 + s^2\\langle\\varphi_t^2\\rangle}}$ with {} and {}.",
                      citation_of({"hairer-soderlind-2005"}), equal_in_paper("\\varepsilon", p.time_step),
                      equal_in_paper("s", *c.step_control())));
    else
      text.say(fmt::format("The time step is {}, and {} steps lead to {}.", equal_in_paper("h", p.time_step),
                           scene.steps, equal_in_paper("t", scene.end())));
    if (simulation && !c.has_method())
      if (const auto most = longest_step(simulation->evolution().system()))
        text.say(
            fmt::format("By linear theory about 0 it is stable for $h < {}.", number_in_paper(*most, 4).substr(1)));
    if (simulation && c.theory->constraint())
      text.say(fmt::format("The constraint is kept at every row, as by SHAKE{}.",
                           citation_of({"ryckaert-ciccotti-berendsen-1977"})));
  }
  const auto given = [&](const char* kind, std::initializer_list<const char*> rates) {
    std::string words;
    for (const ComplexScene::Field& field : c.fields)
      for (const char* rate : rates)
        if (const Setting* formula = scene.settings.find(kind + field.name + rate))
          words += fmt::format("{}{}{} = {}", words.empty() ? "" : "; ", field.name, rate, formula->value);
    return with_formulas(words);
  };
  const std::string solution = given("exact.", {""}), initial = given("initial.", {"", "_t"});
  const char* const subject = c.time == MeshTime::none    ? "The field at the fixed points"
                              : c.time == MeshTime::sites ? "The field at the sites with data"
                                                          : "The initial state";
  if (!solution.empty()) text.say(fmt::format("{} is {}.", subject, solution));
  if (!initial.empty())
    text.say(fmt::format("{} is {}.", solution.empty() ? subject : "The first guess elsewhere", initial));
  if (simulation)
    say_solution(text, simulation->solve_summary(), std::string(simulation->solve_kind()) == "explicit", p.tolerance);
  else if (c.time == MeshTime::cells) text.say("Each update of a cell is explicit, in the order of a priority queue.");
  else
    text.say(fmt::format(
        "The equations are solved by Newton's method with a line search and a sparse LU factorisation{}, block "
        "after block of their block triangular form{}.",
        citation_of({"eigen-2010"}), citation_of({"hopcroft-karp-1973", "pothen-fan-1990"})));
  if (folder) say_results(text, *folder);
  say_program(text, folder, scene.fields);
  return text;
}

}  // namespace delf

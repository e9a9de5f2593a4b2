// SPDX-License-Identifier: MIT
#include "tools/cite/methods_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <regex>
#include <span>

#include "schemes/driven_ends.hpp"
#include "schemes/methods/energies.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stability/stable_set.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/cite/result_words.hpp"
#include "tools/cite/state_formulas.hpp"
#include "tools/cite/theory_words.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/run/moves_walls.hpp"
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

/// The equations of mechanics have rows and no sites: u^{j+1} for u_{i}^{j+1}.
void leave_out_sites(EquationsForPaper& equations) {
  for (std::string& formula : equations.latex.discrete) {
    formula = std::regex_replace(formula, std::regex("_\\{i\\}\\^\\{j"), "^{j");
    formula = std::regex_replace(formula, std::regex(",\\s*i\\}\\^\\{j"), "}^{j");
  }
  for (std::string& formula : equations.plain.discrete)
    formula = std::regex_replace(formula, std::regex("\\((j[-+]?[0-9]*),i\\)"), "($1)");
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

/// The names of what a run conserves by Noether's theorem, but for those that walls take up.
std::vector<std::string> conserved_between_walls(const Simulation& simulation,
                                                 const std::vector<LinearSymmetry>& symmetries,
                                                 std::span<const double> row0, const Problem& p) {
  std::vector<std::string> kept = simulation.conserved_names();
  std::erase_if(kept, [&](const std::string& name) {
    const auto symmetry = std::ranges::find(symmetries, name, &LinearSymmetry::name);
    return symmetry != symmetries.end() && moves_walls(*symmetry, row0, p);
  });
  for (std::string& name : kept) std::ranges::replace(name, '_', ' ');
  return kept;
}

/// The method with its order, and what it conserves; the equations of its stencil.
void say_method(PaperText& text, const Problem& p, const Simulation& simulation,
                const std::optional<EquationsForPaper>& equations, const std::vector<std::string>& kept) {
  const MethodEntry& method = find_method(p.method);
  const bool on_point = p.lattice.space() == Space::point;
  const bool shows = equations && !equations->latex.discrete.empty();
  text.say(fmt::format("We use {}{}{}", method.words ? method.words(p) : scheme_label(p),
                       citation_of(sources_of_method(p)), shows ? "," : "."));
  say_discrete(text, equations, on_point);
  if (const auto order = method.order ? method.order(p) : std::nullopt)
    text.say(fmt::format("The scheme is of order {}.", *order));
  if (is_variational(simulation.evolution().system())) {
    const bool named = !kept.empty() && !kept[0].starts_with("symmetry"),
               is_quantity =
                   named && (kept[0].find("momentum") != kept[0].npos || kept[0].find("charge") != kept[0].npos);
    const std::string conserved = kept.size() > 1 ? fmt::format("the momenta of its {} symmetries{}", kept.size(),
                                                                named ? " (" + listed(kept) + ")" : "")
                                  : is_quantity   ? "the " + kept[0]
                                  : named         ? "the momentum of its symmetry, the " + kept[0]
                                                  : "the momentum of its symmetry";
    if (p.step_control)
      text.say(fmt::format(
          "For given lengths of its steps it is variational{}. The field chooses them, and the map from rows to rows is "
          "reversible, not symplectic.",
          kept.empty() ? "" : ", and by the discrete Noether theorem each step conserves " + conserved));
    else
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
    if (stable.front().to < most_courant) return stable.front().to;
    // what was looked at must hold the run's own step
    if (scene.problem.time_step / k > most_courant) return std::nullopt;
    return std::numeric_limits<double>::infinity();
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

/// The sources of a state that hold for the theory: where it names some of them, those of other theories are left out.
std::vector<std::string> sources_of_state(const StateEntry& state, const std::string& theory) {
  std::vector<std::string> sources = state.sources;
  const auto names = [](const std::string& of, const std::string& key) {
    return std::ranges::find(find_theory(of).sources, key) != find_theory(of).sources.end();
  };
  if (std::ranges::none_of(sources, [&](const std::string& key) { return names(theory, key); })) return sources;
  std::erase_if(sources, [&](const std::string& key) {
    const auto named = [&](const std::string& other) { return names(other, key); };
    return !names(theory, key) &&
           (std::ranges::any_of(state.exact, named) || std::ranges::any_of(state.approximate, named));
  });
  return sources;
}

std::vector<std::string> names_of_fields(const auto& fields) {
  std::vector<std::string> names;
  for (const auto& field : fields) names.push_back(field.name);
  return names;
}

/// The initial state, "kink: phi = …" without the name, and the rule of the row behind it.
void say_start(PaperText& text, const Scene& scene, const InitialRows& initial, const Simulation& simulation) {
  std::string words = initial.description();
  std::vector<std::string> sources;
  if (scene.from_file()) words = "read from the file " + scene.initial_file.filename().string();
  else {
    const std::string& named = scene.initial.name;
    sources = sources_of_state(find_state(named), scene.problem.theory);
    if (words.starts_with(named))
      if (const std::size_t end = words.find(": "); end != words.npos) words.erase(0, end + 2);
    if (sources == std::vector<std::string>{"delf"}) sources.clear();  // the scene says it
  }
  const char* const first_row =
      initial.rule() == StartRule::exact     ? "the second row is known with it"
      : initial.rule() == StartRule::centred ? "the second row solves the field equation at the first, with $y_{-1} = "
                                               "y_1 - 2h\\,\\varphi_t$"
      : initial.rule() == StartRule::values  ? "the first step needs no more than these values"
      : is_variational(simulation.evolution().system()) ? "the first step follows from the discrete Legendre transform"
      : scene.problem.lattice.space() == Space::point   ? "the first step starts from $q$ and $q_t$"
                                                        : "the first step starts from the field and its rate";
  words = with_formulas(with_names_of_equations(words, scene, names_of_fields(simulation.theory().fields())));
  text.say(fmt::format("The initial state{} is {}{}; {}.", citation_of(sources), words, parameters_of_start(scene),
                       first_row));
}

/// How a step is solved, from the words of the plan.
void say_solution(PaperText& text, const Simulation& simulation, double tolerance) {
  const std::string solve = simulation.solve_summary();
  // a plan may be explicit for unknowns that are still found by iteration, one by one
  const bool is_explicit = std::string(simulation.solve_kind()) == "explicit" &&
                           solve.find("iterated with") == solve.npos && solve.find("Newton") == solve.npos;
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
  auto equations = equations_for_paper(p, simulation);
  if (equations && p.lattice.space() == Space::point) leave_out_sites(*equations);
  PaperText text;
  say_theory(text, scene, equations, where_and_when(scene, initial));
  say_method(text, p, simulation, equations,
             conserved_between_walls(simulation, simulation.symmetries(), initial.row0(), p));
  say_lattice(text, scene, simulation, folder);
  say_start(text, scene, initial, simulation);
  say_solution(text, simulation, p.tolerance);
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
    say_method(text, p, *simulation, std::nullopt,
               conserved_between_walls(*simulation, c.theory->symmetries(), c.values(), scene.problem));
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
    if (simulation && !c.has_method() && !c.theory->constraint())  // 0 need not be on the surface of a constraint
      if (const auto most = longest_step(simulation->evolution().system()))
        text.say(
            fmt::format("By linear theory about 0 it is stable for $h < {}.", number_in_paper(*most, 4).substr(1)));
    if (simulation && c.theory->constraint())
      text.say(fmt::format("The constraint is kept at every row, as by SHAKE{}.",
                           citation_of({"ryckaert-ciccotti-berendsen-1977"})));
  }
  const bool in_time = c.time == MeshTime::rows || c.time == MeshTime::cells;
  const auto given = [&](const char* kind, std::initializer_list<const char*> rates) {
    std::string words;
    for (const ComplexScene::Field& field : c.fields)
      for (const char* rate : rates) {
        const Setting* formula = scene.settings.find(kind + field.name + rate);
        const bool rests = !formula && *rate != 0 && in_time && scene.settings.find(kind + field.name);
        if (formula || rests)
          words +=
              fmt::format("{}{}{} = {}", words.empty() ? "" : "; ", field.name, rate, rests ? "0" : formula->value);
      }
    return with_formulas(with_names_of_equations(words, scene, names_of_fields(c.fields)));
  };
  const std::string solution = given("exact.", {""}), initial = given("initial.", {"", "_t"});
  const char* const subject = c.time == MeshTime::none    ? "The field at the fixed points"
                              : c.time == MeshTime::sites ? "The field at the sites with data"
                                                          : "The initial state";
  const bool is_legendre = !simulation || is_variational(simulation->evolution().system());
  const std::string where_values = parameters_of_start(scene),
                    first_step = !in_time      ? ""
                                 : is_legendre ? "; the first step follows from the discrete Legendre transform"
                                               : "; the first step starts from the field and its rate";
  if (!solution.empty())
    text.say(fmt::format("{} is {}{}{}{}.", subject, solution, where_values,
                         in_time ? " at $t = 0$, with the rate of this solution" : "", first_step));
  if (!initial.empty())
    text.say(fmt::format("{} is {}{}{}.", solution.empty() ? subject : "The first guess elsewhere", initial,
                         solution.empty() ? where_values : "", solution.empty() ? first_step : ""));
  if (simulation) say_solution(text, *simulation, p.tolerance);
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

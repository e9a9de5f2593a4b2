// SPDX-License-Identifier: MIT
#include "tools/rows/initial_rows.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/moving_start.hpp"
#include "schemes/start_values.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/system/constraint_slopes.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/rows/exact_solution.hpp"
#include "tools/rows/frame_of.hpp"
#include "tools/scene/mesh_methods.hpp"

namespace delf {

namespace {

/// Throws BadScene if the field, or its rate, is a formula of the scene, which has no value there.
void require_formula_has_value(const Scene& scene, std::size_t field, bool rate, double t, const Lattice& lattice,
                               std::size_t site) {
  if (field >= scene.initial.fields.size()) return;
  const std::string& name = scene.initial.fields[field];
  for (const std::string& key : {"exact." + name, "initial." + name + (rate ? "_t" : "")})
    if (scene.settings.find(key))
      throw scene.settings.error(
          key,
          fmt::format("has no finite value{} at t = {:.6g}, x = {:.6g} (site {}); write it so that it has one there, "
                      "such as sin(x + 1e-9)/(x + 1e-9) for sin(x)/x",
                      rate && key.starts_with("exact") ? ", or its rate none," : "", t,
                      lattice.position(static_cast<int>(site)), site));
}

/// Throws BadScene for a rule that the state, or the density, does not allow.
void check_rule(const Scene& scene, const State& state, StartRule rule) {
  const Settings& settings = scene.settings;
  if (rule == StartRule::exact && !state.knows_second_row()) {
    const Problem& p = scene.problem;
    const bool constrained =
        p.lattice.space() != Space::point && make_theory(find_theory(p.theory), p.parameters)->constraint() != nullptr;
    throw settings.error("initial.start", fmt::format("the second row of this state is not known; {}",
                                                      constrained                ? "give a solution as exact.FIELD"
                                                      : may_start_from_values(p) ? "use values"
                                                                                 : "use centred"));
  }
  if (rule == StartRule::centred && is_of_first_order_in_time(scene.problem))
    throw settings.error("initial.start",
                         "the density is linear in phi_t, so that no rate enters row 1; use values, or leave it out");
  if (rule != StartRule::values) return;
  if (find_method(scene.problem.method).start != StartRule::values && !is_of_first_order_in_time(scene.problem))
    throw settings.error("initial.start", "is for densities that are linear in phi_t; use centred");
  for (const char* key : {"initial.v", "initial.p"})
    if (scene.initial.values.has(key))
      throw settings.error(key, fmt::format("scheme.method = {} is of first order in time, and starts from "
                                            "values alone; leave {} out",
                                            scene.problem.method, key));
}

/// Throws BadScene where a gradient ∂G_m/∂φ is zero, or a sum of those before it: no multipliers are determined there.
void require_independent(const Scene& scene, const StencilFamily& constraint, std::size_t d,
                         const std::vector<double>& row) {
  constexpr double small = 1e-10;
  ConstraintSlopes G(constraint, d);
  for (std::size_t i = 0; i * d < row.size(); ++i) {
    std::vector<std::vector<double>> units;
    for (std::size_t m = 0; m < G.constraints(); ++m) {
      G.at(m, std::span(row).subspan(i * d, d));
      std::vector<double> rest(G.slopes().begin(), G.slopes().end());
      const auto size = [&] { return std::sqrt(std::inner_product(rest.begin(), rest.end(), rest.begin(), 0.0)); };
      const double whole = size();
      for (const std::vector<double>& unit : units) {
        const double part = std::inner_product(rest.begin(), rest.end(), unit.begin(), 0.0);
        for (std::size_t a = 0; a < d; ++a) rest[a] -= part * unit[a];
      }
      const double left = size();
      if (!(left > small * whole))
        throw scene.settings.error(
            "theory.constraint",
            fmt::format("the gradient of constraint {} is {} at the start{}: they do not determine their multipliers; "
                        "leave out what follows from the others, or start elsewhere",
                        m + 1, whole > 0 ? "a sum of those of the constraints before it" : "zero",
                        row.size() > d ? fmt::format(", at site {}", i) : ""));
      for (double& x : rest) x /= left;
      units.push_back(std::move(rest));
    }
  }
}

/// Throws BadScene for a driven end whose formulas break a constraint at the start.
void require_constraints_at_ends(const Scene& scene, const FieldTheory& theory) {
  const auto constraint = theory.constraint();
  if (!constraint) return;
  ConstraintSlopes G(*constraint, at(theory.components()));
  for (const char* key : {left_end, right_end}) {
    std::vector<double> fields;
    for (const FormulaOfTime& of : motion_of_end(theory, scene.problem, key)) fields.push_back(of(0));
    for (std::size_t m = 0; m < G.constraints() && !fields.empty(); ++m) {
      const double value = G.at(m, fields);
      constexpr double small = 1e-8;
      if (!(std::abs(value) <= small * std::max(constraint_terms(G.slopes(), fields), 1.0)))
        throw scene.settings.error(
            key, fmt::format("breaks the constraint{}: it is {:.6g} at t = 0, and not 0; give formulas that keep it",
                             G.constraints() > 1 ? fmt::format(" {}", m + 1) : "", value));
    }
  }
}

/// Throws BadScene for a row that leaves the surface of a constraint.
void require_constraints(const Scene& scene, const FieldTheory& theory, const std::vector<double>& row) {
  constexpr double small = 1e-6;  // a formula or a file may have few digits
  const auto constraint = theory.constraint();
  if (!constraint) return;
  const std::size_t d = at(theory.components());
  ConstraintSlopes G(*constraint, d);
  for (std::size_t i = 0; i * d < row.size(); ++i)
    for (std::size_t m = 0; m < G.constraints(); ++m) {
      const auto fields = std::span(row).subspan(i * d, d);
      const double value = G.at(m, fields);
      if (std::abs(value) <= small * std::max(constraint_terms(G.slopes(), fields), 1e-300)) continue;
      const char* key = scene.from_file()                  ? "initial.file"
                        : scene.settings.find("initial.q") ? "initial.q"
                                                           : "initial.state";
      throw scene.settings.error(
          key,
          fmt::format("breaks the constraint{}{}: it is {:.6g} at the start, and not 0; give fields on its surface",
                      G.constraints() > 1 ? fmt::format(" {}", m + 1) : "",
                      row.size() > d ? fmt::format(" at site {}", i) : "", value));
    }
  require_independent(scene, *constraint, d, row);
}

}  // namespace

InitialRows::InitialRows(const Scene& scene) : scene_(scene) {
  const Settings& settings = scene.settings;
  try {
    if (!scene.from_file()) {
      state_ = make_state(scene.initial, scene.problem.lattice);
      if (state_->exact()) require_solution(scene, *state_);
      check_rule(scene, *state_, rule());
      return;
    }
    read_file();
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
}

int InitialRows::winding() const {
  if (!scene_.problem.lattice.is_circle()) return 0;
  if (file_) return winding_;
  return scene_.initial.winding.value_or(state_->winding());
}

double InitialRows::monodromy() const {
  return scene_.problem.lattice.is_circle() ? 2 * std::numbers::pi * winding() + gain_of(scene_.problem.parameters) : 0;
}

/// φ_x at a wall, of each field: the state's own, or of rows the slope of a cubic,
///
///     φ_x = (−11y₀ + 18y₁ − 9y₂ + 2y₃)/6k,    y_j the site j away from the wall; at the right wall of the other sign.
///
std::vector<double> InitialRows::slopes(bool left) const {
  const Lattice& lattice = scene_.problem.lattice;
  const int wall = left ? 0 : lattice.sites() - 1;
  std::vector<double> slopes;
  if (state_) {
    std::vector<FieldPoint> fields(state_->components());
    state_->at(0, lattice.position(wall), fields);
    for (const FieldPoint& field : fields) slopes.push_back(field.phi_x);
    return slopes;
  }
  const std::vector<double> row = row0();
  const std::size_t d = file_->components();
  constexpr std::array weights{-11., 18., -9., 2.};
  for (std::size_t a = 0; a < d; ++a) {
    double sum = 0;
    for (int j = 0; j < 4 && j < lattice.sites(); ++j) sum += weights[j] * row[at(left ? j : wall - j) * d + a];
    slopes.push_back((left ? sum : -sum) / (6 * lattice.space_step()));
  }
  return slopes;
}

void InitialRows::keep_slopes(Problem& problem) const {
  if (problem.lattice.space() != Space::interval || !find_method(problem.method).reads_stencil) return;
  for (const bool left : {true, false}) {
    const char* const key = left ? "boundary.left_slope" : "boundary.right_slope";
    if ((left ? problem.lattice.left() : problem.lattice.right()) == Wall::clamped && !problem.parameters.has(key))
      problem.parameters[key] = fmt::format("{:.17g}", fmt::join(slopes(left), ","));
  }
}

StartRule InitialRows::rule() const {
  const MethodEntry& method = find_method(scene_.problem.method);
  // of a method that starts from momenta, where the file has them
  if (file_ && method.start == StartRule::legendre && file_->momenta(scene_.initial_frame)) return StartRule::legendre;
  if (own_step_)
    for (const StartRule rates : {StartRule::legendre, StartRule::centred})
      if (std::ranges::count(method.starts, rates) > 0) return rates;
  if (file_) return StartRule::exact;
  if (scene_.start) return *scene_.start;
  if (method.start) return *method.start;
  if (state_->knows_second_row()) return StartRule::exact;
  return is_of_first_order_in_time(scene_.problem) ? StartRule::values : StartRule::centred;
}

std::string InitialRows::description() const {
  return state_ ? state_->description() + (rule() == StartRule::values && !find_method(scene_.problem.method).start
                                               ? "; the density is linear in phi_t, and no rate is read"
                                               : "")
                : fmt::format("rows of {}, from {} {}", scene_.initial_file.string(),
                              scene_.initial_file.extension() == ".csv" ? "row" : "frame", scene_.initial_frame);
}

void InitialRows::check(const Simulation& simulation) const {
  const int here = state_ ? state_->components() : file_->components(), fields = simulation.count(Role::field);
  // the positions of sites that move are the method's to find
  if (here == (state_ && starts_by_sites(simulation, scene_.problem) ? simulation.theory().components() : fields)) {
    if (file_) require_positions(simulation);
    require_constraints_at_ends(scene_, simulation.theory());
    require_constraints(scene_, simulation.theory(), file_ ? file_row(simulation, 0) : row0());
    return;
  }
  std::string names;
  for (const Component& c : simulation.components())
    if (c.role == Role::field) names += (names.empty() ? "" : ", ") + c.name;
  const auto counted = [](int n) { return fmt::format("{} field{}", n, n == 1 ? "" : "s"); };
  const std::string mismatch = fmt::format("has {}, and the scheme has {} ({})", counted(here), counted(fields), names);
  throw scene_.settings.error(file_ ? "initial.file" : "initial.state",
                              mismatch + (file_ ? "; give as many" : "; give rows of all by initial.state = file"));
}

std::vector<double> InitialRows::row0() const {
  return file_ ? file_->row(scene_.initial_frame) : values(&State::values, 0, scene_.problem.lattice);
}

std::vector<double> InitialRows::values(Writer write, double time, const Lattice& lattice) const {
  std::vector<double> out(at(lattice.sites()) * at(state_->components()));
  (state_.get()->*write)(time, lattice, out);
  const std::size_t d = at(state_->components());
  for (std::size_t n = 0; n < out.size(); ++n)
    if (!std::isfinite(out[n]))
      require_formula_has_value(scene_, n % d, write == &State::velocities, time, lattice, n / d);
  return out;
}

/// The slaved values in a row of the file: [i·components + c]; empty where the file has not all of them.
std::vector<double> InitialRows::slaved_in_file(const Simulation& simulation, int row) const {
  const auto* fields = dynamic_cast<const FieldsReader*>(file_.get());
  if (!fields || simulation.count(Role::slaved) == 0) return {};
  const FieldsReader::Shape& shape = fields->shape(Role::slaved);
  const int frame = frame_of(scene_, row);
  if (shape.components != simulation.count(Role::slaved) || shape.sites != file_->sites() || frame >= shape.frames)
    return {};
  return fields->values(Role::slaved, frame);
}

std::vector<double> InitialRows::section(const Simulation& simulation, Writer write, int row, bool with_times) const {
  const auto& components = simulation.components();
  const auto d = components.size(), fields = at(simulation.count(Role::field));
  const std::size_t sites = scene_.problem.lattice.sites();
  const double h = scene_.problem.time_step, k = scene_.problem.lattice.space_step();
  std::vector<double> out(sites * d), at_node;
  const std::vector<double> slaved = slaved_in_file(simulation, row);
  const std::size_t all_slaved = slaved.size() / sites;
  std::size_t which_slaved = 0;
  NodePosition node{};
  for (std::size_t c = 0; c < d; ++c) {
    if (components[c].role == Role::multiplier) continue;
    if (components[c].role == Role::slaved) {
      // sites that move start from where the file has them, or else those of the lattice are, at rest
      if (all_slaved > 0)
        for (std::size_t i = 0; i < sites; ++i) out[i * d + c] = slaved[i * all_slaved + which_slaved];
      else if (components[c].position && write == &State::values)
        for (std::size_t i = 0; i < sites; ++i) out[i * d + c] = scene_.problem.lattice.position(static_cast<int>(i));
      ++which_slaved;
      continue;
    }
    const std::size_t a = components[c].field;
    if (at_node.empty() || components[c].at.time != node.time || components[c].at.space != node.space) {
      node = components[c].at;
      if (file_) at_node = file_row(simulation, row);
      else
        at_node =
            values(write, (row + (with_times ? node.time : 0)) * h, scene_.problem.lattice.shifted(node.space * k));
    }
    for (std::size_t i = 0; i < sites; ++i) out[i * d + c] = at_node[i * fields + a];
  }
  return out;
}

std::vector<double> InitialRows::section(const Simulation& simulation, int row) const {
  return section(simulation, &State::values, row, true);
}

void InitialRows::start_momenta(Simulation& simulation) const {
  const auto& components = simulation.components();
  const std::vector<double> of_fields = in_order(simulation, *file_->momenta(scene_.initial_frame));
  const auto d = components.size(), fields = at(simulation.count(Role::field));
  const std::vector<double> row0 = section(simulation, 0);
  std::vector<double> momenta(row0.size(), 0.0);
  for (std::size_t c = 0; c < d; ++c)
    if (components[c].role == Role::field)
      for (std::size_t i = 0; i * d < momenta.size(); ++i)
        momenta[i * d + c] = of_fields[i * fields + at(components[c].field)];
  simulation.start_momenta(row0, momenta);
}

/// Between row `j` of the run and the row before it; nothing if the file has no times.
std::optional<double> InitialRows::step_in_file(int j) const {
  const auto before = file_->time(frame_of(scene_, j - 1)), after = file_->time(frame_of(scene_, j));
  return before && after ? std::optional(*after - *before) : std::nullopt;
}

/// The file has the first step, and steps go on from it: ρ_½ = ε/h_½.
void InitialRows::start_by_own_step(Simulation& simulation, const std::vector<std::vector<double>>& rows) const {
  constexpr double far = 1.5;  // ρ_½ is half a step away from what row 1 asks for
  const auto step = step_in_file(1);
  if (!step || !(*step > 0))
    throw BadInput("initial.file",
                   "has no times, which steps that the field chooses begin with; give a fields.h5 of delf");
  const double longest = scene_.problem.time_step;
  simulation.start(rows, longest / *step);
  const double chosen = longest / simulation.row_density().density;
  if (*step < far * chosen && chosen < far * *step) return;
  throw BadInput("initial.frame",
                 fmt::format("frames {} and {} of the file are {:.6g} apart, and the field there chooses steps of "
                             "{:.6g}; use lattice.time_step and lattice.step_control of the file, and record it with "
                             "output.every = 1",
                             scene_.initial_frame, frame_of(scene_, 1), *step, chosen));
}

void InitialRows::start(Simulation& simulation) const {
  check(simulation);
  const double h = scene_.problem.time_step;
  try {
    if (own_step_ && simulation.starting_rows() > 1 && !file_->momenta(scene_.initial_frame))
      return start_by_rates(simulation);
    if (file_ && rule() == StartRule::legendre) return start_momenta(simulation);
    if (file_ && simulation.count(Role::inner) + simulation.count(Role::trace) > 0)
      throw BadInput("initial.state",
                     "a file has no values at the nodes inside the cells, and this one no /momentum to start elements "
                     "from; give a file that has it, or choose another state");
    if (file_ && simulation.is_processed())
      throw BadInput("initial.state", "a file has no rates, which a kernel starts from; choose another state");
    if (rule() == StartRule::centred)
      return simulation.start_centred(section(simulation, 0), section(simulation, &State::velocities, 0, true));
    if (state_ && starts_by_sites(simulation, scene_.problem)) {
      if (rule() != StartRule::legendre)
        throw BadInput("initial.start",
                       "initial.start = exact: sites that move start from row 0 and its rates; use legendre");
      return start_by_sites(simulation, scene_.problem,
                            [this](double x, std::span<FieldPoint> out) { state_->at(0, x, out); });
    }
    if (rule() == StartRule::legendre)
      return simulation.start_legendre(section(simulation, &State::values, 0, false),
                                       section(simulation, &State::velocities, 0, false));
    if (rule() == StartRule::values && simulation.starting_rows() > 1)
      return start_from_values(simulation, section(simulation, 0), monodromy());
    std::vector<std::vector<double>> rows;
    for (int j = 0; j < simulation.starting_rows(); ++j) rows.push_back(section(simulation, j));
    if (file_ && scene_.problem.step_control) return start_by_own_step(simulation, rows);
    for (int j = 1; file_ && j < simulation.starting_rows(); ++j)
      if (const auto step = step_in_file(j);
          step && !(std::abs(*step - h) <= 1e-9 * std::abs(h) + 1e-15 * std::abs(*file_->time(frame_of(scene_, j)))))
        throw BadInput(
            "initial.frame",
            fmt::format("frames {} and {} of the file are {:.12g} apart, and the time step is {:.10g}; use "
                        "lattice.time_step = {:.12g}, {}or record with output.every = 1, or start from values "
                        "and rates by initial.time_step = {:.12g}",
                        frame_of(scene_, j - 1), frame_of(scene_, j), *step, h, *step,
                        has_reversible_steps(find_method(scene_.problem.method))
                            ? "lattice.time_steps = reversible if the field chose the steps of the file, "
                            : "",
                        *step));
    simulation.start(rows);
  } catch (const BadInput& bad) {
    throw scene_.settings.located(bad);
  }
}

}  // namespace delf

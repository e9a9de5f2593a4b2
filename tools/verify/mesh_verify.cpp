// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iterator>
#include <utility>

#include "lattice/complex/complex_plan.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/complex/asynchronous_window.hpp"
#include "schemes/methods/mesh_rows.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/mesh_energy.hpp"
#include "schemes/theories/mirrored_in_time.hpp"
#include "schemes/verify/first_and_last_step.hpp"
#include "schemes/verify/fitted_multipliers.hpp"
#include "tools/complex/mesh_stepping.hpp"
#include "tools/complex/mesh_summary.hpp"
#include "tools/complex/static_field.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/scene/values.hpp"
#include "tools/verify/checked_rows.hpp"
#include "tools/verify/energy_history.hpp"
#include "tools/verify/further_runs.hpp"
#include "tools/verify/mesh_checks.hpp"
#include "tools/verify/verdict.hpp"
#include "tools/verify/verify.hpp"

namespace delf {
namespace {

/// The rows that are checked, in windows of consecutive ones, or a static field.
class MeshVerification {
 public:
  MeshVerification(const ComplexScene& scene, const Values& values)
      : scene_(scene),
        checks_(scene, values),
        moments_(static_cast<int>(values.integer("verify.moments"))),
        tolerance_(values.real("verify.tolerance")) {
    first_step_ = {.name = "form of the first step, the last as long", .region = {}, .tolerance = tolerance_};
    order_ = {.name = "order of the updates, planned", .region = {}, .tolerance = 0};
    verdict_.seed = scene.scene.initial.seed;
    verdict_.subject = "rows computed here";
  }

  /// Of rows computed here, or of those of a file.
  Verdict run(const std::optional<std::string>& fields) {
    const auto begin = std::chrono::steady_clock::now();
    if (fields) look_at_file(*fields);
    else if (scene_.is_one_problem()) look_at_field();
    else if (scene_.time == MeshTime::cells) look_at_cells();
    else look_at_rows();
    checks_.add_to(verdict_);
    if (order_.samples > 0) verdict_.checks.push_back(order_);
    if (!first_rows_.empty() && verdict_.status == "done") reverse();
    if (first_step_.samples > 0) verdict_.checks.push_back(first_step_);
    if (scene_.theory->constraint() && !scene_.scene.problem.time_steps.empty())
      verdict_.left_out.push_back("form of the first step: not for theories with a constraint");
    if (scene_.step_control()) verdict_.left_out.emplace_back(not_symplectic);
    std::vector<std::string> elsewhere{"rectangles, staircases and slabs of a lattice",
                                       "balances of energy and momentum"};
    if (scene_.time != MeshTime::rows) elsewhere.emplace_back("time reversal without rows");
    for (const std::string& name : elsewhere) verdict_.left_out.push_back(name + ": not applicable to a mesh");
    verdict_.seconds = seconds_since(begin);
    return std::move(verdict_);
  }

 private:
  static constexpr int window = 5;

  /// Every row but the first and the last has an equation; windows overlap by two rows.
  void look_at_file(const std::string& name) {
    const auto refuse = [&](const std::string& why) -> BadScene {
      return BadScene(fmt::format("command line: --fields: {}: {}", name, why));
    };
    if (scene_.time == MeshTime::cells)
      throw refuse("asynchronous rows hold sites at times of their own; verify the scene without --fields");
    const FieldsReader file(name);
    const auto d = static_cast<int>(scene_.fields.size());
    if (file.sites() != scene_.sites() || file.components() != d)
      throw refuse(fmt::format("has {} sites and {} fields, and the scene {} and {}; use the scene of these rows",
                               file.sites(), file.components(), scene_.sites(), d));
    require_same_places(file, name);
    verdict_.subject = "rows of " + name;
    const int frames = file.frames();
    if (scene_.is_one_problem()) {
      const std::vector<double> row = file.row(frames - 1);
      const std::string where = fmt::format("frame {}", frames - 1);
      if (scene_.stencils) return checks_.look_at(checked(StaticField(scene_).system(), row), where);
      return look_at_mesh(row, multipliers_of(file, name, frames - 1, 1), where);
    }
    if (frames < 3) throw refuse(fmt::format("has {} frames, and an equation takes three; record more rows", frames));
    const LatticeSystem system = system_of_rows(scene_);
    WindowsOnMesh windows(system);
    for (int first = 0, last = 0; last < frames - 1 && !Interrupt::asked(); first = last - 1) {
      last = std::min(first + window, frames) - 1;
      first = std::min(first, last - 2);
      std::vector<std::vector<double>> rows;
      std::vector<double> times;
      for (int f = first; f <= last; ++f) {
        rows.push_back(row_of(system, file.row(f)));
        const auto time = file.time(f);
        if (!time) throw refuse("has no /time; record it");
        if (!times.empty() && !(*time > times.back()))
          throw refuse(fmt::format("frame {} is not later than the one before it; sort the frames", f));
        times.push_back(*time);
      }
      system.times()->set(times);
      // Frame f + 1 has those of row f, which they were found with; the last row of a window has none.
      const std::vector<double> multipliers = multipliers_of(file, name, first + 1, last - first);
      Window held = system.window(0, std::move(rows), 0);
      if (scene_.theory->constraint() && multipliers.empty()) fit_multipliers(system, held);
      const std::size_t m = at(scene_.space->constraints()), of_row = scene_.space->multipliers_of_row();
      for (std::size_t n = of_row; n < multipliers.size(); ++n) {  // of A_i ½(h_below + h_above) λ_i G
        const std::size_t row = n / of_row, i = n % of_row / m;
        held.rows[row][(i + 1) * at(held.components) - m + n % m] =
            multipliers[n] * scene_.space->masses[i] * 0.5 * (times[row + 1] - times[row - 1]);
      }
      look_at_window(windows, held, fmt::format("frames {} to {}", first, last));
    }
    if (Interrupt::asked()) verdict_.status = "interrupted";
  }

  /// Of as many frames, one after the other; empty where the file, or the theory, has none.
  std::vector<double> multipliers_of(const FieldsReader& file, const std::string& name, int first, int count) const {
    const auto [frames, sites, components] = file.shape(Role::multiplier);
    if (!scene_.theory->constraint() || frames == 0) return {};
    if (frames != file.frames() || sites != scene_.sites() || components != scene_.space->constraints())
      throw BadScene(
          fmt::format("command line: --fields: {}: /multiplier is {} x {} x {}; write frames x sites x components = {} "
                      "x {} x {}, or leave it out",
                      name, frames, sites, components, file.frames(), scene_.sites(), scene_.space->constraints()));
    std::vector<double> all;
    for (int f = first; f < first + count; ++f) {
      const std::vector<double> one = file.values(Role::multiplier, f);
      if (!std::ranges::all_of(one, [](double value) { return std::isfinite(value); }))
        throw BadScene(
            fmt::format("command line: --fields: {}: frame {}: /multiplier is not finite; correct it", name, f));
      all.insert(all.end(), one.begin(), one.end());
    }
    return all;
  }

  void look_at_window(WindowsOnMesh& windows, const Window& rows, const std::string& where) {
    std::vector<double> fields;
    for (const std::vector<double>& row : rows.rows)
      std::ranges::copy(fields_of(windows.system(), row), std::back_inserter(fields));
    checks_.look_at_constraint(fields, where);
    checks_.look_at(windows(rows), where);
  }
  /// A static field; without multipliers they are those that fit it best.
  void look_at_mesh(std::span<const double> fields, std::span<const double> multipliers, const std::string& where) {
    const LatticeSystem system = system_of_field(scene_);
    Window row = system.window(0, {row_of(system, fields, multipliers)}, 0);
    if (scene_.theory->constraint() && multipliers.empty()) fit_multipliers(system, row);
    WindowsOnMesh windows(system);
    look_at_window(windows, row, where);
  }

  /// Rows of one mesh say nothing of another.
  void require_same_places(const FieldsReader& file, const std::string& name) const {
    const auto places = file.coordinates();
    const std::vector<double> own = scene_.places();
    const std::size_t n = scene_.coordinates();
    if (!places || places->size() != own.size()) return;  // of other programs: nothing to compare
    double longest = 0;
    for (const double x : own) longest = std::max(longest, std::abs(x));
    for (std::size_t i = 0; i < own.size(); ++i)
      if (const double there = (*places)[i], here = own[i]; !(std::abs(there - here) <= 1e-6 * longest))
        throw BadScene(fmt::format(
            "command line: --fields: {}: {} {} lies at {} = {:.10g} in /space, and at {:.10g} in the mesh; use the "
            "mesh of these rows",
            name, scene_.stencils ? "site" : "point", i / n, (scene_.stencils ? "txyz" : "xyz")[i % n], there, here));
  }

  void look_at_field() {
    StaticField field(scene_);
    if (field.solve().ended) {
      verdict_.status = "interrupted";
      return;
    }
    if (scene_.stencils) checks_.look_at(checked(field.system(), field.unknowns_and_data()), "all of space");
    else look_at_mesh(field.values(), field.multipliers(), "all of space");
  }

  // Windows of some updates a site, with the order that the planner finds for them.
  void look_at_cells() {
    const Simulation simulation(scene_.problem_on_mesh());
    AsynchronousStepper stepper(simulation.evolution().system(),
                                cell_steps(scene_.space->mesh, scene_.scene.problem.cell_courant));
    stepper.start_rates(scene_.values(), scene_.rates());
    const double until = static_cast<double>(scene_.scene.steps) * scene_.scene.problem.time_step;
    for (int moment = 0; moment < moments_ && !Interrupt::asked(); ++moment) {
      const int count = 6 * scene_.space->mesh.cells();
      stepper.advance(until * moment / moments_);
      stepper.keep_updates();
      stepper.update(count);
      const AsynchronousWindow made(*scene_.space, stepper);
      const std::int64_t updates = stepper.state().updates;
      checks_.look_at(checked(made.system, made.values), fmt::format("updates {} to {}", updates - count + 1, updates));
      // Each time of a site is determined by its time before, and by nothing that comes later.
      const Complex& complex = made.system.complex();
      const ComplexPlan plan = make_plan(complex, Touching(complex));
      Balance wrong{0, static_cast<double>(plan.unknowns.size()), static_cast<std::int64_t>(plan.unknowns.size())};
      for (std::size_t n = 0; n < plan.unknowns.size(); ++n) wrong.sum += plan.unknowns[n] != plan.equations[n] + 1;
      wrong.sum += plan.largest > 1;
      order_.take(wrong, fmt::format("{} sites in space and time, {} levels", complex.sites(), plan.levels));
      if (!order_.passed()) order_.failure = "the plan solves for other values, or for several at once";
    }
    if (Interrupt::asked()) verdict_.status = "interrupted";
  }

  /// Rows of any method, with the nodes inside their slabs.
  void look_at_rows() {
    const bool usual = !scene_.has_method();
    const int count = usual ? window : 4;
    Simulation simulation(scene_.problem_on_mesh());
    const LatticeSystem& system = simulation.evolution().system();
    if (!is_variational(system))
      throw BadInput(
          "scheme.method",
          "scheme.method: on a mesh delf verify checks methods that have an action: composition or cgvi; use one of "
          "these");
    RowTimes& times = *system.times();
    times.keep_all();
    const MeshEnergy energy_of(scene_.theory->shared_density(), *scene_.space);
    start(scene_, simulation);
    const std::int64_t steps = std::max<std::int64_t>(rows_of_run(), count);
    WindowsOnMesh windows(system);
    const auto newest_two = [&] { return simulation.evolution().stepper().window(2); };
    const auto energy = [&](const Window& two) {
      return energy_of.between(fields_of(system, two.rows[0]), fields_of(system, two.rows[1]),
                               times.step(two.first_row), times.time(two.last_row()));
    };
    Window held = system.window(0, newest_two().rows, 0);
    first_rows_ = held.rows;
    const bool own_steps = usual && !times.uniform();
    std::optional<EnergyChange> change;  // the energy is no sum that vanishes where steps differ
    if (own_steps) change.emplace(energy(held), 0);
    int moment = 0;
    while (simulation.newest() < steps && !Interrupt::asked()) {
      simulation.step();
      const std::int64_t newest = simulation.newest();
      if (change) change->add(energy(newest_two()), newest);
      const auto last_of = [&](int m) { return std::max<std::int64_t>(count - 1, steps * (m + 1) / moments_); };
      if (newest > last_of(moment) - count + 1) keep(newest_two(), count, held);
      if (newest < last_of(moment)) continue;
      look_at_window(windows, held, fmt::format("rows {} to {}", held.first_row, newest));
      if (own_steps && !scene_.theory->constraint()) look_at_first_step(system, held);
      while (moment < moments_ && last_of(moment) <= newest) ++moment;
    }
    if (change && change->measured().count > 0) verdict_.measured.push_back(change->measured());
    if (Interrupt::asked()) verdict_.status = "interrupted";
  }

  /// The newest `count` rows; nodes and multipliers of a row are known with the next one.
  static void keep(Window two, int count, Window& held) {
    if (held.last_row() == two.first_row) {
      held.rows.back() = std::move(two.rows[0]);
    } else {
      held.rows = {std::move(two.rows[0])};
      held.first_row = two.first_row;
    }
    held.rows.push_back(std::move(two.rows[1]));
    if (std::ssize(held.rows) > count) held.rows.erase(held.rows.begin()), ++held.first_row;
  }

  /// Rows of steps of their own, the last of them as long as the first: Marsden–Patrick–Shkoller (6.6).
  void look_at_first_step(const LatticeSystem& system, const Window& rows) {
    std::vector<double> times;
    for (std::int64_t row = rows.first_row; row < rows.last_row(); ++row) times.push_back(system.times()->time(row));
    times.push_back(times.back() + (times[1] - times[0]));
    const std::string where = fmt::format("rows from {}", rows.first_row);
    for (int v = 0; v < checks_.variations(); ++v)
      if (first_step_.take(
              form_of_first_step(system, times, rows.rows, checks_.random(), checks_.fault() == "variation"), where) &&
          !first_step_.passed())
        first_step_.failure = "the 2-form of the last two rows is not that of the first two";
  }

  std::int64_t rows_of_run() const {
    if (!scene_.scene.until) return scene_.scene.steps;
    Simulation simulation(scene_.problem_on_mesh());
    start(scene_, simulation);
    return steps_of_run(scene_.scene, simulation);
  }

  /// The problem of a run that begins at time T and goes back, with the boundary and the steps in the reverse order.
  Problem seen_from(double T) const {
    Problem problem = mirrored_in_time(scene_.problem_on_mesh(), T);
    if (scene_.boundary_works()) {
      auto space = std::make_shared<MeshSpace>(*scene_.space);
      for (auto* list : {&space->driven, &space->fluxes})
        for (auto& [point, given] : *list) given = std::make_shared<BackFrom>(T, given);
      problem.lattice = Lattice::on(std::move(space));
    }
    if (problem.time_steps.empty()) return problem;
    const std::vector<double>& in_turn = scene_.scene.problem.time_steps;
    std::vector<double> back;
    for (double t = 0; t < T * (1 - 1e-12); t += back.back()) back.push_back(in_turn[back.size() % in_turn.size()]);
    problem.time_steps.assign(back.rbegin(), back.rend());
    return problem;
  }

  void reverse() {
    const auto fresh = [this](std::optional<double> T) {
      return std::make_unique<Simulation>(T ? seen_from(*T) : scene_.problem_on_mesh());
    };
    reverse_time(scene_.scene, fresh, first_rows_, std::max(tolerance_, 100 * scene_.scene.problem.tolerance),
                 verdict_);
  }

  const ComplexScene& scene_;
  MeshChecks checks_;
  int moments_;
  double tolerance_;
  Check order_, first_step_;
  std::vector<std::vector<double>> first_rows_;  ///< of rows that are made here
  Verdict verdict_;
};

/// What a reader of rows says, without its name for the file.
std::string_view without_key(const BadInput& bad) {
  constexpr std::string_view key = "initial.file: ";
  const std::string_view what = bad.what();
  return what.starts_with(key) ? what.substr(key.size()) : what;
}

}  // namespace

ExitCode verify(const ComplexScene& c, const std::filesystem::path& folder, const std::optional<std::string>& fields,
                const std::vector<std::string>& /*nearby*/) {
  const Interrupt interrupt;
  const Values values(c.scene.settings);
  Verdict verdict;
  try {
    verdict = MeshVerification(c, values).run(fields);
  } catch (const BadInput& bad) {
    if (fields && bad.key() == "initial.file")  // the reader's name for any file of rows
      throw BadScene(fmt::format("command line: --fields: {}: {}", *fields, without_key(bad)));
    throw c.scene.settings.located(bad);
  }
  Subject subject = subject_of(c);
  subject.scheme = scheme_in_words(c);
  return write_verdict(verdict, subject, c.scene, folder);
}

}  // namespace delf

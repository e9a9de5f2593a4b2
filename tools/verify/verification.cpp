// SPDX-License-Identifier: MIT
#include "tools/verify/verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <set>
#include <span>

#include "jets/expressions/expression.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/stepping/step_density.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/verify/derivatives.hpp"
#include "schemes/verify/flux_check.hpp"
#include "schemes/verify/newton_order.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tools/diagnosis/diagnosis.hpp"
#include "tools/diagnosis/unwrap.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/scene/recorded_scene.hpp"
#include "tools/verify/further_runs.hpp"

namespace delf {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> field_names(const LatticeSystem& system) {
  std::vector<std::string> names;
  for (const Component& c : system.all_components())
    if (c.role == Role::field) names.push_back(c.name);
  return names;
}

}  // namespace

std::vector<LinearSymmetry> requested_symmetries(const Scene& scene, const VerifyRequest& request,
                                                 const FieldTheory& theory, const LatticeSystem& system) {
  std::vector<LinearSymmetry> all = theory.symmetries();
  add_generator(scene, request.generator, field_names(system), all);
  return all;
}

Verification::Verification(const Scene& scene, const VerifyRequest& request, const std::optional<std::string>& fields,
                           const std::vector<std::string>& nearby)
    : scene_(scene),
      request_(request),
      initial_(fields && scene.from_file() ? std::nullopt : std::make_optional<InitialRows>(scene)),
      winding_(initial_ ? initial_->winding() : scene.initial.winding.value_or(0)),
      monodromy_(2 * std::numbers::pi * winding_ + gain_of(scene.problem.parameters)),
      simulation_(build(scene, winding_)),
      faulty_(request.fault == "sign" ? with_wrong_sign(simulation_.evolution().system()) : nullptr),
      system_(faulty_ ? *faulty_ : simulation_.evolution().system()),
      plan_(simulation_.evolution().plan()),
      random_(scene.initial.seed) {
  verdict_.seed = scene.initial.seed;
  verdict_.subject = fields ? "rows of " + *fields
                     : simulation_.is_processed()
                         ? "rows of the kernel, computed here; recorded rows have the processor undone"
                         : "rows computed here";
  if (fields && simulation_.is_processed())
    throw scene.settings.error("scheme.method",
                               "recorded rows of a kernel have its processor undone, and only the kernel's own rows "
                               "solve its equations; leave --fields out");
  if (scene.problem.step_control) {
    if (!nearby.empty())
      throw scene.settings.error("lattice.time_steps",
                                 "solutions that chose other steps are none of the same equations; leave --nearby out");
    system_.times()->keep_all();
    leave_out(not_symplectic);
  }
  if (fields) open_files(*fields, nearby);

  moment_rows_ = FormCheck::rows_wanted(system_, plan_, request.regions);
  drawer_.emplace(system_, Tangent::solved_rows(system_, plan_, moment_rows_));
  double of_steps = std::max(request.tolerance, 10 * scene.problem.tolerance);
  // The digits of values in a file say how well the equations can hold, unless the scene does.
  if (rounded_ && !request.own_tolerance) of_steps = std::max(of_steps, 2 * rounded_->relative);
  std::optional<ValueError> coarse;
  if (rounded_ && !request.own_tolerance) coarse = rounded_->error;
  if (request.wants("equations")) equations_.emplace(system_, plan_, of_steps, simulation_.starting_rows(), coarse);
  if (request.wants("forms") && (!fields || request.chosen))
    forms_.emplace(system_, plan_, moment_rows_,
                   FormCheck::Options{request.regions, request.variations, request.tolerance, monodromy_,
                                      request.fault == "variation"});
  if (const auto all = symmetries(); request.wants("noether")) {
    if (!all.empty()) noether_.emplace(system_, all, of_steps, request.force, seed());
  }
  if (!nearby.empty()) near_.emplace(request.tolerance);
  require_interiors();
  choose_moments();
  Problem problem = scene_.problem;
  problem.winding = winding_;
  if (request_.wants("equations")) energy_ = own_energy(simulation_, problem);
  if (energy_) verdict_.energy.name = energy_->entry->name, verdict_.energy.meaning = energy_->entry->formula;
  if (fields) open_nearby(*fields, nearby);
}

void Verification::open_files(const std::string& fields, const std::vector<std::string>& nearby) {
  const auto behind = simulation_.evolution().stepper().behind();
  fields_ = std::make_unique<RecordedSection>(fields, system_, behind, scene_.problem.time_step, "--fields");
  require_recorded_parameters(scene_, fields, fields_->scene());
  verdict_.subject += recorded_otherwise(scene_, fields_->scene());
  if (const auto winding = fields_->winding(); winding && system_.lattice().is_circle()) {
    if (const auto here = scene_.initial.winding; here && *here != *winding)
      throw BadScene(
          fmt::format("command line: --fields {}: was made with boundary.winding = {}, and the scene has {}; "
                      "use --boundary.winding={}, or leave out its attribute winding",
                      fields, *winding, *here, *winding));
    monodromy_ = 2 * std::numbers::pi * *winding + gain_of(scene_.problem.parameters);
  }
  if (request_.unwrap) {
    if (!nearby.empty())
      throw scene_.settings.error("verify.unwrap", "unwraps the rows of --fields alone; leave --nearby out");
    std::vector<double> row = fields_->row(0);
    unwrap_along(row, system_.components());
    if (system_.lattice().is_circle()) monodromy_ = monodromy_of_row(row, system_.components());
  }
  if (nearby.size() % 2 != 0)
    throw BadScene(
        "command line: --nearby: give them in pairs, two solutions near to those of --fields in different "
        "directions; further pairs are the same at other sizes");
  rows_ = fields_->rows() - std::ranges::max(behind);
  if (rows_ > 0) rounded_ = rounding_of(rows_, [&](std::int64_t j) { return fields_->row(j); });
  if (rounded_ && request_.unwrap) rounded_->error = {.absolute = rounded_->unit};
  if (rounded_) verdict_.subject += ", whose values have " + rounded_->words;
  require_every_row(fields);
}

// The first two frames are as far apart as row 0 asks for, or a few times as far, where the field chose the steps. Rows
// of delf say how they were recorded.
void Verification::require_every_row(const std::string& fields) const {
  const auto density = find_method(scene_.problem.method).row_density;
  if (!scene_.problem.step_control || !density || !fields_->scene().empty()) return;
  const std::vector<double> row = fields_->row(0), at_rest(row.size());
  const double longest = scene_.problem.time_step, apart = system_.times()->step(0);
  const double chosen =
      longest / density({simulation_.theory(), system_, system_.window(0, {row}, monodromy_), 0, longest}, at_rest,
                        *scene_.problem.step_control)
                    .density;
  const auto steps = std::lround(apart / chosen);
  if (steps < 2) return;
  throw BadScene(
      fmt::format("command line: --fields {}: frames 0 and 1 are {:.6g} apart, and the field there chooses steps of "
                  "{:.6g}: of {} rows one was recorded, and the equations read all. Record every row (output.every = "
                  "1); or use lattice.time_step = {:.6g}, if steps were as long",
                  fields, apart, chosen, steps, longest * apart / chosen));
}

// A requested region without an equation would be taken for verified.
void Verification::require_interiors() const {
  std::mt19937_64 unused;
  for (const RegionRequest& request : request_.regions)
    if (!request.kind && !drawer_->draw(request, unused))
      throw scene_.settings.error("verify.regions", fmt::format("{} has no interior: every site of it is touched by a "
                                                                "stencil that reaches out of it; make it larger",
                                                                request.name.substr(request.name.find(' ') + 1)));
}

// A run tells how many steps there are where rows choose them.
std::int64_t Verification::steps_of_run() const {
  if (!scene_.until) return scene_.steps;
  Simulation simulation = build(scene_, winding_);
  try {
    initial_->start(simulation);
  } catch (const NumericalFailure&) {
    return 1;
  }
  return delf::steps_of_run(scene_, simulation);
}

void Verification::choose_moments() {
  if (!fields_) rows_ = std::max<std::int64_t>(steps_of_run() + 1, moment_rows_);
  const std::int64_t reach = equations_ ? equations_->reach() : 1;
  if (rows_ < 2 * reach + 1)
    throw BadScene(fmt::format(
        "command line: --fields: of this scheme the file has {} whole row{}, and an equation reads {}; record more",
        rows_, rows_ == 1 ? "" : "s", 2 * reach + 1));
  held_rows_ = static_cast<int>(2 * reach + 1);
  const bool regions = forms_ || noether_ || near_;
  if (rows_ >= moment_rows_ && (regions || (!fields_ && request_.wants("newton")))) {
    // Even rows, so that bricks keep their parity; the first and the last that fit among them.
    std::set<std::int64_t> rows;
    const std::int64_t last = rows_ - moment_rows_;
    const std::int64_t moments = std::min<std::int64_t>(request_.moments, last / 2 + 1);
    for (std::int64_t m = 0; m < moments; ++m) rows.insert(moments == 1 ? 0 : last * m / (moments - 1) / 2 * 2);
    moments_.assign(rows.begin(), rows.end());
    held_rows_ = std::max(held_rows_, moment_rows_);
  } else if (regions) {
    leave_out(fmt::format("regions: they take {} rows, and there are {}", moment_rows_, rows_));
  }
  if (equations_) bins_.emplace(system_.lattice(), scene_.problem.time_step, reach, rows_ - 2 * reach);
  if (equations_ && fields_) {
    severity_.emplace(system_.lattice(), scene_.problem.time_step, reach, rows_ - 2 * reach);
    const bool iterates = simulation_.evolution().stepper().iterates();
    ForceShare::Precision precision;
    precision.solver = iterates ? scene_.problem.tolerance : 0;
    precision.asked = request_.own_tolerance ? request_.tolerance : 0;
    if (rounded_) {  // and the last digits of steps
      precision.values.absolute = rounded_->error.absolute, precision.values.digits = rounded_->error.digits;
      precision.values.relative = std::max(precision.values.relative, rounded_->error.relative);
    }
    share_.emplace(system_, rows_ - 2 * reach, precision);
  }
  const FieldTheory& theory = simulation_.theory();
  if (request_.wants("balance")) {
    if (system_.moves()) leave_out("balance of energy and momentum: the sites move");
    else if (scene_.problem.step_control) leave_out("balance of energy and momentum: steps have lengths of their own");
    else {
      balance_.emplace(theory, system_.lattice(), scene_.problem.time_step, monodromy_);
      balance_rows_ = std::clamp<std::int64_t>(most_updates / 4 / system_.lattice().sites(), 3, rows_);
    }
  }
}

/// A divergence of the density need not be one of the scheme's stencils.
bool Verification::scheme_has(const LinearSymmetry& symmetry) const {
  try {
    return NoetherCheck(system_, {symmetry}, request_.tolerance, false, scene_.initial.seed).checks().front().passed();
  } catch (const BadInput&) {  // stencils that read a part of the fields alone
    return false;
  }
}

std::vector<LinearSymmetry> Verification::symmetries() {
  std::vector<LinearSymmetry> all = simulation_.symmetries();
  if (const SymbolicDensity* density = simulation_.theory().density().formula())
    for (const LinearSymmetry& symmetry : density->up_to_divergence()) {
      if (scheme_has(symmetry)) all.push_back(symmetry);
      else
        leave_out(
            fmt::format("Noether, {}: the density has it up to a divergence, and the Lagrangian of the scheme has not",
                        symmetry.name));
    }
  add_generator(scene_, request_.generator, field_names(system_), all);
  if (!is_variational(system_)) all.clear();
  return all;
}

// Read beside the rows themselves; how many of them are held is known by now.
void Verification::open_nearby(const std::string& fields, const std::vector<std::string>& nearby) {
  const auto behind = simulation_.evolution().stepper().behind();
  for (const std::string& file : nearby) {
    // A difference that is zero, or the same twice, keeps the form whatever the rows are.
    for (std::size_t n = 0; n <= nearby_.size(); ++n)
      if (std::error_code unreadable; fs::equivalent(file, n == 0 ? fields : nearby[n - 1], unreadable))
        throw BadScene(fmt::format("command line: --nearby {}: is given twice; give solutions that differ", file));
    nearby_.push_back(std::make_unique<NearbyRows>(file, system_, behind, scene_.problem.time_step, monodromy_,
                                                   held_rows_, equations_));
    if (nearby_.back()->rows() != fields_->rows())
      throw BadScene(
          fmt::format("command line: --nearby {}: has {} rows, and the file of --fields has {}; give as many", file,
                      nearby_.back()->rows(), fields_->rows()));
  }
}

Window Verification::window(std::int64_t first, std::int64_t last) const {
  const auto begin = held_.rows.begin() + (first - held_.first_row);
  return system_.window(first, {begin, begin + (last - first + 1)}, monodromy_);
}

Verdict Verification::run() {
  const auto begin = std::chrono::steady_clock::now();
  try {
    if (!fields_) initial_->start(simulation_);
    pass_over_rows();
    if (!Interrupt::asked()) {
      if (!fields_ && balance_) {
        measure_orders(scene_, winding_, balance_->results(), balance_rows_, verdict_);
        balance_.reset();
      }
      if (!fields_ && request_.wants("reversal"))
        reverse_time(scene_, winding_, first_rows_, std::max(request_.tolerance, 100 * scene_.problem.tolerance),
                     verdict_);
    }
  } catch (const NumericalFailure& error) {
    verdict_.status = status_of(error);
    failure_ = std::current_exception();
  }
  if (Interrupt::asked()) verdict_.status = "interrupted";
  collect();
  verdict_.seconds = seconds_since(begin);
  return std::move(verdict_);
}

void Verification::pass_over_rows() {
  std::unique_ptr<SectionSource> source;
  if (fields_) source = std::make_unique<RowsOfFile>(*fields_, rows_);
  else source = std::make_unique<ComputedRows>(simulation_, rows_);
  held_ = system_.window(0, {}, monodromy_);
  Progress progress(rows_);
  while (auto row = source->next()) {
    take(std::move(*row));
    progress.at(held_.last_row());
    if (Interrupt::asked()) return;
  }
}

void Verification::take(std::vector<double> row) {
  const std::int64_t j = held_.first_row + static_cast<std::int64_t>(held_.rows.size());
  if (fields_ && request_.unwrap) {
    if (j == 0) unwrap_along(row, system_.components());
    else unwrap_after(unwrapped_, row);
    unwrapped_ = row;
    first_values_.insert(first_values_.end(), row.begin(), row.begin() + system_.components());
  }
  if (request_.fault == "field" && j == rows_ / 2) {
    double most = 0;
    for (const double value : row) most = std::max(most, std::abs(value));
    row[row.size() / at(2 * system_.components()) * at(system_.components())] += 0.01 * (most > 0 ? most : 1);
  }
  if (first_rows_.size() < 2) first_rows_.push_back(row);
  if (fields_) look_at_walls(j, row);
  if (balance_ && j < balance_rows_) balance_->add(j, fields_of(system_, row));
  held_.rows.push_back(std::move(row));
  if (static_cast<int>(held_.rows.size()) > held_rows_) {
    held_.rows.erase(held_.rows.begin());
    ++held_.first_row;
  }
  look_at_energy(j);
  if (equations_ && j >= 2 * equations_->reach()) {
    const std::int64_t middle = j - equations_->reach();
    equations_->at(held_, middle);
    bins_->add(middle, equations_->newest(), system_.components());
    if (fields_) {
      failed_.add(middle, equations_->newest(), system_.components(), equations_->tolerance());
      share_->at(held_, middle, *equations_);
      hidden_.add(middle, equations_->newest(), system_.components(), share_->relative_bound());
      severity_->add(middle, share_->errors(), system_.components());
    }
  }
  for (const auto& nearby : nearby_) nearby->take(j);
  if (next_moment_ < moments_.size() && j == moments_[next_moment_] + moment_rows_ - 1) {
    look_at_moment();
    ++next_moment_;
  }
}

// Takes the energy of the last two rows.
void Verification::look_at_energy(std::int64_t j) {
  if (scene_.problem.step_control && j > 0) measure_energy(j);
  if (!energy_ || j < 1 || held_.rows.size() < 2) return;
  verdict_.energy.time.push_back(static_cast<double>(j) * scene_.problem.time_step);
  verdict_.energy.value.push_back(
      energy_->value({simulation_.theory(), system_, window(j - 1, j), j, scene_.problem.time_step}).energy);
}

// The energy is what there is to be kept where steps differ.
void Verification::measure_energy(std::int64_t j) {
  const EnergyEntry* entry = find_method(scene_.problem.method).energy;
  if (!entry) return;
  const LatticeSystem& right = simulation_.evolution().system();  // a planted fault hides what its families are
  const EnergyOfRows energy = entry->make(simulation_.theory(), right, scene_.problem);
  const EnergyMomentum now = energy({simulation_.theory(), right, window(j - 1, j), j, right.times()->step(j - 1)});
  if (!energy_change_) energy_change_.emplace(now.energy, j);
  energy_change_->add(now.energy, j);
}

// The first two rows are data, and the wall keeps what the second has.
void Verification::look_at_walls(std::int64_t j, const std::vector<double>& row) {
  if (j < 2) return;
  double largest = 0;
  for (const double y : row) largest = std::max(largest, std::abs(y));
  for (int i : {0, system_.lattice().sites() - 1})
    for (int c = 0; c < system_.components(); ++c) {
      if (!system_.is_held(i, c)) continue;
      if (!walls_) walls_ = Check{.name = "fixed walls", .region = {}, .tolerance = request_.tolerance};
      const std::size_t n = i * system_.components() + c;
      const double change = std::abs(row[n] - first_rows_[1][n]);
      ++walls_->samples, ++walls_->count;
      if (largest == 0 || !worse(change / largest, walls_->value)) continue;
      walls_->value = change / largest, walls_->normaliser = largest;
      walls_->region = fmt::format("row {}, site {}", j, i);
      walls_->failure = fmt::format(
          "The wall at site {} is fixed in the scene, and in the rows it moves from {:.6g} to {:.6g} (row {}). Use "
          "boundary.{} = natural if it is free, or lattice.space = circle.",
          i, first_rows_[1][n], row[n], j, i == 0 ? "left" : "right");
    }
}

// Diagnoses fields at the vertices alone: other programs write nothing else that a scheme has.
void Verification::diagnose_rows() {
  if (!fields_) {
    if (request_.identify) leave_out("diagnosis: of rows of a file; give --fields");
    return;
  }
  const bool hidden = failed_.failed() == 0 && verdict_.failed() > 0;  // beside the force
  if (!equations_ || verdict_.status != "done" || !(failed_.failed() > 0 || hidden || request_.identify)) return;
  if (!std::ranges::all_of(system_.all_components(), [](const Component& c) { return c.role == Role::field; })) {
    leave_out("diagnosis: of schemes whose values are fields at the vertices, and this one has others");
    return;
  }
  const auto row = [&](std::int64_t j) {
    std::vector<double> values = fields_->row(j);
    if (request_.unwrap) {
      const std::size_t C = system_.components();
      unwrap_along(values, system_.components());
      unwrap_to(std::span(first_values_).subspan(at(j) * C, C), values);
    }
    return values;
  };
  Problem problem = scene_.problem;
  problem.winding = winding_;
  Evidence evidence{problem,
                    system_,
                    monodromy_,
                    hidden ? share_->relative_bound() : equations_->tolerance(),
                    rows_,
                    row,
                    hidden ? hidden_ : failed_};
  if (fields_->momenta(0)) evidence.momenta = [&](std::int64_t j) { return *fields_->momenta(j); };
  verdict_.diagnosis = diagnose(std::move(evidence)).findings;
}

void Verification::look_at_moment() {
  const Window rows = window(moments_[next_moment_], held_.last_row());
  if (forms_) forms_->at(rows, random_);
  if (noether_) noether_->at(rows, *drawer_, request_.regions, random_);
  if (near_) look_at_nearby(rows);
  if (!fields_ && request_.wants("newton") && next_moment_ + 1 == moments_.size()) {
    if (auto check = check_newton(system_, plan_, rows, seed())) verdict_.checks.push_back(std::move(*check));
  }
}

void Verification::look_at_nearby(const Window& rows) {
  std::vector<Window> others;
  for (const auto& nearby : nearby_) others.push_back(nearby->difference(rows));
  for (const RegionRequest& request : request_.regions) {
    const auto region = drawer_->draw(request, random_);
    if (!region) continue;
    const RegionSystem here(system_, *region, rows.first_row, monodromy_);
    std::vector<RegionSystem::Pair> pairs;
    for (std::size_t n = 0; n + 1 < others.size(); n += 2)
      pairs.push_back({here.restricted(others[n]), here.restricted(others[n + 1])});
    near_->at(request.name, here, here.restricted(rows), pairs);
    verdict_.stencils += here.stencils();
  }
}

// Each column of the map by the largest force of its own sites.
void Verification::collect_severity() {
  verdict_.measured = share_->measured();
  verdict_.severest = share_->sites();
  ResidualMap& map = verdict_.severity = severity_->map();
  const std::size_t columns = map.space.size(), N = at(system_.lattice().sites());
  std::vector<double> scale(columns, 0.0);
  for (const SiteSeverity& site : verdict_.severest) {
    double& of_column = scale[at(site.site) * columns / N];
    of_column = std::max({of_column, site.force, site.rounding});
  }
  for (std::size_t n = 0; n < map.log10.size(); ++n) map.log10[n] -= std::log10(scale[n % columns]);
}

void Verification::collect() {
  std::vector<Check> later = std::move(verdict_.checks);
  verdict_.checks.clear();
  const auto add = [&](std::vector<Check> checks) {
    verdict_.checks.insert(verdict_.checks.end(), std::make_move_iterator(checks.begin()),
                           std::make_move_iterator(checks.end()));
  };
  if (equations_) {
    add(equations_->checks());
    verdict_.map = bins_->map();
    if (walls_) add({*walls_});
    if (share_) {
      // A second look at rows that pass the first: others have failed beside the force, too.
      if (auto judged = failed_.failed() == 0 ? share_->check() : std::nullopt) {
        if (judged->unmeasurable.empty()) add({std::move(judged->check)});
        else verdict_.unmeasured.push_back({std::move(judged->check), std::move(judged->unmeasurable)});
        if (auto check = share_->average()) add({std::move(*check)});
      }
      collect_severity();
    }
    diagnose_rows();
    verdict_.stencils += equations_->rows() * system_.lattice().sites();
  }
  if (forms_) {
    add(forms_->checks());
    for (Measured& m : forms_->measured()) verdict_.measured.push_back(std::move(m));
    for (const std::string& words : forms_->left_out()) leave_out(words);
    for (const auto& p : forms_->points()) verdict_.points.push_back({p.kind, p.stencils, p.value, p.local});
    const auto& worst = forms_->worst();
    verdict_.worst.title = worst.words;
    verdict_.worst.value = worst.value;
    double total = 0;
    for (const double weight : worst.weights) total += weight;
    for (std::size_t n = 0; n < worst.sites.size(); ++n)
      verdict_.worst.sites.push_back({worst.sites[n].time, worst.sites[n].space, worst.sites[n].node,
                                      worst.interior[n] != 0, worst.boundary[n] != 0,
                                      total > 0 ? worst.weights[n] / total : 0});
    verdict_.stencils += forms_->stencils();
  } else if (fields_) {
    leave_out(
        "form formula with exact first variations: it holds at any rows, and would test the scheme, not the file");
  }
  if (near_ && !moments_.empty() && near_->checks().empty() && near_->left_out().empty())
    leave_out("form formula by differences: where regions were drawn, a nearby solution is the same as --fields");
  for (const auto& nearby : nearby_) add(nearby->checks());
  // Sums of this scheme over rows that do not solve its equations say nothing new.
  const auto follow = [&](std::vector<Check> checks) {
    for (Check& check : checks)
      if (failed_.failed() > 0 && !check.passed() && !check.name.starts_with("symmetry of L"))
        check.failure =
            "Follows from the above: the rows do not solve this scheme's equations, whose form and momenta these "
            "are. It says nothing of what another scheme conserves.";
    return checks;
  };
  if (near_) {
    add(follow(near_->checks()));
    for (const std::string& words : near_->left_out()) leave_out(words);
  } else if (fields_) leave_out("form formula by differences: give two nearby solutions, --nearby A.h5 --nearby B.h5");
  if (noether_) add(follow(noether_->checks()));
  else if (request_.wants("noether")) {
    leave_out(is_variational(system_)
                  ? "Noether: the theory declares no symmetry of its fields; try one by verify.generator"
                  : "Noether: the scheme has no Lagrangian");
  }
  if (!fields_ && request_.wants("derivatives")) add(check_derivatives(system_, seed()));
  if (!fields_ && request_.wants("equations") && !first_rows_.empty())
    add(check_fluxes(system_, fields_of(system_, first_rows_[0])));
  add(std::move(later));
  if (fields_ && request_.chosen)
    for (const char* name : {"reversal", "derivatives", "newton"})
      if (request_.wants(name)) leave_out(fmt::format("{}: of the scheme and not of rows; leave out --fields", name));
  if (const EnergyHistory& energy = verdict_.energy; energy.value.size() > 2)
    verdict_.measured.push_back(measured_energy("energy of the rows' own: " + energy.name, energy.value,
                                                scene_.problem.time_step,
                                                "largest |E - E first| beside that; " + energy.meaning));
  if (energy_change_) verdict_.measured.push_back(energy_change_->measured());
  if (balance_) {  // without an order
    for (Measured& m : balance_->results()) verdict_.measured.push_back(std::move(m));
  }
  // A fault that was planted where no check was made must not count as absent.
  if (request_.fault != "none" && verdict_.status == "done" && verdict_.failed() == 0)
    verdict_.checks.push_back({.name = "planted fault: " + request_.fault,
                               .region = "nowhere",
                               .value = 1,
                               .failure =
                                   "The planted fault was not found: no check that was made looks for it. Ask for "
                                   "more of them by verify.checks, or plant no fault."});
}

}  // namespace delf

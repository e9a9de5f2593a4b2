// SPDX-License-Identifier: MIT
#include "schemes/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/evolution.hpp"
#include "schemes/field_theory.hpp"
#include "schemes/nearest_name.hpp"
#include "schemes/plan_report.hpp"
#include "schemes/theory_registry.hpp"

namespace delf {
namespace {

BadInput unknown(const std::string& key, const std::string& value, const std::vector<std::string>& names) {
  const auto near = nearest(value, names);
  std::string known;
  for (const std::string& name : names) known += (known.empty() ? "" : ", ") + name;
  return {key,
          fmt::format("{} = {}: there is no such {}{}; choose one of {}", key, value, key.substr(key.find('.') + 1),
                      near ? fmt::format(" (did you mean {}?)", *near) : "", known)};
}

std::unique_ptr<FieldTheory> make_theory(const Problem& problem) {
  std::vector<std::string> names;
  for (const TheoryEntry* entry : theory_entries()) {
    if (problem.theory == entry->name) return entry->make(problem);
    names.emplace_back(entry->name);
  }
  throw unknown("theory.name", problem.theory, names);
}

std::vector<std::string> names_of(const std::vector<NamedFormula>& list) {
  std::vector<std::string> names;
  for (const auto& item : list) names.push_back(item.name);
  return names;
}

/// What a wall does to a scheme that its stencils cannot see.
void check_walls(const Problem& p, const StencilFamily& family) {
  if (p.lattice.is_circle()) return;
  const auto [least, most] = std::ranges::minmax(family.pattern().vertices, {}, &Site::space);
  if (family.is_variational() && most.space - least.space > 1)
    throw BadInput(
        "lattice.stencil",
        fmt::format("lattice.stencil = {}: on an interval stencils wider than a cell leave part of the cells "
                    "at the walls out of the action, and the error there does not vanish with k; use "
                    "triangle, rectangle or rectangle-symmetric, or lattice.space = circle",
                    p.stencil));
  if (!family.is_variational() && (p.lattice.left() == Wall::natural || p.lattice.right() == Wall::natural))
    throw BadInput(
        p.lattice.left() == Wall::natural ? "boundary.left" : "boundary.right",
        fmt::format("a natural wall varies the action, and scheme.method = {} has none; use fixed walls", p.method));
}

std::shared_ptr<const StencilFamily> make_family(const FieldTheory& theory, const Problem& p) {
  const double h = p.time_step, k = p.lattice.space_step();
  if (!(h > 0) || !std::isfinite(h))
    throw BadInput("lattice.time_step", "lattice.time_step must be a positive, finite number");
  if (p.method == "multisymplectic") {
    if (auto family = theory.variational(p.stencil, h, k)) {
      check_walls(p, *family);
      return family;
    }
    throw unknown("lattice.stencil", p.stencil, names_of(stencils()));
  }
  if (auto family = theory.comparator(p.method, h, k)) {
    check_walls(p, *family);
    return family;
  }
  for (const std::string& name : names_of(methods()))
    if (name == p.method)
      throw BadInput("scheme.method",
                     fmt::format("scheme.method = {}: not written for theory.name = {}, whose potential "
                                 "depends on more than the field; use scheme.method = multisymplectic",
                                 p.method, p.theory));
  throw unknown("scheme.method", p.method, names_of(methods()));
}

}  // namespace

struct Simulation::Impl {
  Problem problem;
  std::unique_ptr<FieldTheory> theory;
  Evolution evolution;
  Stepper& stepper;
  RowBuffer cell_weights, positions;
  int winding;

  explicit Impl(const Problem& p)
      : problem(p),
        theory(make_theory(p)),
        evolution(p.lattice, {make_family(*theory, p)}, p.time_step,
                  {p.tolerance, p.seed_order, p.max_iterations, p.circle_valued ? Fibre::circle : Fibre::real,
                   2 * std::numbers::pi * p.winding}),
        stepper(evolution.stepper()),
        winding(p.winding) {}

  /// S¹: chooses for every value the representative next to its neighbour, so that the section is continuous; from there
  /// on differences are those of real numbers, and Stepper watches that they stay small enough to be told apart.
  std::vector<std::vector<double>> lifted(std::vector<std::vector<double>> rows) const {
    for (std::size_t r = 0; r < rows.size(); ++r)
      for (std::size_t i = 0; i < rows[r].size(); ++i) {
        if (r == 0 && i == 0) continue;
        const double near = r == 0 ? rows[0][i - 1] : rows[r - 1][i];
        const double difference = wrap(rows[r][i] - near);
        if (!(std::abs(difference) <= largest_wrapped_difference))
          throw NotFinite(
              fmt::format("row {}, site {}: on the fibre S1 the starting values jump by {:.3g}, above 0.9 pi; "
                          "refine the lattice or use theory.fibre = R",
                          r, i, difference));
        rows[r][i] = near + difference;
      }
    if (!problem.lattice.is_circle()) return rows;
    const double gained = rows[0].back() + wrap(rows[0].front() - rows[0].back()) - rows[0].front();
    if (const int turns = static_cast<int>(std::lround(gained / (2 * std::numbers::pi))); turns != winding)
      throw BadInput("boundary.winding",
                     fmt::format("boundary.winding = {}: the starting rows wind {} times around the circle; set "
                                 "boundary.winding = {}",
                                 winding, turns, turns));
    return rows;
  }

  void prepare_monitors() {
    if (cell_weights.rows()) return;
    const RowLayout& layout = stepper.layout();
    cell_weights = RowBuffer(layout, 1);
    const int N = problem.lattice.sites(), cells = problem.lattice.is_circle() ? N : N - 1;
    for (int i = 0; i < cells; ++i) cell_weights.row(0)[layout.slot(i)] = 1;
    if (!theory->is_placed()) return;
    positions = RowBuffer(layout, 1);
    std::vector<double> x(static_cast<std::size_t>(N));
    for (int i = 0; i < N; ++i) x[static_cast<std::size_t>(i)] = problem.lattice.position(i);
    layout.scatter(x, positions.row(0));
  }
};

Simulation::Simulation(const Problem& problem) : impl_(std::make_unique<Impl>(problem)) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;

int Simulation::starting_rows() const { return impl_->stepper.starting_rows(); }

void Simulation::start(const std::vector<std::vector<double>>& rows) {
  impl_->stepper.start(impl_->problem.circle_valued ? impl_->lifted(rows) : rows);
}

void Simulation::start_centred(std::span<const double> row0, std::span<const double> velocity) {
  std::vector<std::vector<double>> rows{{row0.begin(), row0.end()}};
  if (impl_->problem.circle_valued) rows = impl_->lifted(rows);
  impl_->stepper.start_centred(rows[0], {velocity.begin(), velocity.end()});
}

void Simulation::step() { impl_->stepper.step(); }
std::int64_t Simulation::newest() const { return impl_->stepper.newest(); }

void Simulation::copy_row(int back, std::span<double> out) const {
  impl_->stepper.layout().gather(impl_->stepper.row_data(back, 0), out);
}

Simulation::Monitors Simulation::monitors() const {
  Impl& s = *impl_;
  s.prepare_monitors();
  const RowLayout& layout = s.stepper.layout();
  const double* rows[2] = {s.stepper.row_data(1, 0), s.stepper.newest_increment(0)};
  const double h = s.problem.time_step;
  const EnergyMomentum sums =
      s.theory->energy_momentum({&layout, rows, s.positions.rows() ? s.positions.row(0) : nullptr,
                                 static_cast<double>(newest() - 1) * h, h, s.problem.lattice.space_step()},
                                s.cell_weights.row(0));
  double charge = s.winding;
  if (!s.problem.lattice.is_circle()) {
    const double* y = s.stepper.row_data(0, 0);
    charge = (y[layout.slot(s.problem.lattice.sites() - 1)] - y[layout.slot(0)]) / (2 * std::numbers::pi);
  }
  return {sums.energy, sums.momentum, charge};
}

int Simulation::iterations() const { return impl_->stepper.iterations(); }
double Simulation::residual() const { return impl_->stepper.residual(); }
const char* Simulation::solve_kind() const { return to_string(impl_->evolution.plan().kind); }
std::string Simulation::solve_summary() const { return solve_in_words(impl_->evolution.plan(), impl_->stepper); }
std::string Simulation::plan_report() const {
  return delf::plan_report(impl_->evolution.system(), impl_->evolution.plan(), impl_->stepper);
}
std::size_t Simulation::bytes() const { return impl_->stepper.bytes(); }

const std::vector<TheoryInfo>& theories() {
  static const std::vector<TheoryInfo> list = [] {
    std::vector<TheoryInfo> result;
    for (const TheoryEntry* entry : theory_entries())
      result.push_back({entry->name, entry->formula, entry->parameters});
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& stencils() {
  static const std::vector<NamedFormula> list = [] {
    std::vector<NamedFormula> result;
    for_each_stencil([&](const char* name, const char* description, auto) { result.push_back({name, description}); });
    return result;
  }();
  return list;
}

const std::vector<NamedFormula>& methods() {
  static const std::vector<NamedFormula> list{
      {"multisymplectic", "discrete Euler-Lagrange field equations of lattice.stencil (5.2)"},
      {"vu-quoc-li", "comparator (5.14): conserves an energy, is not multisymplectic"},
      {"guo", "comparator (5.15): conserves an energy, is not multisymplectic"}};
  return list;
}

}  // namespace delf

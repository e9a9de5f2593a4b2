// SPDX-License-Identifier: MIT
#include "schemes/row_monitors.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>

#include "lattice/index.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/slab_extent.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

RowsInTime newest_rows(const FieldTheory& theory, const Evolution& evolution) {
  const std::int64_t newest = evolution.stepper().newest();
  const LatticeSystem& system = evolution.system();
  return {theory, system, evolution.stepper().window(2), newest, system.times()->step(newest - 1)};
}

std::vector<double> row_of(const Evolution& evolution, Role role, int back) {
  const LatticeSystem& system = evolution.system();
  std::vector<double> row = evolution.stepper().row(back);
  if (std::ranges::all_of(system.all_components(), [&](const Component& c) { return c.role == role; })) return row;
  std::vector<double> values;
  for (std::size_t at = 0; at < row.size(); ++at)
    if (system.component(static_cast<int>(at) % system.components()).role == role) values.push_back(row[at]);
  return values;
}

RowMonitors::RowMonitors(const Problem& problem, const FieldTheory& theory,
                         const std::vector<LinearSymmetry>& symmetries, const Evolution& evolution)
    : problem_(problem),
      method_(find_method(problem.method)),
      theory_(theory),
      symmetries_(symmetries),
      evolution_(evolution),
      stepper_(evolution.stepper()),
      system_(evolution.system()),
      equations_(system_),
      has_constraints_(std::ranges::count(system_.all_components(), Role::multiplier, &Component::role) > 0),
      field_lag_(has_constraints_ ? slab_extent(system_, evolution.plan()).field_lag : 0),
      monodromy_(monodromy_of(problem)) {
  if (const EnergyEntry& entry = energy_of_run(problem); entry.make) energy_ = entry.make(theory, system_, problem);
  if (!energy_ && system_.fields() != theory.components())
    throw std::logic_error("scheme.method = " + method_.name + ": has other fields than the theory, and no energy");
  for (const LinearSymmetry& s : symmetries)
    if (system_.height() <= 1) conserved_names_.push_back(s.name);
}

Simulation::Monitors RowMonitors::now() {
  if (!cell_weights_.rows()) prepare();
  if (own_layout_) copy_newest_pair();
  else stepper_.newest_pair(monitored_.data());
  const EnergyMomentum sums = energy_momentum();
  Simulation::Monitors monitors{sums.energy, sums.momentum, charge(), constraint(), {}, {}, {}};
  for (const Monitor& monitor : method_.monitors)
    monitors.of_method.push_back(monitor.value(newest_rows(theory_, evolution_)));
  if (!conserved_names_.empty()) find_conserved(monitors);
  return monitors;
}

EnergyMomentum RowMonitors::energy_momentum() const {
  if (energy_) return energy_(newest_rows(theory_, evolution_));
  const double h = problem_.time_step;
  const double t = (static_cast<double>(stepper_.newest()) - (stepper_.is_processed() ? 0.5 : 1)) * h;
  if (theory_.density().slots() > 3) {
    CellJets jets(theory_.density(), problem_.lattice, h, monodromy_);
    return delf::energy_momentum(theory_.density(), problem_.lattice, jets, row_of(evolution_, Role::field, 1),
                                 row_of(evolution_, Role::field, 0), t + 0.5 * h);
  }
  return delf::energy_momentum(theory_.density(),
                               {&layout(), monitored_.data(), positions_.rows() ? positions_.row(0) : nullptr, t, h,
                                problem_.lattice.space_step()},
                               cell_weights_.row(0));
}

/// max |G| over the constraints of the newest slab, each at the row that the plan has it in.
double RowMonitors::constraint() {
  if (!has_constraints_ || stepper_.newest() < 2) return 0;
  const std::int64_t slab = stepper_.newest() + field_lag_;
  double worst = 0;
  std::map<std::int64_t, std::vector<LatticeSystem::Value>> of_row;
  for (int c = 0; c < system_.components(); ++c)
    for (int i = 0; i < problem_.lattice.sites(); ++i) {
      if (system_.component(c).role != Role::multiplier || !evolution_.plan().solved(i, c)) continue;
      // a slab may know a trace of the row above it; that row is whole with the next
      const std::int64_t row =
          std::min(stepper_.newest(), slab - evolution_.plan().shift(i, c, static_cast<int>(slab & 1)));
      const auto [at, fresh] = of_row.try_emplace(row);
      if (fresh)
        equations_.equations(stepper_.window(std::max(3, static_cast<int>(stepper_.newest() - row) + 2)), row,
                             at->second);
      worst = std::max(worst, std::abs(at->second[i * system_.components() + c].sum));
    }
  return worst;
}

double RowMonitors::charge() const {
  if (problem_.lattice.is_circle()) return problem_.winding + gain_of(problem_.parameters) / (2 * std::numbers::pi);
  // of the first field
  const int first = own_layout_ ? theory_.components() : system_.components() + system_.field_component(0);
  const double* const newest = monitored_[first];
  const auto at = [&](int i) { return newest[layout().slot(i)]; };
  return (at(problem_.lattice.sites() - 1) - at(0)) / (2 * std::numbers::pi);
}

void RowMonitors::find_conserved(Simulation::Monitors& monitors) const {
  // A run that starts from row 0 alone has no stencils below it, nor their sums.
  if (stepper_.newest() < system_.height()) {
    monitors.conserved.assign(symmetries_.size(), std::numeric_limits<double>::quiet_NaN());
    monitors.conserved_scale = monitors.conserved;
    return;
  }
  const Window window = stepper_.window(2);
  for (const LinearSymmetry& symmetry : symmetries_) {
    double scale = 0;
    monitors.conserved.push_back(noether_charge(system_, window, stepper_.newest(), symmetry, &scale));
    monitors.conserved_scale.push_back(scale);
  }
}

/// Copies the rows that monitors read, where steps do not go by rows.
void RowMonitors::copy_newest_pair() {
  const int C = system_.components(), d = theory_.components();
  if (stepper_.is_processed()) return copy_observed_pair();
  const std::vector<double> newest = stepper_.row(0), before = stepper_.row(1);
  std::vector<double> before_newest(problem_.lattice.sites()), value(before_newest), step(before_newest);
  for (int a = 0; a < d; ++a) {
    for (std::size_t i = 0; i < value.size(); ++i) {
      const std::size_t at = i * delf::at(C) + delf::at(system_.field_component(a));
      before_newest[i] = before[at], value[i] = newest[at];
      step[i] = newest[at] - before[at];
    }
    own_layout_->scatter(before_newest, last_rows_.row(a), monodromy_);
    own_layout_->scatter(value, last_rows_.row(d + a), monodromy_);
    own_layout_->scatter(step, last_rows_.row(2 * d + a));
  }
  for (int r = 0; r < 3 * d; ++r) monitored_[r] = last_rows_.row(r);
}

/// Half a step before and after the observed row: y ∓ ½h φ_t.
void RowMonitors::copy_observed_pair() {
  const std::size_t d = theory_.components();
  const double h = problem_.time_step;
  std::vector<double> fields, rates, value(delf::at(problem_.lattice.sites()));
  stepper_.observe(0, fields, &rates);
  const auto put = [&](double of_field, double of_rate, std::size_t row, double gained) {
    for (std::size_t a = 0; a < d; ++a) {
      for (std::size_t i = 0; i < value.size(); ++i)
        value[i] = of_field * fields[i * d + a] + of_rate * rates[i * d + a];
      own_layout_->scatter(value, last_rows_.row(static_cast<int>(row * d + a)), gained);
    }
  };
  put(1, -0.5 * h, 0, monodromy_), put(1, 0.5 * h, 1, monodromy_), put(0, h, 2, 0);
  for (int r = 0; r < static_cast<int>(3 * d); ++r) monitored_[r] = last_rows_.row(r);
}

void RowMonitors::prepare() {
  if (!stepper_.layout()) own_layout_ = std::make_unique<RowLayout>(problem_.lattice, 1);
  const RowLayout& layout = this->layout();
  cell_weights_ = RowBuffer(layout, 1);
  const int N = problem_.lattice.sites(), cells = problem_.lattice.cells(), d = theory_.components();
  if (!stepper_.layout()) last_rows_ = RowBuffer(layout, 3 * d);
  for (int i = 0; i < cells; ++i) cell_weights_.row(0)[layout.slot(i)] = 1;
  monitored_.resize(3 * std::max(d, system_.components()));
  if (!theory_.is_placed()) return;
  positions_ = RowBuffer(layout, 1);
  std::vector<double> x(N);
  for (int i = 0; i < N; ++i) x[i] = problem_.lattice.position(i);
  layout.scatter(x, positions_.row(0));
}

std::size_t RowMonitors::bytes() const {
  return cell_weights_.bytes() + positions_.bytes() + last_rows_.bytes() + (own_layout_ ? own_layout_->bytes() : 0);
}

std::size_t RowMonitors::bytes_of_run() const {
  if (cell_weights_.rows()) return bytes();
  const auto bytes = [&](const RowLayout& layout, int own_rows) {
    return RowBuffer::bytes_of(layout.doubles(), 1 + (theory_.is_placed() ? 1 : 0) + own_rows);
  };
  if (stepper_.layout()) return bytes(*stepper_.layout(), 0);
  const RowLayout own(problem_.lattice, 1);
  return bytes(own, 3 * theory_.components()) + own.bytes();
}

}  // namespace delf

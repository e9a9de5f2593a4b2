// SPDX-License-Identifier: MIT
#include "schemes/verify/stress_balance.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "lattice/index.hpp"
#include "schemes/system/stress_energy.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

/// Below this a sum of doubles is what rounding left of it, relative to the sum of absolute values.
constexpr double round_off = 1e-12;

/// `energy`: the scale of energy. A field at rest carries no momentum, and the rounding that is left of it is no
/// measure for itself: energy is, whose units are the same.
Measured measured(const std::string& name, const BalanceLaw::Largest& largest, double energy) {
  const bool measurable = largest.scale > round_off * energy;
  const double scale = measurable ? largest.scale : energy;
  Measured m;
  m.name = name;
  m.normaliser = scale > 0 ? scale : 1;
  m.value = largest.value / m.normaliser;
  m.count = largest.count;
  if (!measurable && energy > 0 && !std::isnan(largest.scale)) m.remark = "there is no momentum: relative to energy";
  return m;
}

}  // namespace

void BalanceLaw::Largest::add(double candidate, double absolute, std::int64_t at_row, int at_site) {
  ++count;
  scale = std::max(scale, absolute);
  // A value that is not a number is found as well, and stays.
  if (std::isnan(value) || candidate <= value) return;
  value = candidate, row = at_row, site = at_site;
}

void BalanceLaw::add(std::int64_t row, const std::vector<Current>& cells) {
  const Sums above = sums(cells);
  if (below_.empty()) {
    first_density_ = above.density;
  } else {
    add_vertices(row, cells);
    add_total(row, above);
  }
  below_ = cells;
  sums_below_ = above;
}

void BalanceLaw::add_vertices(std::int64_t row, const std::vector<Current>& above) {
  const double per_h = 0.5 / time_step_, per_k = 0.5 / lattice_.space_step();
  for (int i = first_vertex(); i < end_vertex(); ++i) {
    const std::size_t left = left_cell(i), right = at(i);
    const Current &a = below_[left], &b = below_[right], &c = above[left], &d = above[right];
    // [mean_i e(j+½) − mean_i e(j−½)]/h + [mean_j f(i+½) − mean_j f(i−½)]/k + mean s
    const double defect = per_h * (c.density + d.density - a.density - b.density) +
                          per_k * (b.flux + d.flux - a.flux - c.flux) +
                          0.25 * (a.source + b.source + c.source + d.source);
    double absolute = 0;
    for (const Current* q : {&a, &b, &c, &d})
      absolute += per_h * std::abs(q->density) + per_k * std::abs(q->flux) + 0.25 * std::abs(q->source);
    local_.add(std::abs(defect), absolute, row, i);
  }
}

/// On a circle all cells. On an interval the wall cells by half: what lies between their middles, where the fluxes are
/// known, so that the total is the sum of the local laws and as accurate as they are.
BalanceLaw::Sums BalanceLaw::sums(const std::vector<Current>& cells) const {
  const double k = lattice_.space_step();
  Sums s;
  for (int i = first_vertex(); i < end_vertex(); ++i)
    for (const int cell : {left_cell(i), i}) {
      const Current& c = cells[cell];
      s.density += 0.5 * k * c.density;
      s.absolute += 0.5 * k * std::abs(c.density);
      s.source += 0.5 * k * c.source;
    }
  if (lattice_.space() == Space::interval) s.flux = cells.back().flux - cells.front().flux;
  return s;
}

void BalanceLaw::add_total(std::int64_t row, const Sums& above) {
  if (first_vertex() >= end_vertex()) return;
  // E(j+½) − E(½) + h Σ_{rows 1 … j} mean_j (F_right − F_left + S)
  passed_ += 0.5 * time_step_ * (sums_below_.flux + sums_below_.source + above.flux + above.source);
  const double defect = (above.density - first_density_) + passed_;
  total_.add(std::abs(defect), above.absolute + std::abs(passed_), row, 0);
}

StressBalance::StressBalance(const FieldTheory& theory, const Lattice& lattice, double time_step, double monodromy)
    : theory_(theory),
      lattice_(lattice),
      time_step_(time_step),
      jets_(theory.density(), lattice, time_step, monodromy),
      energy_(lattice, time_step),
      momentum_(lattice, time_step) {
  const std::size_t cells = lattice.cells();
  energy_cells_.resize(cells), momentum_cells_.resize(cells);
}

void StressBalance::add(std::int64_t row, std::span<const double> fields) {
  if (fields.size() != at(theory_.components()) * at(lattice_.sites()))
    throw std::logic_error("a balance of energy over a row of another size");
  if (!row_.empty()) {
    if (row != newest_ + 1) throw std::logic_error("a balance of energy over rows that are not consecutive");
    add_cells(newest_, fields);
  }
  newest_ = row;
  row_.assign(fields.begin(), fields.end());
}

void StressBalance::add_cells(std::int64_t row, std::span<const double> above) {
  const double t = (static_cast<double>(row) + 0.5) * time_step_;
  for (int i = 0; i < lattice_.cells(); ++i) {
    const StressEnergy s = stress_energy(theory_.density(), jets_.at(i, row_, above), t,
                                         lattice_.position(i) + 0.5 * lattice_.space_step());
    energy_cells_[i] = {s.energy, s.energy_flux, s.by_t};
    momentum_cells_[i] = {s.momentum, s.momentum_flux, -s.by_x};
  }
  energy_.add(row, energy_cells_);
  if (lattice_.space() != Space::point) momentum_.add(row, momentum_cells_);
}

Measured StressBalance::local_of(const std::string& name, const BalanceLaw& law) const {
  Measured m = measured(name + " balance, local", law.local(), energy_.local().scale);
  const std::int64_t row = law.local().row;
  const int site = law.local().site;
  const double t = static_cast<double>(row) * time_step_;
  m.region = lattice_.space() == Space::point
                 ? fmt::format("row {}, t = {:.6g}", row, t)
                 : fmt::format("row {}, site {}, t = {:.6g}, x = {:.6g}", row, site, t, lattice_.position(site));
  return m;
}

Measured StressBalance::total_of(const std::string& name, const BalanceLaw& law) const {
  Measured m = measured(name + " balance, total", law.total(), energy_.total().scale);
  const std::int64_t row = law.total().row;
  m.region =
      fmt::format("between rows {} and {}, t = {:.6g}", row, row + 1, (static_cast<double>(row) + 0.5) * time_step_);
  if (lattice_.space() == Space::interval) m.region += ", from the middle of the first cell to that of the last";
  return m;
}

std::vector<Measured> StressBalance::results() const {
  if (theory_.density().slots() > 3) return of_second_order();
  std::vector<Measured> list{local_of("energy", energy_), total_of("energy", energy_)};
  if (lattice_.space() == Space::point) return list;
  list.push_back(local_of("momentum", momentum_));
  list.push_back(total_of("momentum", momentum_));
  return list;
}

/// Totals of a circle, through which nothing flows in or out: the flow from cell to cell is not known.
std::vector<Measured> StressBalance::of_second_order() const {
  const BatchDensity& density = theory_.density();
  for (int a = 0; a < density.components(); ++a)
    if (density.depends_on(3 * density.components() + a)) return {};
  if (!lattice_.is_circle()) return {};
  return {total_of("energy", energy_), total_of("momentum", momentum_)};
}

std::vector<Measured> with_orders(std::vector<Measured> coarse, const std::vector<Measured>& fine) {
  for (Measured& m : coarse) {
    const auto found = std::ranges::find(fine, m.name, &Measured::name);
    if (found == fine.end() || !(found->value >= round_off)) continue;
    m.order = std::log2(m.value * m.normaliser / (found->value * found->normaliser));
  }
  return coarse;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/stepping/asynchronous_stepper.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "jets/simd/scratch_rows.hpp"
#include "jets/tables/cell_points.hpp"
#include "jets/tables/density_on_table.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/families/mesh_families.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/constant_mass.hpp"

namespace delf {

AsynchronousStepper::AsynchronousStepper(const LatticeSystem& system, std::vector<double> steps)
    : system_(system),
      space_(*system.lattice().mesh()),
      density_(system.families()[0]->made_of()->density),
      d_(density_->components()),
      steps_(std::move(steps)),
      done_(steps_.size(), 0) {
  const std::optional<Eigen::MatrixXd> mass = constant_mass(*density_);
  if (!mass)
    throw BadInput("theory.name",
                   "theory.name: asynchronous steps need T(phi_t) quadratic; choose lattice.time = rows");
  const Eigen::MatrixXd inverse = mass->inverse();
  inverse_mass_.assign(inverse.data(), inverse.data() + inverse.size());
  for (const double A : lumped_masses(space_.mesh)) per_area_.push_back(1 / A);
  const bool coupled = couples_gradient(*density_);
  for (int c = 0; c < space_.mesh.cells(); ++c) read_cell(c, coupled);
}

void AsynchronousStepper::read_cell(int cell, bool coupled) {
  const auto corners = space_.mesh.cell(cell);
  const std::vector<TablePoint> table = cell_table(space_.mesh, cell, coupled);
  shapes_.resize(std::max(shapes_.size(), corners.size() + 1));
  Shape& shape = shapes_[corners.size()];
  const bool first = shape.entries.empty();
  shape.points = (static_cast<int>(table.size()) + lanes - 1) / lanes * lanes;
  first_weight_.push_back(weights_.size()), first_x_.push_back(x_.size());
  std::vector<double> kicks;
  for (std::size_t q = 0; q < table.size(); ++q) {
    double place = 0, readers = 0;  // the mean of the corners that are read, or by the weights of φ
    for (std::size_t slot = 0; slot < table[q].slots.size(); ++slot)
      for (const auto& [corner, weight] : table[q].slots[slot]) {
        if (first) shape.entries.push_back({static_cast<int>(slot), corner, static_cast<int>(q)});
        weights_.push_back(weight);
        kicks.push_back(steps_[cell] * table[q].weight * weight);
        const bool by_phi = !table[q][JetSlot::phi].empty();
        if (by_phi && slot != at(static_cast<int>(JetSlot::phi))) continue;
        place += (by_phi ? weight : 1) * space_.mesh.points[corners[corner]][0];
        readers += by_phi ? weight : 1;
      }
    if (density_->is_placed()) x_.push_back(place / readers);
  }
  if (density_->is_placed()) x_.resize(first_x_.back() + at(shape.points), x_.back());
  weights_.insert(weights_.end(), kicks.begin(), kicks.end());
}

void AsynchronousStepper::start(const std::vector<std::vector<double>>&) {
  throw BadInput("initial.start", "initial.start = exact: cells begin from a row and its momenta; use legendre");
}

void AsynchronousStepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  make_room();
  y_ = row0, momenta_ = momenta;
  newest_ = 0;
  for (std::size_t n = 0; n < momenta_.size(); ++n)
    if (space_.fixed[n / at(d_)]) momenta_[n] = 0;
  for (int c = 0; c < space_.mesh.cells(); ++c) kick(c, 0, y_, 0.5, momenta_);
  fill_queue();
}

void AsynchronousStepper::start_rates(const std::vector<double>& values, std::span<const double> rates) {
  const int variables = density_->variables();
  std::vector<double> momenta(values.size(), 0.0);  // p = A ∂²T φ_t
  for (std::size_t n = 0; n < momenta.size(); ++n)
    for (int b = 0; b < d_; ++b) {
      const int a = static_cast<int>(n) % d_;
      momenta[n] += density_->constant_hessian()[(d_ + a) * variables + d_ + b] / per_area_[n / at(d_)] *
                    rates[n - at(a) + at(b)];
    }
  start_legendre(values, momenta);
}

void AsynchronousStepper::make_room() {
  y_.assign(per_area_.size() * at(d_), 0.0);
  momenta_.assign(y_.size(), 0.0);
  times_.assign(per_area_.size(), 0.0);
  std::fill(done_.begin(), done_.end(), 0);
  time_ = 0, updates_ = 0;
  simultaneous_ = 1e-6 * *std::ranges::min_element(steps_);
}

/// n h, not a sum: two cells of one step stay together.
void AsynchronousStepper::fill_queue() {
  queue_.clear();
  for (int c = 0; c < space_.mesh.cells(); ++c) queue_.emplace_back(static_cast<double>(done_[c] + 1) * steps_[c], c);
  std::ranges::make_heap(queue_, std::ranges::greater());
}

void AsynchronousStepper::visit(SavedState& state) {
  if (state.restores()) make_room();
  state("newest", newest_), state("time", time_), state("updates", updates_);
  state.numbers("updates of cells", done_.data(), done_.size());
  state.numbers("field", y_.data(), y_.size()), state.numbers("momenta", momenta_.data(), momenta_.size());
  state.numbers("times of sites", times_.data(), times_.size());
  if (state.restores()) fill_queue();
}

void AsynchronousStepper::kick(int cell, double t, std::span<const double> y, double factor,
                               std::vector<double>& momenta) const {
  const auto corners = space_.mesh.cell(cell);
  const Shape& shape = shapes_[corners.size()];
  const double* const weights = weights_.data() + first_weight_[cell];
  const double* const kicks = weights + shape.entries.size();
  const int variables = density_->variables();
  const ScratchRows jets(variables, shape.points), g(variables, shape.points);
  std::fill_n(jets[0], variables * shape.points, 0.0);
  for (std::size_t e = 0; e < shape.entries.size(); ++e) {
    const auto& [slot, corner, point] = shape.entries[e];
    for (int a = 0; a < d_; ++a) jets[slot * d_ + a][point] += weights[e] * y[at(corners[corner] * d_ + a)];
  }
  density_->gradient({shape.points, jets.data(), t, x_.empty() ? jets[0] : x_.data() + first_x_[cell]}, g.data());
  for (std::size_t e = 0; e < shape.entries.size(); ++e) {
    const auto& [slot, corner, point] = shape.entries[e];
    if (const int site = corners[corner]; !space_.fixed[site])
      for (int a = 0; a < d_; ++a) momenta[at(site * d_ + a)] += factor * kicks[e] * g[slot * d_ + a][point];
  }
}

void AsynchronousStepper::drift(int site, double t) {
  const double passed = t - times_[site];
  if (passed <= simultaneous_) return;
  for (int a = 0; a < d_; ++a)
    for (int b = 0; b < d_; ++b)
      y_[site * d_ + a] += passed * per_area_[site] * inverse_mass_[a + b * d_] * momenta_[site * d_ + b];
  times_[site] = t;
  if (keeps_) events_[site].push_back({t, {y_.begin() + site * d_, y_.begin() + (site + 1) * d_}});
}

void AsynchronousStepper::update_next() {
  const auto [t, cell] = queue_.front();
  for (const auto site : space_.mesh.cell(cell)) drift(site, t);
  kick(cell, t, y_, 1, momenta_);
  if (keeps_) kept_.push_back({cell, t});
  put_first_back({static_cast<double>(++done_[cell] + 1) * steps_[cell], cell});
  time_ = t;
  ++updates_;
}

/// Replaces the first of the heap by a later one.
void AsynchronousStepper::put_first_back(Next next) {
  std::size_t hole = 0;
  for (std::size_t child = 1; child < queue_.size(); child = 2 * hole + 1) {
    if (child + 1 < queue_.size() && queue_[child + 1] < queue_[child]) ++child;
    if (next < queue_[child]) break;
    queue_[hole] = queue_[child], hole = child;
  }
  queue_[hole] = next;
}

void AsynchronousStepper::update(std::int64_t count) {
  for (; count > 0; --count) update_next();
}

void AsynchronousStepper::advance(double t) {
  while (queue_.front().first <= t) update_next();
  if (!std::isfinite(y_.front() + y_.back() + momenta_.front()))
    throw NotFinite("the field is not finite; use a smaller lattice.courant");
}

void AsynchronousStepper::step(bool /*looked_at*/) {
  advance(system_.times()->time(newest_ + 1));
  ++newest_;
}

std::vector<double> AsynchronousStepper::values(double t) const {
  std::vector<double> now = y_;
  for (std::size_t i = 0; i < times_.size(); ++i)
    for (int a = 0; a < d_; ++a)
      for (int b = 0; b < d_; ++b)
        now[i * at(d_) + at(a)] +=
            (t - times_[i]) * per_area_[i] * inverse_mass_[a + b * d_] * momenta_[i * at(d_) + at(b)];
  return now;
}

/// Impulses act at n h_K, in the middle of the step they stand for: at t a cell has given ½h_K + (t_K − t) too much.
std::vector<double> AsynchronousStepper::momenta(double t) const {
  const std::vector<double> now = values(t);
  std::vector<double> spread = momenta_;
  for (int c = 0; c < space_.mesh.cells(); ++c)
    kick(c, t, now, t / steps_[c] - static_cast<double>(done_[c]) - 0.5, spread);
  return spread;
}

std::vector<double> AsynchronousStepper::row(int back) const {
  if (back > 0) throw std::logic_error("asynchronous cells hold one row");
  return values(system_.times()->time(newest_));
}

std::vector<double> AsynchronousStepper::own_momenta() const { return momenta(system_.times()->time(newest_)); }

Window AsynchronousStepper::window(int rows) const {
  return system_.window(newest_ - rows + 1, std::vector(at(rows), row(rows - 1)), 0);
}

double AsynchronousStepper::residual() const { return std::numeric_limits<double>::quiet_NaN(); }

StepReport AsynchronousStepper::report(bool /*residual*/) const {
  const std::size_t rows = 8 * (2 * per_area_.size() * at(d_) + 2 * per_area_.size());
  const std::size_t cells = steps_.size() * (4 * 8 + sizeof(Next)) + 8 * (weights_.size() + x_.size());
  return {.starting_rows = 1,
          .iterates = false,
          .matrix_free = true,
          .follows_plan = false,
          .solver = "each cell by its own step, in the order of a priority queue (explicit)",
          .bytes = rows + cells,
          .memory = fmt::format("rows of the section {} B, cells {} B", rows, cells)};
}

void AsynchronousStepper::keep_updates() {
  keeps_ = true;
  kept_.clear();
  events_.assign(times_.size(), {});
  for (std::size_t i = 0; i < times_.size(); ++i) {
    const auto first = y_.begin() + static_cast<std::ptrdiff_t>(i) * d_;
    events_[i].push_back({times_[i], {first, first + d_}});
  }
}

}  // namespace delf

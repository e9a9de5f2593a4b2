// SPDX-License-Identifier: MIT
#include "schemes/complex/asynchronous.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "jets/simd/scratch_rows.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/system/conserved.hpp"
#include "schemes/system/constant_mass.hpp"

namespace delf {
namespace {

/// V_K of cells as stencils of a complex, a family for each number of corners.
class CellFamilies {
 public:
  CellFamilies(const CellSpace& space, ComplexSystem& system) : space_(space), system_(system) {}
  void add(int cell, std::span<const int> sites, double measure) {
    const auto corners = static_cast<int>(sites.size());
    if (!families_.contains(corners)) families_[corners] = system_.add_family(space_.tables.cell(corners));
    const int family = families_[corners];
    system_.add_stencil(family, sites, system_.add_table(family, space_.tables.cell_table(space_.mesh, cell)), measure);
  }

 private:
  const CellSpace& space_;
  ComplexSystem& system_;
  std::map<int, int> families_;
};

}  // namespace

AsynchronousEvolution::AsynchronousEvolution(const CellSpace& space, std::vector<double> steps)
    : space_(space),
      d_(space.density->components()),
      steps_(std::move(steps)),
      done_(steps_.size(), 0),
      potentials_(d_) {
  if (space.constraint)
    throw BadInput("theory.name",
                   "theory.name: cells with steps of their own have no constraints; choose lattice.time = rows");
  const std::optional<Eigen::MatrixXd> mass = constant_mass(*space.density);
  if (!mass)
    throw BadInput("theory.name",
                   "theory.name: asynchronous steps need T(phi_t) quadratic; choose lattice.time = rows");
  const Eigen::MatrixXd inverse = mass->inverse();
  inverse_mass_.assign(inverse.data(), inverse.data() + inverse.size());
  for (const Mesh::Point& p : space.mesh.points) potentials_.add_site({0, p[0], p[1], p[2]});
  CellFamilies families(space, potentials_);
  for (int c = 0; c < space.mesh.cells(); ++c) families.add(c, space.mesh.cell(c), 1);
}

void AsynchronousEvolution::start(std::span<const double> values, std::span<const double> rates) {
  make_room();
  std::ranges::copy(values, y_.begin());
  const int variables = space_.density->variables();
  for (int i = 0; i < space_.sites(); ++i)  // p = A ∂²T φ_t
    for (int a = 0; a < d_ && !space_.fixed[i]; ++a)
      for (int b = 0; b < d_; ++b)
        momenta_[i * d_ + a] +=
            space_.masses[i] * space_.density->constant_hessian()[(d_ + a) * variables + d_ + b] * rates[i * d_ + b];
  for (int c = 0; c < space_.mesh.cells(); ++c) kick(c, 0, y_, 0.5, momenta_);
  fill_queue();
}

void AsynchronousEvolution::make_room() {
  y_.assign(space_.sites() * d_, 0.0);
  momenta_.assign(y_.size(), 0.0);
  times_.assign(space_.sites(), 0.0);
  std::fill(done_.begin(), done_.end(), 0);
  time_ = 0, updates_ = 0;
  simultaneous_ = 1e-6 * *std::ranges::min_element(steps_);
}

/// n h, not a sum: two cells of one step stay together.
void AsynchronousEvolution::fill_queue() {
  queue_ = {};
  for (int c = 0; c < space_.mesh.cells(); ++c) queue_.emplace(static_cast<double>(done_[c] + 1) * steps_[c], c);
}

void AsynchronousEvolution::visit(SavedState& state) {
  if (state.restores()) make_room();
  state("time", time_), state("updates", updates_);
  state.numbers("updates of cells", done_.data(), done_.size());
  state.numbers("field", y_.data(), y_.size()), state.numbers("momenta", momenta_.data(), momenta_.size());
  state.numbers("times of sites", times_.data(), times_.size());
  if (state.restores()) fill_queue();
}

template <class Use>
void AsynchronousEvolution::at_cell(int cell, double t, std::span<const double> y, const Use& use) const {
  const auto [number, site] = potentials_.anchor(cell);
  const StencilFamily& family = *potentials_.row().families()[number];
  const auto corners = space_.mesh.cell(cell);
  const int values = family.size();
  // One cell in all lanes.
  const ScratchRows x(1, lanes), local(values, lanes), out(values, lanes);
  std::array<int, lanes> numbers;
  numbers.fill(site.space);
  Pack(0.0).store(x[0]);
  for (int i = 0; i < values; ++i) Pack(y[at(corners[i / d_] * d_ + i % d_)]).store(local[i]);
  use(family, StencilBatch{{1, 1, t, 0}, lanes, x[0], local[0], nullptr, numbers.data()}, out);
}

void AsynchronousEvolution::kick(int cell, double t, std::span<const double> y, double factor,
                                 std::vector<double>& momenta) const {
  const auto corners = space_.mesh.cell(cell);
  at_cell(cell, t, y, [&](const StencilFamily& family, const StencilBatch& batch, const ScratchRows& r) {
    family.residual(batch, r[0]);
    for (int i = 0; i < family.size(); ++i)
      if (const int site = corners[i / d_]; !space_.fixed[site])
        momenta[site * d_ + i % d_] += factor * steps_[cell] * r[i][0];
  });
}

void AsynchronousEvolution::drift(int site, double t) {
  const double passed = t - times_[site];
  if (passed <= simultaneous_) return;
  for (int a = 0; a < d_; ++a)
    for (int b = 0; b < d_; ++b)
      y_[site * d_ + a] += passed * inverse_mass_[a + b * d_] / space_.masses[site] * momenta_[site * d_ + b];
  times_[site] = t;
  if (keeps_) events_[site].push_back({t, {y_.begin() + site * d_, y_.begin() + (site + 1) * d_}});
}

void AsynchronousEvolution::update_next() {
  const auto [t, cell] = queue_.top();
  queue_.pop();
  for (const auto site : space_.mesh.cell(cell)) drift(site, t);
  kick(cell, t, y_, 1, momenta_);
  if (keeps_) cells_.push_back({cell, t});
  queue_.emplace(static_cast<double>(++done_[cell] + 1) * steps_[cell], cell);
  time_ = t;
  ++updates_;
}

void AsynchronousEvolution::update(std::int64_t count) {
  for (; count > 0; --count) update_next();
}

void AsynchronousEvolution::advance(double t) {
  while (next_time() <= t) update_next();
  if (!std::isfinite(y_.front() + y_.back() + momenta_.front()))
    throw NotFinite("the field is not finite; use a smaller lattice.courant");
}

std::vector<double> AsynchronousEvolution::values(double t) const {
  std::vector<double> now = y_;
  for (int i = 0; i < space_.sites(); ++i)
    for (int a = 0; a < d_; ++a)
      for (int b = 0; b < d_; ++b)
        now[i * d_ + a] += (t - times_[i]) * inverse_mass_[a + b * d_] / space_.masses[i] * momenta_[i * d_ + b];
  return now;
}

double AsynchronousEvolution::energy(double t) const {
  // Impulses act at n h_K, in the middle of the step they stand for: at t a cell has given ½h_K + (t_K − t) too much.
  const std::vector<double> now = values(t);
  std::vector<double> momenta = momenta_;
  double potential = 0;
  for (int c = 0; c < space_.mesh.cells(); ++c) {
    const double last = static_cast<double>(done_[c]) * steps_[c];
    kick(c, t, now, (t - last) / steps_[c] - 0.5, momenta);
    at_cell(c, t, now, [&](const StencilFamily& family, const StencilBatch& batch, const ScratchRows& L) {
      family.lagrangian(batch, L[0]);
      potential -= L[0][0];
    });
  }
  double kinetic = 0;  // ½ p M⁻¹ p/A
  for (int i = 0; i < space_.sites(); ++i)
    for (int a = 0; a < d_; ++a)
      for (int b = 0; b < d_; ++b)
        kinetic += 0.5 * momenta[i * d_ + a] * inverse_mass_[a + b * d_] * momenta[i * d_ + b] / space_.masses[i];
  return kinetic + potential;
}

Balance AsynchronousEvolution::momentum(const LinearSymmetry& symmetry) const {
  Balance balance;
  const std::size_t d = d_;
  for (std::size_t n = 0; n < y_.size(); ++n)
    balance.add(momenta_[n] * generator_at(symmetry, n % d, y_.data() + n - n % d));
  return balance;
}

std::size_t AsynchronousEvolution::bytes() const {
  return 8 * (2 * y_.size() + times_.size()) + steps_.size() * (8 + 8 + 4 + 16) + potentials_.bytes();
}

void AsynchronousEvolution::open_window() {
  keeps_ = true;
  cells_.clear();
  events_.assign(space_.sites(), {});
  for (int i = 0; i < space_.sites(); ++i)
    events_[i].push_back({times_[i], {y_.begin() + i * d_, y_.begin() + (i + 1) * d_}});
}

AsynchronousEvolution::Window AsynchronousEvolution::window() const {
  Window made{ComplexSystem(d_), {}};
  ComplexSystem& system = made.system;
  const int motion = system.add_family(space_.tables.motion());
  CellFamilies families(space_, system);
  std::vector<int> first(events_.size());
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const Mesh::Point& p = space_.mesh.points[i];
    const std::size_t count = events_[i].size();
    for (std::size_t m = 0; m < count; ++m) {
      const SiteRole role = space_.fixed[i] || m == 0 ? SiteRole::given
                            : m + 1 == count          ? m == 1 ? SiteRole::given : SiteRole::final
                            : m == 1                  ? SiteRole::initial
                                                      : SiteRole::free;
      const int site = system.add_site({events_[i][m].time, p[0], p[1], p[2]}, role);
      if (m == 0) first[i] = site;
      made.values.insert(made.values.end(), events_[i][m].values.begin(), events_[i][m].values.end());
      const double passed = m == 0 ? 0 : events_[i][m].time - events_[i][m - 1].time;
      if (m > 0) system.add_stencil(motion, std::array{site - 1, site}, 0, space_.masses[i] * passed, passed);
    }
  }
  for (const Kept& kept : cells_) {
    const auto corners = space_.mesh.cell(kept.cell);
    std::array<int, 4> sites{};
    for (std::size_t l = 0; l < corners.size(); ++l) {
      const auto& events = events_[corners[l]];
      const auto later = std::ranges::upper_bound(events, kept.time, {}, &SiteEvent::time);
      sites[l] = first[corners[l]] + static_cast<int>(later - events.begin()) - 1;
    }
    families.add(kept.cell, {sites.data(), corners.size()}, steps_[kept.cell]);
  }
  return made;
}

}  // namespace delf

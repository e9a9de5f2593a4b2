// SPDX-License-Identifier: MIT
#include "schemes/complex/space_rows.hpp"

#include <Spectra/MatOp/SparseSymMatProd.h>
#include <Spectra/SymEigsSolver.h>
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

#include "lattice/error.hpp"
#include "schemes/complex/complex_noether.hpp"
#include "schemes/stepping/saved_state.hpp"

namespace delf {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

}  // namespace

CellSpace::CellSpace(Mesh mesh_, std::shared_ptr<const BatchDensity> density_, bool fixed_boundary,
                     std::shared_ptr<const StencilFamily> constraint_)
    : MeshSpace{std::move(mesh_), {}},
      density(std::move(density_)),
      constraint(constraint_ ? std::make_shared<const ConstraintDensity>(std::move(constraint_)) : nullptr),
      tables(density),
      masses(lumped_masses(mesh)) {
  fixed.assign(mesh.points.size(), 0);
  if (fixed_boundary)
    for (const auto p : boundary_points(mesh)) fixed[static_cast<std::size_t>(p)] = 1;
}

double CellSpace::largest_constraint(std::span<const double> values) const {
  double most = 0;
  constraint->each(values, [&](std::size_t, double G, std::span<const double>) {
    if (!(std::abs(G) <= most)) most = std::abs(G);
  });
  return most;
}

SpaceRows::SpaceRows(const CellSpace& space)
    : space_(space),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (space.constraint ? per_point_ + 1 : 1)),
      is_still_(true),
      system_(space.constraint ? 1 : space.fields()) {
  add_row(0);
}

SpaceRows::SpaceRows(const CellSpace& space, std::span<const double> times)
    : space_(space),
      per_point_(space.constraint ? space.fields() : 1),
      per_row_(space.sites() * (space.constraint ? per_point_ + 1 : 1)),
      system_(space.constraint ? 1 : space.fields()) {
  const int n = space.sites();
  // in each row stencils of sites, of cells and of a constraint, and of motion to the next row
  const std::size_t rows = times.size(), sites = at(n), cells = at(space.mesh.cells()), values = at(per_point_),
                    constraints = space.constraint ? sites : 0;
  system_.reserve(rows * at(per_row_), rows * (sites + cells + constraints) + (rows - 1) * sites,
                  rows * (values * (sites + space.mesh.vertices.size()) + (values + 1) * constraints) +
                      2 * (rows - 1) * values * sites);
  for (std::size_t j = 0; j < times.size(); ++j) {
    add_row(system_.add_part());
    if (j == 0) continue;
    if (j == 1) motion_ = system_.add_family(space.tables.motion());
    part_of_motion_.push_back(system_.add_part());
    first_of_motion_.push_back(system_.complex().stencils());
    for (std::int32_t i = 0; i < n; ++i)
      system_.add_stencil(motion_, sites_of({rows_ - 2, rows_ - 1}, {&i, 1}), 0, space.masses[at(i)], 1,
                          part_of_motion_.back());
  }
  set_times(times);
  const int fields = n * per_point_, last = rows_ - 1;
  for (int j = 0; j < rows_; ++j)
    for (int s = 0; s < per_row_; ++s) {
      const bool multiplier = s >= fields;
      if (space.fixed[at(multiplier ? s - fields : s / per_point_)]) continue;
      // λ of the last row is in no equation, and G there is one for its fields; G of row 1 is in the data.
      system_.set_role(j * per_row_ + s, j == 0      ? SiteRole::given
                                         : j == last ? multiplier ? SiteRole::initial : SiteRole::final
                                         : j == 1    ? multiplier ? SiteRole::final : SiteRole::initial
                                                     : SiteRole::free);
    }
}

std::span<const int> SpaceRows::sites_of(std::initializer_list<int> rows, std::span<const std::int32_t> points) {
  sites_.clear();
  for (const int row : rows)
    for (const auto p : points)
      for (int a = 0; a < per_point_; ++a) sites_.push_back(row * per_row_ + p * per_point_ + a);
  return sites_;
}

void SpaceRows::add_row(int part) {
  const int n = space_.sites(), row = rows_;
  for (int s = 0; s < per_row_; ++s) {
    const int i = s < n * per_point_ ? s / per_point_ : s - n * per_point_;
    const Mesh::Point& p = space_.mesh.points[at(i)];
    system_.add_site({0, p[0], p[1], p[2]}, space_.fixed[at(i)] ? SiteRole::given : SiteRole::free);
  }
  if (rows_++ == 0) {
    site_ = system_.add_family(space_.tables.site());
    std::map<int, int> families;
    for (int c = 0; c < space_.mesh.cells(); ++c) {
      const auto corners = static_cast<int>(space_.mesh.cell(c).size());
      if (!families.contains(corners)) families[corners] = system_.add_family(space_.tables.gradient(corners));
      gradient_.push_back(families[corners]);
      gradient_tables_.push_back(system_.add_table(families[corners], space_.tables.gradient_table(space_.mesh, c)));
    }
    if (space_.constraint) {
      const std::vector<TablePoint> table = space_.tables.site_table();
      constraint_ = system_.add_family(PlacedFamily(space_.constraint, 1, table));
      system_.add_table(constraint_, table);
    }
  }
  part_of_row_.push_back(part);
  for (std::int32_t i = 0; i < n; ++i)
    system_.add_stencil(site_, sites_of({row}, {&i, 1}), 0, space_.masses[at(i)], 1, part);
  for (int c = 0; c < space_.mesh.cells(); ++c)
    system_.add_stencil(gradient_[at(c)], sites_of({row}, space_.mesh.cell(c)), gradient_tables_[at(c)], 1, 1, part);
  for (std::int32_t i = 0; i < n && space_.constraint; ++i) {
    if (space_.fixed[at(i)]) continue;
    sites_of({row}, {&i, 1});
    sites_.push_back(row * per_row_ + n * per_point_ + i);
    system_.add_stencil(constraint_, sites_, 0, weight_of_constraint(i), 1, part);
  }
}

double SpaceRows::weight_of_constraint(int point) const { return is_still_ ? 1 : space_.masses[at(point)]; }

std::vector<std::int32_t> SpaceRows::motion(int row) const {
  std::vector<std::int32_t> stencils(at(space_.sites()));
  std::iota(stencils.begin(), stencils.end(), first_of_motion_[at(row)]);
  return stencils;
}

std::vector<double> SpaceRows::with_multipliers(std::span<const double> fields,
                                                std::span<const double> multipliers) const {
  const std::size_t of_fields = space_.fields_of_row(), sites = at(space_.sites());
  std::vector<double> y(system_.nodes(), 0.0);
  for (int j = 0; j < rows_; ++j) {
    std::ranges::copy(fields.subspan(at(j) * of_fields, of_fields), y.begin() + j * per_row_);
    std::ranges::copy(multipliers.subspan(at(j) * sites, sites),
                      y.begin() + j * per_row_ + static_cast<std::ptrdiff_t>(of_fields));
  }
  return y;
}

std::vector<double> SpaceRows::with_multipliers(std::span<const double> fields) const {
  if (!space_.constraint) return {fields.begin(), fields.end()};
  const std::size_t of_fields = space_.fields_of_row(), of_row = space_.values_of_row(), d = at(space_.fields());
  std::vector<double> y = with_multipliers(fields, std::vector<double>(at(rows_) * at(space_.sites()), 0.0));
  const std::vector<Balance> E = system_.residual(y);
  for (int j = 0; j < rows_; ++j)
    space_.constraint->each(
        fields.subspan(at(j) * of_fields, of_fields), [&](std::size_t i, double, std::span<const double> slopes) {
          const std::size_t row = at(j) * of_row;
          if (!system_.complex().has_equation(static_cast<int>(row + i * d))) return;
          // E + |Δ| λ ∂G/∂φ = 0 along ∂G/∂φ
          double product = 0, square = 0;
          for (std::size_t a = 0; a < d; ++a) {
            product += E[row + i * d + a].sum * slopes[a];
            square += slopes[a] * slopes[a];
          }
          const double measure = weight_of_constraint(static_cast<int>(i)) * system_.factor(part_of_row_[at(j)], 0);
          if (square > 0) y[row + of_fields + i] = -product / square / measure;
        });
  return y;
}

void SpaceRows::set_times(std::span<const double> times) {
  for (int j = 0; j < rows_; ++j) {
    const double below = j == 0 ? 0 : times[at(j)] - times[at(j - 1)];
    const double above = j == rows_ - 1 ? 0 : times[at(j) + 1] - times[at(j)];
    set_row_measure(j, 0.5 * (below + above));
    if (j + 1 < rows_) set_motion(j, above, above);
  }
  move_to(times);
}

void SpaceRows::move_to(std::span<const double> times) {
  for (int j = 0; j < rows_; ++j)
    for (int s = 0; s < per_row_; ++s) system_.set_time(j * per_row_ + s, times[at(j)]);
}

bool SpaceRows::reads_time() const {
  for (int f = 0; f < system_.families(); ++f)
    if (system_.family(f).reads_time()) return true;
  return false;
}

namespace {

constexpr std::array<double, 3> three_rows{0, 1, 2};  // until start() says how long a step is

/// Of a symmetric matrix; 0 if it is not finite, or Lanczos's method does not converge.
double largest_eigenvalue(const Eigen::SparseMatrix<double>& K) {
  // Squares of what is near the ends of the range overflow.
  const double size = K.nonZeros() == 0 ? 0 : K.coeffs().abs().maxCoeff();
  if (!(size > 0) || !std::isfinite(size)) return 0;
  if (size > 1e100 || size < 1e-100) return size * largest_eigenvalue(K / size);
  constexpr int few = 32, basis = 24, most_iterations = 1000;
  if (K.rows() <= few)
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(Eigen::MatrixXd(K), Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
  Spectra::SparseSymMatProd<double> product(K);
  Spectra::SymEigsSolver<Spectra::SparseSymMatProd<double>> lanczos(product, 1, basis);
  lanczos.init();
  lanczos.compute(Spectra::SortRule::LargestAlge, most_iterations, 1e-8);
  return lanczos.info() == Spectra::CompInfo::Successful ? lanczos.eigenvalues()[0] : 0;
}

}  // namespace

SpaceEvolution::SpaceEvolution(const CellSpace& space, double time_step, ComplexSolver::Options options)
    : space_(space),
      h_(time_step),
      before_(time_step),
      rows_(space, three_rows),
      energy_rows_(space, std::array{0.0, 1.0}),
      solver_(std::make_unique<ComplexSolver>(rows_.system(), options)),
      steps_{1, 1, 1},
      y_(rows_.system().nodes(), 0.0) {}

std::span<const double> SpaceEvolution::row(int back) const {
  return {y_.data() + at(2 - back) * space_.values_of_row(), space_.fields_of_row()};
}

std::span<const double> SpaceEvolution::multipliers() const {
  const std::size_t of_row = space_.values_of_row(), fields = space_.fields_of_row();
  return std::span(y_).subspan(of_row + fields, of_row - fields);
}

std::size_t SpaceEvolution::bytes() const {
  return rows_.system().bytes() + energy_rows_.system().bytes() + solver_->bytes() + 8 * y_.size();
}

void SpaceEvolution::set_steps(const std::array<double, 3>& now) {
  const auto [below, above, row_measure] = now;
  rows_.set_motion(0, below, below);
  rows_.set_motion(1, above, above);
  rows_.set_row_measure(1, row_measure);
  solver_->rescale();
  steps_ = now;
}

void SpaceEvolution::take(double below, double above, double row_measure) {
  const std::size_t n = space_.values_of_row();
  std::copy(y_.begin() + static_cast<std::ptrdiff_t>(n), y_.end(), y_.begin());
  for (std::size_t i = 0; i < space_.fields_of_row() && space_.constraint; ++i)  // where Newton's method begins
    y_[2 * n + i] = y_[n + i] + above / below * (y_[n + i] - y_[i]);
  try {
    if (const std::array now{below, above, row_measure}; now != steps_) set_steps(now);
    if (rows_.reads_time()) rows_.move_to(std::array{time_ - direction_ * below, time_, time_ + direction_ * above});
    report_ = solver_->solve(y_);
    if (!std::isfinite(y_[2 * n])) throw NotFinite("the field is not finite; use a shorter time step");
  } catch (const NoConvergence&) {
    put_back();
    throw NoConvergence(fmt::format(
        "step {}, t = {:.6g}: the equations of the row were not solved: its step is too long for the field; "
        "reduce lattice.courant or lattice.time_step",
        newest_ + 1, time_ + above));
  } catch (const NotFinite&) {
    put_back();
    throw;
  }
}

/// The last good rows, without the one before them.
void SpaceEvolution::put_back() {
  const auto n = static_cast<std::ptrdiff_t>(space_.values_of_row());
  std::copy_backward(y_.begin(), y_.begin() + 2 * n, y_.end());
  std::fill(y_.begin(), y_.begin() + n, std::numeric_limits<double>::quiet_NaN());
}

void SpaceEvolution::start(std::span<const double> values, std::span<const double> rates,
                           std::optional<double> time_step) {
  const std::size_t n = space_.values_of_row(), fields = space_.fields_of_row();
  const double h = time_step.value_or(h_);
  for (std::size_t i = 0; i < fields; ++i) {
    y_[n + i] = values[i] - h * rates[i];  // so that the motion below row 0 is the rate; the rows move down in take()
    y_[2 * n + i] = values[i];
  }
  for (std::size_t i = 0; i < fields; ++i)
    if (space_.fixed[i / at(space_.fields())]) y_[n + i] = values[i];
  time_ = 0, direction_ = 1;
  take(h, h, 0.5 * h);
  newest_ = 1, time_ = h, before_ = h;
}

void SpaceEvolution::step(std::optional<double> time_step) {
  const double h = time_step.value_or(h_);
  take(before_, h, 0.5 * (before_ + h));
  before_ = h;
  time_ += direction_ * h;
  ++newest_;
}

void SpaceEvolution::visit(SavedState& state) {
  std::array<double, 3> steps = steps_;
  state("newest", newest_), state("time", time_), state("step before", before_), state("steps", steps);
  state("iterations", report_.iterations);
  state.numbers("rows", y_.data(), y_.size());
  if (!state.restores()) return;
  set_steps(steps);
  rows_.move_to(std::array{time_ - steps[0] - steps[1], time_ - steps[1], time_});
}

double SpaceEvolution::energy() const {
  energy_rows_.set_motion(0, 1, before_);
  for (const int row : {0, 1}) energy_rows_.set_row_measure(row, 0.5);
  energy_rows_.move_to(std::array{time_ - direction_ * before_, time_});
  return energy_of({y_.data() + y_.size() / 3, energy_rows_.system().nodes()});
}

double SpaceEvolution::energy(std::span<const double> values, std::span<const double> rates) const {
  energy_rows_.set_motion(0, 1, 1);
  energy_rows_.move_to(std::array{0.0, 0.0});
  for (const int row : {0, 1}) energy_rows_.set_row_measure(row, row == 0 ? 1 : 0);
  std::vector<double> y(energy_rows_.system().nodes(), 0.0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    y[i] = values[i];
    y[space_.values_of_row() + i] = values[i] + (space_.fixed[i / at(space_.fields())] ? 0 : rates[i]);
  }
  return energy_of(y);
}

double SpaceEvolution::energy_of(std::span<const double> rows) const {
  const ComplexSystem& system = energy_rows_.system();
  const auto sum = [&](std::span<const double> y, bool without_sites) {
    double total = 0;
    system.each_energy(system.all_stencils(), y, [&](ComplexSystem::Stencils batch, const double* E) {
      if (without_sites && system.family_of(batch[0]).vertices() == 1) return;
      for (std::size_t s = 0; s < batch.size(); ++s) total += E[s];
    });
    return total;
  };
  // ℓ(0, 0, 0) is in motion and gradients too, where it is no energy.
  const std::vector<double> zero(system.nodes(), 0.0);
  return sum(rows, false) - sum(zero, true);
}

Balance SpaceEvolution::momentum(const LinearSymmetry& symmetry) const {
  energy_rows_.set_motion(0, before_, before_);
  energy_rows_.move_to(std::array{time_ - direction_ * before_, time_});
  const std::span<const double> rows{y_.data() + space_.values_of_row(), 2 * space_.values_of_row()};
  return momentum_across(energy_rows_.system(), energy_rows_.motion(0), rows, symmetry);
}

double SpaceEvolution::residual() const {
  return std::isfinite(y_[0]) ? largest_residual(rows_.system(), y_) : y_[0];  // put_back() leaves no equation
}

void SpaceEvolution::turn_back() {
  const auto n = static_cast<std::ptrdiff_t>(y_.size() / 3);
  std::swap_ranges(y_.begin() + n, y_.begin() + 2 * n, y_.begin() + 2 * n);
  time_ -= direction_ * before_;  // of the row that is the newest now
  direction_ = -direction_;
}

std::optional<double> SpaceEvolution::largest_step() const {
  // y″ = −M⁻¹K y, of the linearised equations at 0: the largest eigenvalue ω² of M^(−1/2) K M^(−1/2), by Lanczos.
  const ComplexSystem& system = rows_.system();
  const auto d = at(space_.fields());
  const std::size_t n = space_.values_of_row(), fields = space_.fields_of_row();
  std::vector<Eigen::Triplet<double>> stiffness;
  std::vector<double> mass(n, 0.0);
  const std::vector<double> zero(system.nodes(), 0.0);
  system.each_jacobian(system.all_stencils(), zero, [&](ComplexSystem::Stencils batch, const double* J) {
    const auto size = at(system.family_of(batch[0]).size());
    for (std::size_t s = 0; s < batch.size(); ++s)
      for (std::size_t i = 0; i < size; ++i)
        for (std::size_t m = 0; m < size; ++m) {
          const std::size_t row = system.node(batch[s], static_cast<int>(i)),
                            column = system.node(batch[s], static_cast<int>(m));
          if (row < n || row >= n + fields || column < n || column >= n + fields || space_.fixed[(row - n) / d])
            continue;
          const double value = J[(i * size + m) * static_cast<std::size_t>(PlacedFamily::most) + s];
          if (system.family_of(batch[s]).time_power() == 1)
            mass[row - n] += 0.5 * value * steps_[1];  // two motions meet at a site, each M/h
          else stiffness.emplace_back(static_cast<int>(row - n), static_cast<int>(column - n), -value / steps_[2]);
        }
  });
  std::vector<Eigen::Triplet<double>> scaled;
  for (const auto& e : stiffness) {
    const double masses = mass[static_cast<std::size_t>(e.row())] * mass[static_cast<std::size_t>(e.col())];
    if (masses > 0) scaled.emplace_back(e.row(), e.col(), e.value() / std::sqrt(masses));
  }
  Eigen::SparseMatrix<double> K(static_cast<int>(fields), static_cast<int>(fields));
  K.setFromTriplets(scaled.begin(), scaled.end());
  const double eigenvalue = largest_eigenvalue(K);
  return eigenvalue > 0 ? std::optional(2 / std::sqrt(eigenvalue)) : std::nullopt;
}

}  // namespace delf

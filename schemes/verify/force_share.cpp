// SPDX-License-Identifier: MIT
#include "schemes/verify/force_share.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include "lattice/index.hpp"
#include "schemes/verify/drawn_region.hpp"

namespace delf {

namespace {

constexpr double rounding_unit = std::numeric_limits<double>::epsilon();
// Programs whose steps are solved by iteration leave some of the force.
constexpr double least_share = 1e-8;
// 2⁻³¹ is how often noise has the same sign in all of them.
constexpr std::int64_t most_stretches = 32, fewest_stretches = 24;

/// The partition of rows and sites: stretches of rows with all sites, or longer ones with some neighbouring sites.
/// Rounded values have a second difference E, of which a long smooth average leaves least.
struct Partition {
  std::size_t of_rows, of_sites;
};
constexpr std::size_t partitions = 2;
Partition partition(std::size_t which, std::size_t stretches) {
  constexpr std::size_t long_ones = 4, groups = most_stretches / long_ones;
  return which == 0 ? Partition{stretches, 1} : Partition{long_ones, groups};
}

}  // namespace

ForceShare::ForceShare(const LatticeSystem& system, std::int64_t rows, const Precision& precision)
    : system_(&system),
      row_(system),
      stride_(std::clamp<std::int64_t>(rows / 64, 1, 8)),
      precision_(precision),
      stretches_(delf::at(std::clamp<std::int64_t>(rows / stride_, 1, most_stretches))),
      rows_(rows),
      averages_(partitions * delf::at(2 * system.components())),
      at_(delf::at(system.lattice().sites() * system.components())) {
  for (std::size_t n = 0; n < averages_.size(); ++n) {
    const Partition parts = partition(n % partitions, stretches_);
    averages_[n].ES.assign(parts.of_rows * parts.of_sites, 0), averages_[n].SS = averages_[n].ES;
  }
  // Σ_a |∂E/∂y_a|, in the midst of space: what an error of the values makes of E
  const int middle = system.lattice().sites() / 2;
  for (int c = 0; c < system.components(); ++c) {
    if (system.component(c).role != Role::field) continue;
    double sum = 0;
    for (const Coefficient& one : system.linearised({0, middle}, c)) sum += std::abs(one.value);
    coefficients_ = std::max(coefficients_, sum);
  }
  rows_have_forces_ = find_whether_rows_have_forces();
}

/// A row of random values stands still for some reason if F is not 0 there.
bool ForceShare::find_whether_rows_have_forces() {
  std::mt19937_64 random(1);
  std::vector<double> row(at_.size());
  for (double& y : row) y = std::uniform_real_distribution<double>(0.5, 1.5)(random);
  const std::int64_t reach = std::max(1, system_->height());
  const std::vector<std::vector<double>> still(2 * reach + 1, row);
  system_->equations(system_->window(0, still, 0), reach, forces_);
  for (std::size_t n = 0; n < forces_.size(); ++n)
    if (has_force(n) && !(std::abs(forces_[n].sum) <= 1e-10 * forces_[n].absolute)) return true;
  return false;
}

bool ForceShare::has_force(std::size_t n) const {
  const Role role = system_->component(static_cast<int>(n) % system_->components()).role;
  return role == Role::field || role == Role::inner;
}

/// F of a row. A node between rows has the value that its field has below it.
void ForceShare::find_forces(const Window& window, std::int64_t row) {
  std::vector<double> here = window.rows[row - window.first_row];
  const int C = system_->components();
  for (int c = 0; c < C; ++c) {
    const Component& node = system_->component(c);
    if (node.role != Role::inner || node.at.time == 0) continue;
    for (int b = 0; b < C; ++b) {
      const Component& below = system_->component(b);
      if (below.field != node.field || below.at.time != 0 || below.at.space != node.at.space ||
          (below.role != Role::field && below.role != Role::inner))
        continue;
      for (std::size_t i = 0; i < here.size(); i += delf::at(C)) here[i + delf::at(c)] = here[i + delf::at(b)];
    }
  }
  const auto reach = static_cast<std::int64_t>(std::max(1, system_->height()));
  Window still = window;
  still.first_row = row - reach;
  still.rows.assign(2 * reach + 1, here), still.low.clear();
  row_.equations(still, row, forces_);
  forces_of_ = row;
}

void ForceShare::at(const Window& window, std::int64_t row, const EquationCheck& equations) {
  const std::vector<double>& here = window.rows[row - window.first_row];
  const bool evaluated = seen_++ % stride_ == 0;
  if (evaluated) find_forces(window, row);
  errors_.assign(at_.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t n = 0; n < at_.size(); ++n) {
    const double relative = equations.newest()[n];
    if (std::isnan(relative) || !has_force(n)) continue;
    // what is left of terms that cancel is no force
    const double force = evaluated ? std::abs(forces_[n].sum) : 0;
    const bool counts = evaluated && force > 1e-14 * forces_[n].absolute;
    if (counts && rows_have_forces_) force_ = std::max(force_, force);
    if (evaluated && rows_have_forces_) terms_ = std::max(terms_, forces_[n].absolute);
    if (!rows_have_forces_) terms_ = std::max(terms_, equations.sums()[n].absolute);
    if (system_->component(static_cast<int>(n) % system_->components()).role != Role::field) continue;
    ++equations_;
    Largest& largest = at_[n];
    largest.seen = true;
    const double error = errors_[n] = std::abs(equations.sums()[n].sum);
    if (error > largest.error) largest.error = error, largest.row = row;
    largest.failed = largest.failed || relative > equations.tolerance();
    if (const double y = std::abs(here[n]); y > largest.value)
      largest.value = y, largest_value_ = std::max(largest_value_, y);
    if (counts) largest.force = std::max(largest.force, force);
  }
  suspect(window, row, equations);
  add_to_averages(window, row, equations);
}

double ForceShare::Average::c() const {
  double all = 0, squares = 0;
  for (std::size_t b = 0; b < ES.size(); ++b) all += ES[b], squares += SS[b];
  return squares > 0 ? all / squares : 0;
}

double ForceShare::Average::least() const {
  const double mean = c();
  // The shortfall of the worst stretch below |c|: more than |c| if it has the other sign.
  double shortfall = 0;
  for (std::size_t b = 0; b < ES.size(); ++b)
    if (SS[b] > 0) shortfall = std::max(shortfall, (mean - ES[b] / SS[b]) * (mean < 0 ? -1 : 1));
  // The standard error of c by so many stretches: noise that lasts for some of them shows by the longer ones.
  const auto error_by = [&](std::size_t joined) {
    double squares = 0, weights = 0, count = 0;
    for (std::size_t b = 0; b < ES.size(); b += joined) {
      double off = 0;
      for (std::size_t n = b; n < std::min(b + joined, ES.size()); ++n) off += ES[n] - mean * SS[n], weights += SS[n];
      squares += off * off, count += 1;
    }
    return std::sqrt(squares * count / (count - 1)) / weights;
  };
  constexpr double standard_errors = 10;
  return std::min(shortfall, standard_errors * std::max(error_by(1), error_by(4)));
}

/// Equations do not count where the force is lost in the last digits of a step: there E is the force, without a sign of
/// its own.
void ForceShare::add_to_averages(const Window& window, std::int64_t row, const EquationCheck& equations) {
  const std::int64_t reach = std::max(1, system_->height());
  if (forces_of_ == row) {
    earlier_.push_back({row, std::vector<double>(at_.size())});
    for (std::size_t n = 0; n < at_.size(); ++n) earlier_.back().F[n] = forces_[n].sum;
  }
  while (earlier_.size() > 1 && earlier_[1].row < row - 2 * reach) earlier_.pop_front();
  if (!(earlier_.front().row < row - 2 * reach)) return;
  const std::vector<double>& force = earlier_.front().F;
  const std::size_t C = system_->components();
  // The stretch of the row, and its weight there: sin² falls to 0 at both ends.
  std::array<std::pair<std::size_t, double>, partitions> stretch;
  for (std::size_t which = 0; which < partitions; ++which) {
    const double of_rows = static_cast<double>(partition(which, stretches_).of_rows);
    const double place = (static_cast<double>(seen_) - 0.5) / static_cast<double>(rows_) * of_rows;
    const double sine = std::sin(std::numbers::pi * place);
    stretch[which] = {static_cast<std::size_t>(std::min(place, of_rows - 0.5)), sine * sine};
  }
  const double least = relative_bound_ * equations.scale();
  // A coefficient such as 2 − h²m² that was rounded is off by the same in all rows: E ~ ε |y|/h², a quarter of the terms.
  passed_over_ = std::max(passed_over_, std::max(precision_.asked, rounding_unit / 4) * equations.scale());
  const auto &below = window.rows[row - 1 - window.first_row], &above = window.rows[row + 1 - window.first_row];
  for (std::size_t n = 0; n < at_.size(); ++n) {
    if (std::isnan(equations.newest()[n]) || !has_force(n) || !(std::abs(force[n]) > least)) continue;
    const double E = equations.sums()[n].sum;
    forces_square_ += force[n] * force[n], ++forces_count_;
    for (const auto& [signal, S] : {std::pair{0, force[n]}, std::pair{1, above[n] - below[n]}}) {
      for (std::size_t which = 0; which < partitions; ++which) {
        const std::size_t groups = partition(which, stretches_).of_sites, group = n * groups / at_.size();
        const auto& [at, weight] = stretch[which];
        Average& average = averages_[partitions * (2 * (n % C) + delf::at(signal)) + which];
        average.ES[at * groups + group] += weight * E * S, average.SS[at * groups + group] += weight * S * S;
      }
    }
  }
}

std::optional<Check> ForceShare::average() const {
  if (forces_count_ == 0) return std::nullopt;
  const double force = std::sqrt(forces_square_ / static_cast<double>(forces_count_));
  std::optional<Check> worst;
  for (std::size_t n = 0; n < averages_.size(); ++n) {
    const Average& average = averages_[n];
    const double squares = std::accumulate(average.SS.begin(), average.SS.end(), 0.0);
    std::set<double> different;  // groups of a field that is the same everywhere tell one thing
    for (std::size_t b = 0; b < average.SS.size(); ++b)
      if (average.SS[b] > 0) different.insert(n % partitions == 0 ? static_cast<double>(b) : average.ES[b]);
    const auto stretches = static_cast<std::int64_t>(different.size());
    if (stretches < fewest_stretches) continue;
    const double size =
        std::sqrt(2 * squares / static_cast<double>(forces_count_)) / force;  // weights are ½ on average
    const double value = std::abs(average.c()) * size;
    const double tolerance = std::max({least_share, average.least() * size, passed_over_ / force});
    if (worst && value / tolerance <= worst->value / worst->tolerance) continue;
    const bool by_force = n / partitions % 2 == 0;
    const char* signal = by_force ? "the force" : "φ_t";
    worst = Check{.name = "field equations, on average",
                  .region = fmt::format("along {}, {} stretches of rows{}", signal, stretches,
                                        n % partitions == 0 ? "" : " and sites"),
                  .value = value,
                  .tolerance = tolerance,
                  .normaliser = force,
                  .count = forces_count_,
                  .samples = stretches};
    worst->failure = fmt::format(
        "E follows {} in {} stretches of the rows, with {:.2g} of the force on average. Rounding follows nothing: {}.",
        signal, stretches, value,
        by_force ? "the force is another one (a mass, a coefficient), or steps were not solved"
                 : "there is friction, or a step that is not reversible");
  }
  return worst;
}

/// The worst equation of a row.
void ForceShare::suspect(const Window& window, std::int64_t row, const EquationCheck& equations) {
  const std::size_t C = system_->components();
  Suspect worst{.row = row};
  for (std::size_t n = 0; n < at_.size(); ++n)
    if (!std::isnan(equations.newest()[n]) && has_force(n))
      if (const double error = std::abs(equations.sums()[n].sum); !(error <= worst.error))
        worst.error = error, worst.n = n;
  if (worst.error == 0) return;
  const auto site = static_cast<int>(worst.n / C), component = static_cast<int>(worst.n % C);
  // The last change of a step moves what is nonlinear alone.
  const double left = 10 * precision_.solver * terms_;
  worst.bound = left + std::max(equations.error_at(window, row, site, component, precision_.values),
                                precision_.asked * equations.scale());
  relative_bound_ = worst.bound / equations.scale();
  if (closest_.bound == 0 || worst.error / worst.bound > closest_.error / closest_.bound) closest_ = worst;
  if (worst.error <= worst.bound) return;
  ++rows_beyond_;
  if (!(worst.error <= beyond_.error)) beyond_ = worst;
}

std::string ForceShare::where(std::size_t n, std::int64_t row) const {
  const std::size_t C = system_->components();
  return in_words(*system_, Node{{0, static_cast<int>(n / C)}, static_cast<int>(n % C)}, row);
}

std::optional<ForceShare::Judged> ForceShare::check() const {
  if (closest_.bound == 0) return std::nullopt;
  // The terms of the force cancel in an equilibrium.
  const double scale = force_ > closest_.bound ? force_ : terms_;
  const bool fails = beyond_.bound > 0 && !(beyond_.error <= least_share * scale);
  const Suspect& worst = fails ? beyond_ : closest_;
  Check check{.name = "field equations, beside the force",
              .region = where(worst.n, worst.row),
              .value = worst.error / scale,
              .tolerance = std::max(least_share, worst.bound / scale),
              .normaliser = scale,
              .count = equations_,
              .samples = seen_};
  check.failure = fmt::format(
      "|E| is {:.2g} of the largest force, in {} row{}, and rounding of the values explains {:.2g}. Beside the terms, "
      "which grow as 1/h², that may be little: the force is another one (a mass, a coefficient, friction), or steps "
      "were not solved.",
      check.value, rows_beyond_, rows_beyond_ == 1 ? "" : "s", worst.bound / scale);
  Judged judged{std::move(check)};
  if (!fails && !(scale > worst.bound))
    judged.unmeasurable = fmt::format(
        "What rounding of the values makes of the equations is {:.2g} times the force: rows of any force would pass. "
        "Record more digits, or verify rows of longer time steps.",
        worst.bound / scale);
  return judged;
}

SiteSeverity ForceShare::severity(std::size_t n) const {
  const std::size_t C = system_->components();
  const int site = static_cast<int>(n / C), c = static_cast<int>(n % C);
  double value = at_[n].value;
  for (const int side : {-1, 1})
    if (const int beside = system_->lattice().home(site + side); beside >= 0 && beside < system_->lattice().sites())
      value = std::max(value, at_[delf::at(beside) * C + n % C].value);
  return {.site = site,
          .field = system_->component(c).name,
          .row = at_[n].row,
          .error = at_[n].error,
          .force = at_[n].force,
          .rounding = coefficients_ * (8 * rounding_unit * value + precision_.solver * largest_value_)};
}

std::vector<SiteSeverity> ForceShare::sites() const {
  std::vector<SiteSeverity> all;
  for (std::size_t n = 0; n < at_.size(); ++n)
    if (at_[n].seen) all.push_back(severity(n));
  return all;
}

std::vector<Measured> ForceShare::measured() const {
  double force = 0;
  for (const Largest& largest : at_) force = std::max(force, largest.force);
  if (force == 0) return {};
  const std::size_t worst = std::ranges::max_element(at_, {}, &Largest::error) - at_.begin();
  std::vector<Measured> result{{.name = "equations: |E| beside the largest force",
                                .region = where(worst, at_[worst].row),
                                .value = at_[worst].error / force,
                                .normaliser = force,
                                .count = equations_}};
  std::size_t site = 0;
  double most = 0;
  for (std::size_t n = 0; n < at_.size(); ++n)
    if (const double share = at_[n].seen ? severity(n).share() : 0; share > most) most = share, site = n;
  if (most > 0)
    result.push_back({.name = "equations: |E| of a site beside its force",
                      .region = where(site, at_[site].row),
                      .value = most,
                      .normaliser = at_[site].force,
                      .count = equations_,
                      .remark = at_[site].failed ? "of equations that fail"
                                                 : "more than rounding, and below the tolerance of the checks"});
  return result;
}

}  // namespace delf

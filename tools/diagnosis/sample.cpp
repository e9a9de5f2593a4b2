// SPDX-License-Identifier: MIT
#include "tools/diagnosis/sample.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "schemes/methods/method_registry.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/diagnosis/fields_system.hpp"
#include "tools/diagnosis/own_equations.hpp"

namespace delf {
namespace {

constexpr int most_sites = 128, fewest_moments = 6, most_equations = 768, most_reach = 4;

std::unique_ptr<FieldTheory> theory_of(const Problem& p) { return make_theory(find_theory(p.theory), p.parameters); }

}  // namespace

Sample::Sample(const Evidence& evidence) : evidence_(evidence), fields_(evidence.system.components()) {
  const Lattice& lattice = evidence.system.lattice();
  // An even number, so that brick walls close.
  count_ = lattice.space() == Space::point ? 1 : std::min(lattice.sites(), most_sites) / 2 * 2;
  const std::int64_t reach = std::min<std::int64_t>(most_reach, (evidence.rows - 1) / 2);
  const int moments = std::max(fewest_moments, most_equations / (count_ * 6 * fields_));
  for (int m = 0; m < moments; ++m) moments_.push_back(reach + (evidence.rows - 1 - 2 * reach) * m / (moments - 1));
  moments_.erase(std::ranges::unique(moments_).begin(), moments_.end());

  const std::vector<double>&row = this->row(moments_[moments_.size() / 2]), &later = this->row(evidence.rows - 1);
  const std::size_t d = fields_;
  double largest = 0, change = 0;
  std::size_t steepest = 0;
  for (std::size_t n = 0; n < row.size(); ++n) {
    largest = std::max({largest, std::abs(row[n]), std::abs(later[n])});
    change = std::max(change, std::abs(row[n] - later[n]));
    // the seam of a circle may be a jump
    if (n >= d && std::abs(row[n] - row[n - d]) > std::abs(row[steepest] - row[steepest < d ? 0 : steepest - d]))
      steepest = n;
    if (n >= d) change = std::max(change, std::abs(row[n] - row[n - d]));
  }
  rests_ = !(change > 1e-12 * largest);
  first_ = std::clamp(static_cast<int>(steepest / d) - count_ / 2, 0, lattice.sites() - count_);
  first_ -= first_ % 2;  // bricks keep their parity
  find_schemes();
}

// Finds the schemes to try. Two have the same equations if the values of these are the same.
void Sample::find_schemes() {
  schemes_.push_back({scheme_label(evidence_.problem), evidence_.problem});
  std::vector<Equations> known;
  std::vector<double> distances;
  if (auto own = equations(evidence_.problem, {})) known.push_back(std::move(*own));
  for (NamedScheme& scheme : named_schemes(evidence_.problem)) {
    // A method that two rows do not start has more values than those rows hold; it may be costly to build.
    if (!std::ranges::count(find_method(scheme.problem.method).starts, StartRule::exact)) continue;
    auto found = equations(scheme.problem, {});
    if (!found) continue;
    const bool same = std::ranges::any_of(known, [&](const Equations& other) {
      return other.whole.size() == found->whole.size() &&
             (other.whole - found->whole).cwiseAbs().maxCoeff() <= 1e-13 * found->scale;
    });
    if (same) continue;
    schemes_.push_back(std::move(scheme));
    if (!known.empty() && known[0].whole.size() == found->whole.size())
      distances.push_back((known[0].whole - found->whole).cwiseAbs().maxCoeff());
    known.push_back(std::move(*found));
  }
  std::ranges::sort(distances);
  if (!distances.empty()) spread_ = distances[distances.size() / 2];
}

const std::vector<double>& Sample::row(std::int64_t j) const {
  const auto [at, fresh] = read_.try_emplace(j);
  if (fresh) at->second = evidence_.row(j);
  return at->second;
}

std::vector<double> Sample::values(std::int64_t row, Stride stride, int shift) const {
  const std::vector<double>& all = this->row(row);
  std::vector<double> values;
  const int sites = evidence_.system.lattice().sites();
  for (int n = 0; n < count_ / stride.sites; ++n)
    for (int c = 0; c < fields_; ++c) {
      const int i = std::min(first_ + shift + n * stride.sites, sites - 1);  // beyond it only where none is asked
      values.push_back(all[i * fields_ + c]);
    }
  return values;
}

std::optional<LatticeSystem> Sample::system(const Problem& given, Stride stride, double time_factor,
                                            double space_factor) const {
  const Lattice& there = given.lattice;
  Problem p = given;
  const double h = given.time_step * stride.rows, k = there.space_step() * stride.sites;
  const int n = count_ / stride.sites;
  const bool point = there.space() == Space::point;
  if (point && stride.sites > 1) return std::nullopt;
  if (!point) {
    if (n < 8) return std::nullopt;
    p.lattice = Lattice::circle(n / 2 * 2, n / 2 * 2 * k * space_factor).shifted(there.position(first_));
  }
  p.time_step = h * time_factor;
  auto system = fields_system(p);
  if (system && (system->components() != fields_ || (!point && 2 * system->width() + 4 > n))) return std::nullopt;
  return system;
}

Eigen::VectorXd Sample::evaluated(const LatticeSystem& system, Stride stride, int later, int shift,
                                  double& largest) const {
  std::vector<double> all;
  std::vector<LatticeSystem::Value> found;
  const std::int64_t reach = std::max(1, system.height());
  const int sites = system.lattice().sites(), edge = system.lattice().space() == Space::point ? 0 : system.width() + 1;
  for (const std::int64_t moment : moments_) {
    const std::int64_t j = moment + later;
    if (j - reach * stride.rows < 0 || j + reach * stride.rows >= evidence_.rows) continue;
    std::vector<std::vector<double>> rows;
    for (std::int64_t r = -reach; r <= reach; ++r) {
      rows.push_back(values(j + r * stride.rows, stride, shift));
      rows.back().resize(sites * fields_);
    }
    largest = std::max(largest, largest_of(rows));
    const std::int64_t row = j / stride.rows;
    system.equations(system.window(row - reach, std::move(rows), 0), row, found);
    for (int i = edge; i < sites - edge; ++i)
      for (int c = 0; c < fields_; ++c) all.push_back(found[i * fields_ + c].sum);
  }
  const double hk = system.time_step() * system.lattice().space_step();
  return Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size())) / hk;
}

std::optional<Sample::Equations> Sample::equations(const Problem& p, Stride stride, int shift) const {
  const auto own = system(p, stride, 1, 1);
  if (!own) return std::nullopt;
  double largest = 0;
  Equations result{evaluated(*own, stride, 0, shift, largest)};
  if (result.whole.size() == 0) return std::nullopt;
  result.scale = scale_of_terms(*own, largest) / (own->time_step() * own->lattice().space_step());
  return result;
}

std::optional<Sample::Split> Sample::split(const Problem& p, int later) const {
  const bool point = p.lattice.space() == Space::point;
  const auto own = system(p, {}, 1, 1), slow = system(p, {}, 2, 1), wide = system(p, {}, 1, point ? 1 : 2);
  if (!own || !slow || !wide) return std::nullopt;
  double largest = 0;
  const Eigen::VectorXd E = evaluated(*own, {}, later, 0, largest);
  if (E.size() == 0) return std::nullopt;
  // E(h, k) − E(2h, k) = (1 − ¼) of what goes by 1/h²
  Split result;
  result.time = (E - evaluated(*slow, {}, later, 0, largest)) / 0.75;
  result.space = (E - evaluated(*wide, {}, later, 0, largest)) / 0.75;
  result.force = E - result.time - result.space;
  // A direct residual may have a term of its own that goes by 1/h, such as friction: E(4h) then is not what these say.
  if (!is_variational(*own)) {
    const auto slowest = system(p, {}, 4, 1);
    double unused = 0;
    if (!slowest) return std::nullopt;
    const Eigen::VectorXd off =
        evaluated(*slowest, {}, later, 0, unused) - (result.time / 16 + result.space + result.force);
    if (off.cwiseAbs().maxCoeff() > 1e-9 * result.time.cwiseAbs().maxCoeff()) return std::nullopt;
  }
  const double h = own->time_step();
  result.scale = scale_of_terms(*own, largest) / (h * own->lattice().space_step());

  // −∂²ℓ/∂φ_t² (y_{j+1} − y_{j−1})/2h: friction, in the units of E
  const auto theory = theory_of(completed(p));
  const auto& H = theory->density().constant_hessian();
  const int m = theory->density().variables(), edge = point ? 0 : own->width() + 1;
  const std::int64_t reach = std::max(1, own->height());
  std::vector<double> all;
  for (const std::int64_t moment : moments_) {
    const std::int64_t j = moment + later;
    if (j - reach < 0 || j + reach >= evidence_.rows) continue;
    const auto above = values(j + 1, {}, 0), below = values(j - 1, {}, 0);
    for (int i = edge; i < own->lattice().sites() - edge; ++i)
      for (int c = 0; c < fields_; ++c) {
        const std::size_t n = i * fields_ + c;
        all.push_back(-H[(fields_ + c) * m + fields_ + c] * (above[n] - below[n]) / (2 * h));
      }
  }
  result.velocity = Eigen::Map<Eigen::VectorXd>(all.data(), static_cast<Eigen::Index>(all.size()));
  return result;
}

bool can_be_split(const Problem& p) {
  const auto theory = theory_of(completed(p));
  const BatchDensity& l = theory->density();
  if (l.is_placed() || l.slots() != 3) return false;
  const int d = l.components();
  for (int a = 0; a < 3 * d; ++a)
    for (int b = 0; b < 3 * d; ++b) {
      if (a / d == 0 && b / d == 0) continue;
      if (!l.is_constant(a, b) || (a / d != b / d && !l.is_zero(a, b))) return false;
    }
  return true;
}

}  // namespace delf

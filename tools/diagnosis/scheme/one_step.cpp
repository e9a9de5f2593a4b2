// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/methods/method_registry.hpp"
#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/scheme/momentum_scale.hpp"
#include "tools/diagnosis/scheme/one_step_maps.hpp"

namespace delf {
namespace {

/// Neighbouring sites of some frames: all of a lattice, or a part that is closed to a circle, of which the sites in the
/// middle are compared.
class Frames {
 public:
  Frames(const Evidence& e, int most_sites) : e_(e), d_(at(e.system.components())) {
    const Lattice& lattice = e.problem.lattice;
    problem_ = e.problem;
    sites_ = lattice.sites();
    if (sites_ <= most_sites) {
      problem_.winding = static_cast<int>(std::lround(e.monodromy / (2 * std::numbers::pi)));
    } else {
      sites_ = most_sites, margin_ = most_sites * 3 / 8;
      const auto row = e.row(e.rows / 2);
      std::size_t steepest = d_;
      for (std::size_t n = d_; n < row.size(); ++n)
        if (std::abs(row[n] - row[n - d_]) > std::abs(row[steepest] - row[steepest - d_])) steepest = n;
      first_ = std::clamp(static_cast<int>(steepest / d_) - sites_ / 2, 0, lattice.sites() - sites_);
      problem_.lattice = Lattice::circle(sites_, sites_ * lattice.space_step()).shifted(lattice.position(first_));
      problem_.winding = 0;
    }
    if (!e.momenta) return;
    const std::vector<double> masses = masses_of(e.problem);
    if (masses.empty()) return;
    momenta_ = momentum_scale(e, masses);
  }

  const Problem& problem() const { return problem_; }
  bool has_velocities() const { return !momenta_.scale.empty(); }
  const std::string& momenta_in_words() const { return momenta_.words; }

  std::vector<double> values(std::int64_t j) const { return part(e_.row(j)); }
  /// The velocities of the file, or central differences.
  std::vector<double> velocities(std::int64_t j) const {
    std::vector<double> v;
    if (has_velocities()) {
      v = e_.momenta(j);
      for (std::size_t n = 0; n < v.size(); ++n) v[n] /= momenta_.scale[n];
    } else {
      const double h = e_.problem.time_step;
      v = e_.row(j + 1);
      const auto now = e_.row(j);
      for (std::size_t n = 0; n < v.size(); ++n) v[n] = (v[n] - now[n]) / h;
    }
    return part(v);
  }
  /// The largest difference in the middle, or not a number.
  double distance(const std::vector<double>& a, const std::vector<double>& b) const {
    double most = 0;
    const std::size_t edge = at(margin_) * d_;
    for (std::size_t n = edge; n + edge < a.size(); ++n)
      if (const double by = std::abs(a[n] - b[n]); !(by <= most)) most = by;
    return most;
  }

 private:
  std::vector<double> part(const std::vector<double>& row) const {
    const auto begin = row.begin() + static_cast<std::ptrdiff_t>(at(first_) * d_);
    return {begin, begin + static_cast<std::ptrdiff_t>(at(sites_) * d_)};
  }

  const Evidence& e_;
  std::size_t d_;
  Problem problem_;
  int first_ = 0, sites_ = 1, margin_ = 0;
  MomentumScale momenta_;
};

double largest(const std::vector<double>& values) {
  double most = 0;
  for (const double y : values) most = std::max(most, std::abs(y));
  return most;
}

/// A step; false where there is none, or no finite one.
bool went(const OneStepMap& map, PhasePoint& z) {
  try {
    return map.step(z);
  } catch (const NumericalFailure&) {
    return false;
  }
}

/// True if the map takes frame j to frame j + 1, in φ and φ_t.
bool takes(const OneStepMap& map, const Frames& frames, std::int64_t j, double tolerance) {
  PhasePoint z{frames.values(j), frames.velocities(j)};
  const std::vector<double> q = frames.values(j + 1), v = frames.velocities(j + 1);
  const double size = std::max({largest(q), largest(v), largest(z.v)});
  return went(map, z) && frames.distance(z.q, q) <= tolerance * size && frames.distance(z.v, v) <= tolerance * size;
}

/// True if the rows come near the scene's own equations, as those of every scheme of its theory do: |E| is within a
/// quarter of the largest φ_tt.
bool are_near(const Evidence& e, const Sample& sample) {
  const auto own = sample.split(e.problem);
  if (!own) return false;
  const Eigen::VectorXd E = own->time + own->space + own->force;
  return E.cwiseAbs().maxCoeff() <= 0.25 * own->time.cwiseAbs().maxCoeff();
}

/// True if a φ_t of frame j leads to frame j + 1 and on to frame j + 2: v ← v + a (φ_{j+1} − φ(v))/h, whose error
/// falls as (h times the largest frequency)² for a = 1 where masses are those of sites. Of a mass that couples neighbours,
/// (1, 4, 1)/6, the error is up to tripled by its inverse: a = ½ halves it.
bool leads(const OneStepMap& map, const Frames& frames, std::int64_t j, double h, double tolerance, double a = 1) {
  constexpr int most = 60, first_look = 6;
  const std::vector<double> from = frames.values(j), to = frames.values(j + 1), next = frames.values(j + 2);
  std::vector<double> v = frames.velocities(j);
  const double size = std::max({largest(from), largest(to), largest(next)});
  double before = std::numeric_limits<double>::infinity();
  for (int n = 0; n < most; ++n) {
    PhasePoint z{from, v};
    if (!went(map, z)) return false;
    const double off = largest([&] {
      std::vector<double> by(v.size());
      for (std::size_t i = 0; i < v.size(); ++i) by[i] = to[i] - z.q[i], v[i] += a * by[i] / h;
      return by;
    }());
    if (!(off < 1e3 * size) || (n > 8 && off > before)) {
      if (!(off <= 16 * std::numeric_limits<double>::epsilon() * size)) return false;
      break;
    }
    before = off;
    // A map that is wrong by far more than φ_t still is need not be found to the last digit.
    if (n == first_look) {
      const bool far = !went(map, z) || frames.distance(z.q, next) > 100 * off + tolerance * size;
      if (far) return false;
    }
    if (off <= 2 * std::numeric_limits<double>::epsilon() * size) break;
  }
  PhasePoint z{from, v};
  return went(map, z) && frames.distance(z.q, to) <= tolerance * size && went(map, z) &&
         frames.distance(z.q, next) <= tolerance * size;
}

}  // namespace

std::optional<Finding> find_one_step(const Evidence& e, const Sample& sample) {
  if (e.rows < 4 || e.problem.circle_valued) return std::nullopt;
  if (!e.momenta && !can_be_split(e.problem)) return std::nullopt;
  const bool near = e.momenta || are_near(e, sample);  // else frames are several steps apart, or of another theory
  // Elements are solved slab by slab.
  constexpr int most_sites = 256, most_sites_of_elements = 64;
  const double tolerance = std::max(10 * e.tolerance, 1e-13);
  const std::array moments{std::int64_t{0}, (e.rows - 3) / 2, e.rows - 3};
  std::vector<std::string> same;
  std::optional<OneStepMap> found;
  std::string momenta;
  bool by_momenta = false;
  for (const bool elements : {false, true}) {
    const Frames frames(e, elements ? most_sites_of_elements : most_sites);
    momenta = frames.momenta_in_words(), by_momenta = frames.has_velocities();
    for (const OneStepMap& map : elements ? steps_of_elements(frames.problem()) : steps_by_force(frames.problem())) {
      if (!near && map.steps == 1) continue;
      if (!std::ranges::all_of(moments, [&](std::int64_t j) {
            return by_momenta ? takes(map, frames, j, tolerance)
                              : leads(map, frames, j, e.problem.time_step * map.steps, tolerance) ||
                                    (elements && leads(map, frames, j, e.problem.time_step, tolerance, 0.5));
          }))
        continue;
      if (!found) found = map;
      else if (same.size() < 3) same.push_back(map.name);
    }
    if (found || !near) break;
  }
  const std::string unknown = e.momenta && !by_momenta
                                  ? "The momenta of the file are neither φ_t, nor ∂ℓ/∂φ_t, nor those of a site, within "
                                    "a quarter, and were not used."
                                  : "";
  if (!found) return unknown.empty() ? std::nullopt : std::optional(Finding{"momenta", unknown, false});
  return Finding{"one-step", fmt::format("Each frame is a step of {} from the frame before it{}{}.{}{}{}", found->name,
                                         found->keys.empty() ? "" : " (" + found->keys + ")",
                                         by_momenta ? fmt::format(", in φ and in its momenta ({})", momenta)
                                                    : ", with the momenta that lead there",
                                         found->symplectic ? " It is a symplectic map." : " It is not symplectic.",
                                         same.empty() ? "" : fmt::format(" So it is of {}.", fmt::join(same, ", ")),
                                         unknown.empty() ? "" : " " + unknown)};
}

}  // namespace delf

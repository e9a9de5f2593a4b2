// SPDX-License-Identifier: MIT
#include "tools/verify/momenta_verification.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>

#include "lattice/index.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/verify/phase_space_check.hpp"
#include "tools/diagnosis/diagnosis.hpp"
#include "tools/diagnosis/fields_system.hpp"
#include "tools/diagnosis/own_equations.hpp"
#include "tools/diagnosis/rounded_values.hpp"
#include "tools/diagnosis/scheme/momentum_scale.hpp"
#include "tools/diagnosis/scheme/one_step_maps.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/recorded_section.hpp"
#include "tools/scene/recorded_scene.hpp"
#include "tools/verify/energy_history.hpp"
#include "tools/verify/verification.hpp"

namespace delf {
namespace {

RecordedSection opened(const std::string& file, const LatticeSystem& system, const Scene& scene, const char* option) {
  return {file, system, std::vector<int>(system.components(), 0), scene.problem.time_step, option};
}

/// (q, p) of a frame with p = ∂L/∂φ_t, where it is known what the file means by momenta.
class CanonicalRows {
 public:
  CanonicalRows(const std::string& file, const LatticeSystem& system, const Scene& scene, const char* option)
      : section_(opened(file, system, scene, option)) {}

  const RecordedSection& section() const { return section_; }
  void take_units(const MomentumScale& scale, const std::vector<double>& masses) {
    for (std::size_t n = 0; n < scale.scale.size(); ++n) factors_.push_back(masses[n] / scale.scale[n]);
  }
  void take_units(const CanonicalRows& other) { factors_ = other.factors_; }
  std::optional<CanonicalRow> at(std::int64_t j) const {
    auto p = section_.momenta(j);
    if (!p) return std::nullopt;
    for (std::size_t n = 0; n < factors_.size(); ++n) (*p)[n] *= factors_[n];
    return CanonicalRow{section_.row(j), std::move(*p)};
  }

 private:
  RecordedSection section_;
  std::vector<double> factors_;  ///< empty: they are taken as they are
};

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0;
  for (std::size_t n = 0; n < a.size(); ++n)
    if (const double by = std::abs(a[n] - b[n]); !(by <= most)) most = by;
  return most;
}

/// The scene's map, started at frames spread over the file.
Check check_map(const OneStepMap& map, const CanonicalRows& rows, const std::vector<double>& masses, double tolerance) {
  constexpr std::int64_t most_frames = 100;
  const std::int64_t steps = rows.section().rows() - 1, frames = std::min(steps, most_frames);
  Check check{.name = "one-step map (q, p)", .region = {}, .tolerance = tolerance};
  const auto velocities = [&](CanonicalRow z) {
    for (std::size_t n = 0; n < z.p.size(); ++n) z.p[n] /= masses[n];
    return PhasePoint{std::move(z.q), std::move(z.p)};
  };
  for (std::int64_t n = 0; n < frames; ++n) {
    const std::int64_t j = frames == 1 ? 0 : (steps - 1) * n / (frames - 1);
    PhasePoint z = velocities(*rows.at(j));
    const PhasePoint next = velocities(*rows.at(j + 1));
    const double size = largest_of({next.q, next.v});
    const double off =
        map.step(z) ? std::max(largest_difference(z.q, next.q), largest_difference(z.v, next.v)) : INFINITY;
    if (check.samples++ > 0 && !worse(off / size, check.value)) continue;
    check.value = size > 0 ? off / size : off, check.normaliser = size;
    check.count = static_cast<std::int64_t>(2 * next.q.size());
    check.region = fmt::format("frames {} and {}", j, j + 1);
    check.failure = fmt::format(
        "A step of {} from frame {} is {:.2g} of the largest value away from frame {}: the program steps by another "
        "map.",
        map.name, j, check.value, j + 1);
  }
  return check;
}

}  // namespace

bool has_momenta_alone(const Scene& scene, const std::string& fields) {
  const Simulation simulation = build(scene, 0);
  const auto& components = simulation.components();
  if (std::ranges::all_of(components, [](const Component& c) { return c.role == Role::field; })) return false;
  if (!step_of(scene.problem)) return false;
  const auto system = fields_system(explicit_scheme(scene.problem));
  if (!system) return false;
  const RecordedSection section = opened(fields, *system, scene, "--fields");
  return section.momenta(0) && !section.has(Role::inner);
}

void verify_momenta(const Scene& scene, const VerifyRequest& request, const std::string& fields,
                    const std::vector<std::string>& nearby, bool alone, Verdict& verdict) {
  const auto begin = std::chrono::steady_clock::now();
  const Problem plain = explicit_scheme(scene.problem);
  const auto system = fields_system(plain);
  if (!system || request.unwrap) return;
  // Rows are not those of an explicit scheme where sites move, or the scheme has more fields than the theory.
  const Simulation simulation = build(scene, 0);
  if (simulation.evolution().system().moves() || simulation.count(Role::field) != system->components()) return;
  CanonicalRows rows(fields, *system, scene, "--fields");
  if (!rows.section().momenta(0) || rows.section().rows() < 4) return;
  require_recorded_parameters(scene, fields, rows.section().scene());
  std::vector<CanonicalRows> beside;
  for (const std::string& file : nearby) {
    beside.emplace_back(file, *system, scene, "--nearby");
    if (beside.back().section().rows() != rows.section().rows())
      throw BadScene(
          fmt::format("command line: --nearby {}: has {} rows, and the file of --fields has {}; give as "
                      "many",
                      file, beside.back().section().rows(), rows.section().rows()));
    if (!beside.back().section().momenta(0)) {
      beside.clear();
      break;
    }
  }
  if (beside.size() % 2 != 0) beside.clear();

  const auto row = [&](std::int64_t j) { return rows.section().row(j); };
  const double of_steps = std::max(request.tolerance, 10 * scene.problem.tolerance);
  const double monodromy =
      2 * std::numbers::pi * rows.section().winding().value_or(0) + gain_of(scene.problem.parameters);
  const Evidence evidence{plain, *system, monodromy, of_steps, rows.section().rows(), row, {}, [&](std::int64_t j) {
                            return *rows.section().momenta(j);
                          }};
  const std::vector<double> masses = masses_of(plain);
  const MomentumScale scale = masses.empty() ? MomentumScale{} : momentum_scale(evidence, masses);
  rows.take_units(scale, masses);
  for (CanonicalRows& file : beside) file.take_units(rows);
  const auto rounded = rounding_of(evidence.rows, row);
  const double rounding = rounded ? rounded->relative : 0;

  if (alone) {
    verdict.subject = "(q, p) of " + fields;
    verdict.seed = scene.initial.seed;
    verdict.left_out.push_back(
        "field equations: the file has momenta, and no values at the nodes inside the cells; the one-step map is tried "
        "instead");
    if (scale.scale.empty()) {
      verdict.checks.push_back(
          {.name = "one-step map (q, p)",
           .region = {},
           .value = NAN,
           .failure = "The momenta are neither φ_t, nor ∂ℓ/∂φ_t, nor those of a site, within a quarter."});
    } else {
      verdict.checks.push_back(check_map(*step_of(scene.problem), rows, masses, of_steps + 4 * rounding));
      verdict.stencils = verdict.checks.back().samples * system->lattice().sites();
    }
    if (verdict.failed() > 0 || request.identify) verdict.diagnosis = diagnose(evidence).findings;
  }

  std::vector<LinearSymmetry> symmetries;
  bool held = false;
  for (int c = 0; c < system->components(); ++c)
    held = held || system->is_held(0, c) || system->is_held(system->lattice().sites() - 1, c);
  if (request.wants("noether") && !held)
    symmetries = requested_symmetries(scene, request, simulation.theory(), *system);
  PhaseSpaceCheck check(symmetries, of_steps, rounding);
  std::vector<double> energies;  // on a point, H(q, p) of every row
  for (std::int64_t j = 0; j < rows.section().rows() && !Interrupt::asked(); ++j) {
    std::vector<CanonicalRow> others;
    for (const CanonicalRows& file : beside)
      if (auto z = file.at(j)) others.push_back(std::move(*z));
    const CanonicalRow here = *rows.at(j);
    if (others.size() == beside.size()) check.at(j, here, others);
    if (system->lattice().space() == Space::point)
      energies.push_back(
          hamiltonian(simulation.theory().density(), here.q, here.p, static_cast<double>(j) * scene.problem.time_step));
  }
  for (Check& one : check.checks()) verdict.checks.push_back(std::move(one));
  if (!energies.empty())
    verdict.measured.push_back(measured_energy("energy H(q, p) of the rows", energies, scene.problem.time_step,
                                               "H = p qdot - l; largest |H - H of the first row|, relative to that"));
  if (check.too_far())
    verdict.left_out.push_back(
        "symplectic form dq^dp of a step: the differences to the nearby solutions are too large, or rounding");
  if (beside.empty())
    verdict.left_out.push_back(
        "symplectic form dq^dp of a step: give two nearby solutions with their momenta, --nearby A --nearby B");
  verdict.seconds += seconds_since(begin);
}

}  // namespace delf

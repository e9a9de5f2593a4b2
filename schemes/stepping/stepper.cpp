// SPDX-License-Identifier: MIT
#include "schemes/stepping/stepper.hpp"

#include <algorithm>

#include "lattice/index.hpp"
#include "schemes/stepping/composition_stepper.hpp"
#include "schemes/stepping/gauge.hpp"
#include "schemes/stepping/kick_stepper.hpp"
#include "schemes/stepping/rows/row_stepper.hpp"
#include "schemes/stepping/saved_state.hpp"
#include "schemes/stepping/slab_stepper.hpp"
#include "schemes/system/equation_terms.hpp"

namespace delf {
namespace {

std::unique_ptr<StepMethod> choose(const LatticeSystem& system, const SolvePlan& plan, StepOptions options) {
  if (options.own_stepper) return options.own_stepper(system);
  options.tolerance = std::max(options.tolerance, smallest_tolerance);
  if (options.steps_vary || system.lattice().space() == Space::point)
    if (auto stepper = KickStepper::make(system, plan, options)) return stepper;
  if (options.steps_vary) return std::make_unique<SlabStepper>(system, plan, options);
  const bool has_own_walls = std::ranges::any_of(system.families(), [](const auto& family) {
    const Placement at = family->pattern().placement;
    return (at == Placement::left_wall || at == Placement::right_wall) && !family->made_of();
  });
  if (has_own_walls || !undetermined_means(system, plan).empty())
    return std::make_unique<SlabStepper>(system, plan, options);
  const bool processed = !options.processor.empty();
  const bool mirrored = std::ranges::any_of(
      system.families(), [](const auto& family) { return family->pattern().placement == Placement::left_mirror; });
  if (!processed && !mirrored && goes_by_rows(system, plan)) {
    try {
      return std::make_unique<RowStepper>(system, plan, options);
    } catch (const NoConvergence&) {
      // No constant part to iterate with: Newton's method takes the Jacobian where the field is.
    }
  }
  if (auto stepper = CompositionStepper::make(system, options)) return stepper;
  if (auto stepper = KickStepper::make(system, plan, options)) return stepper;
  if (processed)
    throw BadInput("scheme.method",
                   "scheme.method: a processed kernel is explicit sub-steps over pairs of sites, and these "
                   "equations are not; use scheme.method = multisymplectic");
  return std::make_unique<SlabStepper>(system, plan, options);
}

}  // namespace

Stepper::Stepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : method_(choose(system, plan, options)),
      report_(method_->report(false)),
      components_(at(system.components())),
      row_size_(at(system.lattice().sites() * system.components())),
      processed_(!options.processor.empty()) {}

void Stepper::start(const std::vector<std::vector<double>>& rows) {
  if (static_cast<int>(rows.size()) < starting_rows())
    throw BadInput("initial.start", "a start of " + std::to_string(rows.size()) + " rows: this scheme needs " +
                                        std::to_string(starting_rows()));
  for (const auto& row : rows) require_row(row.size());
  method_->start(rows);
  started_ = true;
}

void Stepper::start_centred(const std::vector<double>& row0, const std::vector<double>& velocity) {
  require_row(row0.size()), require_row(velocity.size());
  method_->start_centred(row0, velocity);
  started_ = true;
}

void Stepper::start_legendre(const std::vector<double>& row0, const std::vector<double>& momenta) {
  require_row(row0.size()), require_row(momenta.size());
  method_->start_legendre(row0, momenta);
  started_ = true;
}

void Stepper::visit(SavedState& state) {
  if (!state.restores()) require_start();
  method_->visit(state);
  started_ = true;
}

void Stepper::require_row(std::size_t values) const {
  if (values == row_size_) return;
  throw BadInput("initial.start", "a starting row of " + std::to_string(values) + " values: the section has " +
                                      std::to_string(row_size_) + " in a row");
}

}  // namespace delf

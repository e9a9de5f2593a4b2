// SPDX-License-Identifier: MIT
#include "schemes/stepper.hpp"

#include "schemes/composition_stepper.hpp"
#include "schemes/equation_terms.hpp"
#include "schemes/row_stepper.hpp"
#include "schemes/slab_stepper.hpp"

namespace delf {
namespace {

std::unique_ptr<StepMethod> choose(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options) {
  if (goes_by_rows(system, plan)) {
    try {
      return std::make_unique<RowStepper>(system, plan, options);
    } catch (const NoConvergence&) {
      // No constant part to iterate with: Newton's method takes the Jacobian where the field is.
    }
  }
  if (auto stepper = CompositionStepper::make(system, options)) return stepper;
  return std::make_unique<SlabStepper>(system, plan, options);
}

}  // namespace

Stepper::Stepper(const LatticeSystem& system, const SolvePlan& plan, const StepOptions& options)
    : method_(choose(system, plan, options)),
      components_(static_cast<std::size_t>(system.components())),
      row_size_(static_cast<std::size_t>(system.lattice().sites() * system.components())) {}

void Stepper::start(const std::vector<std::vector<double>>& rows) {
  if (static_cast<int>(rows.size()) < starting_rows())
    throw BadInput("initial.start", "a start of " + std::to_string(rows.size()) + " rows: this scheme needs " +
                                        std::to_string(starting_rows()));
  for (const auto& row : rows)
    if (row.size() != row_size_)
      throw BadInput("initial.start", "a starting row of " + std::to_string(row.size()) + " values: the section has " +
                                          std::to_string(row_size_) + " in a row");
  method_->start(rows);
  started_ = true;
}

}  // namespace delf

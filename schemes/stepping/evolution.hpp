// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <vector>

#include "lattice/plan/solve_plan.hpp"
#include "schemes/stepping/stepper.hpp"
#include "schemes/system/jet_slots.hpp"
#include "schemes/system/lattice_system.hpp"
#include "schemes/system/time_derivative.hpp"

namespace delf {

/// Field equations on a lattice with the plan that was made for them, ready to step.
class Evolution {
 public:
  /// Throws BadInput for equations that no plan can solve, and for a density without a kinetic term.
  Evolution(const Lattice& lattice, std::vector<std::shared_ptr<const StencilFamily>> families, double time_step,
            const StepOptions& options = {}, std::vector<Component> components = {})
      : parts_(std::make_unique<Parts>(lattice, std::move(families), time_step, options, std::move(components))) {}

  const LatticeSystem& system() const { return parts_->system; }
  const SolvePlan& plan() const { return parts_->plan; }
  Stepper& stepper() { return parts_->stepper; }
  const Stepper& stepper() const { return parts_->stepper; }

 private:
  struct Parts {
    LatticeSystem system;
    SolvePlan plan;
    Stepper stepper;
    Parts(const Lattice& lattice, std::vector<std::shared_ptr<const StencilFamily>> families, double h,
          const StepOptions& options, std::vector<Component> components)
        : system(lattice, std::move(families), h, std::move(components)),
          plan(planned(system)),
          stepper(system, plan, options) {}
    static SolvePlan planned(const LatticeSystem& system) {
      require_jet_slots(system);
      require_time_derivative(system);
      return make_plan(system.lattice(), system.pattern());
    }
  };
  std::unique_ptr<Parts> parts_;  ///< the stepper refers to the other two, which must stay where they are
};

}  // namespace delf

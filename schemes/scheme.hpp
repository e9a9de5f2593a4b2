// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <utility>

#include "schemes/evolution.hpp"
#include "schemes/variational_family.hpp"

namespace delf {

/// A scheme is a stencil with its jet map, and a density; the equations, their Jacobian, the forms and the plan are
/// generated:
///
///     auto scheme = delf::Scheme{delf::hexagon, PhiFour{}};
///     auto evolution = scheme.on(delf::Lattice::circle(254, 40.0), 0.05);
///     evolution.stepper().start({row0, row1});
///     evolution.stepper().step();
///
template <JetMap Map, Density D>
class Scheme {
 public:
  Scheme(Map, D density) : density_(std::move(density)) {}

  const D& density() const { return density_; }
  DiscreteLagrangian<Map, D> lagrangian() const { return {density_}; }

  std::shared_ptr<const VariationalFamily<Map, D>> family(double time_step, double space_step) const {
    return std::make_shared<VariationalFamily<Map, D>>(density_, time_step, space_step);
  }
  Evolution on(const Lattice& lattice, double time_step, const StepOptions& options = {}) const {
    return {lattice, {family(time_step, lattice.space_step())}, time_step, options};
  }

 private:
  D density_;
};

}  // namespace delf

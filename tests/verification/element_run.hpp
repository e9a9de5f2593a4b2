// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tests/row_distance.hpp"

namespace delf::testing {

/// A scheme with nodes inside its cells, from a state and its velocity by the discrete Legendre transform.
class ElementRun {
 public:
  ElementRun(Problem problem, StateRequest request, double of_velocity = 1)
      : problem_(std::move(problem)), state_(make(std::move(request), problem_)), simulation_(problem_) {
    const std::vector<double> row = section(&State::values);
    std::vector<double> rate = section(&State::velocities);
    for (double& v : rate) v *= of_velocity;
    simulation_.start_legendre(row, rate);
  }

  ElementRun& to(int row) {
    while (simulation_.newest() < row) simulation_.step();
    return *this;
  }
  Simulation& simulation() { return simulation_; }
  const State& state() const { return *state_; }

  /// The fields at the vertices of the newest row.
  std::vector<double> fields() const {
    std::vector<double> y(problem_.lattice.sites() * state_->components());
    simulation_.copy_row(0, y);
    return y;
  }
  std::vector<double> exact() const {
    std::vector<double> y(problem_.lattice.sites() * state_->components());
    state_->values(static_cast<double>(simulation_.newest()) * problem_.time_step, problem_.lattice, y);
    return y;
  }
  double error() const { return distance(fields(), exact()); }

 private:
  static std::unique_ptr<State> make(StateRequest request, Problem& problem) {
    request.theory = problem.theory;
    auto state = make_state(request, problem.lattice);
    if (problem.lattice.is_circle()) problem.winding = state->winding();
    return state;
  }
  /// Row 0 of all components, each where its node lies.
  std::vector<double> section(void (State::*of)(double, const Lattice&, std::span<double>) const) const {
    const auto& components = simulation_.components();
    const std::size_t C = components.size(), N = delf::at(problem_.lattice.sites()), d = delf::at(state_->components());
    std::vector<double> row(N * C), fields(N * d);
    for (std::size_t c = 0; c < C; ++c) {
      if (components[c].role == Role::multiplier) continue;
      const Lattice at = problem_.lattice.shifted(components[c].at.space * problem_.lattice.space_step());
      (state_.get()->*of)(components[c].at.time * problem_.time_step, at, fields);
      for (std::size_t i = 0; i < N; ++i) row[i * C + c] = fields[i * d + delf::at(components[c].field)];
    }
    return row;
  }

  Problem problem_;
  std::unique_ptr<State> state_;
  Simulation simulation_;
};

}  // namespace delf::testing

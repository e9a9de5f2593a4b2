// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/scheme.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "schemes/system/conserved.hpp"

namespace delf::testing {

/// A theory of any number of components, a stencil and a state, all by name, as a scene gives them.
class ByName {
 public:
  enum class From { exact, centred };

  ByName(Problem problem, StateRequest request, From from = From::exact)
      : problem_(std::move(problem)), state_(make(request, problem_)), simulation_(problem_) {
    if (from == From::centred) {
      std::vector<double> velocity(fields());
      state_->velocities(0, problem_.lattice, velocity);
      simulation_.start_centred(exact_row(0), velocity);
    } else {
      std::vector<std::vector<double>> rows;
      for (int r = 0; r < simulation_.starting_rows(); ++r) rows.push_back(all_components(exact_row(r)));
      simulation_.start(rows);
    }
  }

  Simulation& simulation() { return simulation_; }
  const State& state() const { return *state_; }

  /// Steps until the newest row is `row`.
  ByName& to(long row) {
    while (simulation_.newest() < row) simulation_.step();
    return *this;
  }

  /// The fields of the state at a row, site by site.
  std::vector<double> exact_row(long row) const {
    std::vector<double> y(fields());
    state_->values(static_cast<double>(row) * problem_.time_step, problem_.lattice, y);
    return y;
  }
  /// The fields of the newest row, site by site.
  std::vector<double> newest() const {
    std::vector<double> y(fields());
    simulation_.copy_row(0, y);
    return y;
  }
  /// max |φ − exact| at the newest row
  double error() const {
    const std::vector<double> y = newest(), exact = exact_row(simulation_.newest());
    double most = 0;
    for (std::size_t n = 0; n < y.size(); ++n) most = std::max(most, std::abs(y[n] - exact[n]));
    return most;
  }

 private:
  static std::unique_ptr<State> make(StateRequest request, Problem& problem) {
    request.theory = problem.theory;
    for (const auto& [key, value] : problem.parameters) request.values[key] = value;
    auto state = make_state(request, problem.lattice);
    if (problem.lattice.is_circle()) problem.winding = state->winding();
    return state;
  }
  std::size_t fields() const { return at(problem_.lattice.sites() * state_->components()); }
  /// With a zero for every multiplier.
  std::vector<double> all_components(const std::vector<double>& y) const {
    const auto all = simulation_.components().size(), d = at(state_->components());
    std::vector<double> row(all * at(problem_.lattice.sites()));
    for (std::size_t n = 0; n < y.size(); ++n) row[n / d * all + n % d] = y[n];
    return row;
  }

  Problem problem_;
  std::unique_ptr<State> state_;
  Simulation simulation_;
};

/// The largest change of Noether's sum of a density's own scheme over `steps` steps from rows 0 and 1, relative to its
/// first value.
inline double relative_drift(Evolution& evolution, const std::vector<std::vector<double>>& rows,
                             const LinearSymmetry& symmetry, int steps) {
  evolution.stepper().start(rows);
  const auto charge = [&] {
    return noether_charge(evolution.system(), evolution.stepper().window(2), evolution.stepper().newest(), symmetry);
  };
  const double first = charge();
  double drift = 0;
  for (int n = 0; n < steps; ++n) {
    evolution.stepper().step();
    drift = std::max(drift, std::abs(charge() - first));
  }
  return drift / std::abs(first);
}

}  // namespace delf::testing

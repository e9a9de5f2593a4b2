// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tests/row_distance.hpp"

namespace delf::testing {

using Numbers = std::vector<double>;

struct Elements {
  int functions;
  std::string quadrature;
  int points;
  std::string basis = "lagrange-lobatto";
  std::string continuity = {};  ///< empty: the method's own choice
};

inline Problem problem_of(const std::string& theory, double h, const Elements& e) {
  Problem p;
  p.theory = theory, p.method = "cgvi", p.lattice = Lattice::point(), p.time_step = h;
  p.parameters["scheme.functions"] = e.functions, p.parameters["scheme.quadrature"] = e.quadrature;
  p.parameters["scheme.points"] = e.points, p.parameters["scheme.basis"] = e.basis;
  if (!e.continuity.empty()) p.parameters["scheme.continuity"] = e.continuity;
  return p;
}

inline Problem problem_of(const std::string& theory, double h, const std::string& tableau) {
  Problem p;
  p.theory = theory, p.method = "cgvi", p.lattice = Lattice::point(), p.time_step = h;
  p.parameters["scheme.tableau"] = tableau;
  return p;
}

/// A state as `delf list states` has it.
inline std::unique_ptr<State> state_of(const std::string& theory, const std::string& name,
                                       const ParameterValues& values = {}) {
  StateRequest request;
  request.name = name, request.theory = theory, request.values = values;
  return make_state(request, Lattice::point());
}
inline Numbers at(const State& state, double t) {
  Numbers q(delf::at(state.components()));
  state.values(t, Lattice::point(), q);
  return q;
}
inline Numbers rate_at(const State& state, double t) {
  Numbers v(delf::at(state.components()));
  state.velocities(t, Lattice::point(), v);
  return v;
}

/// A body that starts at q with the velocity v.
class Body {
 public:
  Body(const std::string& theory, double h, const Elements& e, const Numbers& q, const Numbers& v)
      : Body(problem_of(theory, h, e), q, v) {}
  Body(const Problem& problem, const Numbers& q, const Numbers& v) : simulation_(problem), fields_(q.size()) {
    Numbers row, rate;
    for (const Component& c : simulation_.components()) {
      const bool has_value = c.role != Role::multiplier;
      row.push_back(has_value ? q[c.field] : 0);
      rate.push_back(has_value ? v[c.field] : 0);
    }
    simulation_.start_legendre(row, rate);
  }
  Body& to(int row) {
    while (simulation_.newest() < row) simulation_.step();
    return *this;
  }
  Numbers q() const {
    Numbers row(fields_);
    simulation_.copy_row(0, row);
    return row;
  }
  /// As /momentum of fields.h5 has it.
  Numbers p() const { return simulation_.dataset(0); }
  Simulation& simulation() { return simulation_; }

 private:
  Simulation simulation_;
  std::size_t fields_;
};

/// The error at t = 2 of a pendulum let go at 2, in n steps.
inline double swing_error(const Elements& e, int n) {
  const auto state = state_of("pendulum", "pendulum-swing");
  return distance(Body("pendulum", 2.0 / n, e, at(*state, 0), rate_at(*state, 0)).to(n).q(), at(*state, 2));
}

}  // namespace delf::testing

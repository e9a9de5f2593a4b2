// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/states/state_registry.hpp"
#include "tests/catch.hpp"

// States by name, and what they are asked in tests.
namespace delf::testing {

inline StateRequest request(const std::string& name, const std::string& theory = "sine-gordon") {
  StateRequest r;
  r.name = name;
  r.theory = theory;
  if (name == "formula") r.values["initial.phi"] = std::string("0.1");
  return r;
}

inline std::vector<double> values(const State& state, double t, const Lattice& lattice) {
  std::vector<double> y(lattice.sites() * state.components());
  state.values(t, lattice, y);
  return y;
}
inline std::vector<double> velocities(const State& state, double t, const Lattice& lattice) {
  std::vector<double> y(lattice.sites() * state.components());
  state.velocities(t, lattice, y);
  return y;
}

inline StateRequest with(StateRequest r, const std::function<void(StateRequest&)>& change) {
  change(r);
  return r;
}

/// A point of two components in phase space.
inline StateRequest body(const std::string& q, const std::string& v, const char* theory = "henon-heiles") {
  StateRequest r = request("point", theory);
  r.components = 2;
  r.values["initial.q"] = q, r.values["initial.v"] = v;
  return r;
}

/// The key that a refused request is told, with a remedy; "none" if it is not refused.
inline std::string key_of(const StateRequest& r, const Lattice& lattice = Lattice::circle(255, 40)) {
  try {
    make_state(r, lattice);
  } catch (const BadInput& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    CHECK(what.find("; ") != std::string::npos);  // a remedy
    return error.key();
  }
  return "none";
}

}  // namespace delf::testing

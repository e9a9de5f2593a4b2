// SPDX-License-Identifier: MIT
#include "schemes/state.hpp"

#include <cstddef>

namespace delf {
namespace {

void at_every_site(const State& state, double FieldPoint::*part, double t, const Lattice& lattice,
                   std::span<double> out) {
  std::vector<FieldPoint> point(state.components());
  std::size_t next = 0;
  for (int i = 0; i < lattice.sites(); ++i) {
    state.at(t, lattice.position(i), point);
    for (const FieldPoint& component : point) out[next++] = component.*part;
  }
}

}  // namespace

void State::values(double t, const Lattice& lattice, std::span<double> out) const {
  at_every_site(*this, &FieldPoint::phi, t, lattice, out);
}

void State::velocities(double t, const Lattice& lattice, std::span<double> out) const {
  at_every_site(*this, &FieldPoint::phi_t, t, lattice, out);
}

}  // namespace delf

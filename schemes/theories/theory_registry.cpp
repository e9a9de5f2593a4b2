// SPDX-License-Identifier: MIT
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry wave_theory, klein_gordon_theory, sine_gordon_theory, phi4_theory, double_sine_gordon_theory,
    sine_gordon_impurity_theory, pendulum_theory, kepler_theory, coupled_sine_gordon_theory,
    complex_klein_gordon_theory, wave_map_theory;

const std::vector<const TheoryEntry*>& theory_entries() {
  static const std::vector<const TheoryEntry*> entries{
      &wave_theory,
      &klein_gordon_theory,
      &sine_gordon_theory,
      &phi4_theory,
      &double_sine_gordon_theory,
      &sine_gordon_impurity_theory,
      &coupled_sine_gordon_theory,
      &complex_klein_gordon_theory,
      &wave_map_theory,
      &pendulum_theory,
      &kepler_theory};
  return entries;
}

}  // namespace delf

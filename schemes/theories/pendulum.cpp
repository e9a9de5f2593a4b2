// SPDX-License-Identifier: MIT
#include "schemes/theories/pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry pendulum_theory;
const TheoryEntry pendulum_theory{
    "pendulum", "q_tt + m² sin q = 0", {"theory.mass"},
    [](const Problem& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<Pendulum>>(Pendulum{p.mass});
    }};

}  // namespace delf

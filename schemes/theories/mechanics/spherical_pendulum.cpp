// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/spherical_pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry spherical_pendulum_theory;
const TheoryEntry spherical_pendulum_theory{
    "spherical-pendulum", "q_tt + e₃ = λq, |q| = 1", {}, [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<SphericalPendulum>>(SphericalPendulum{});
    }};

}  // namespace delf

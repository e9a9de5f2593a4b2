// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/pendulum.hpp"

#include <cmath>

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry pendulum_theory;
const TheoryEntry pendulum_theory{
    .name = "pendulum",
    .formula = "q_tt + m² (g/L) sin q = 0",
    .parameters = {mass_parameter(),
                   {.key = "theory.gravity", .fallback = 1.0, .help = "g of a pendulum", .range = {.low = 0}},
                   {.key = "theory.arm", .fallback = 1.0, .help = "its length L", .range = {.low = 0, .open = true}}},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<Pendulum>>(Pendulum{
          p.get<double>("theory.mass") * std::sqrt(p.get<double>("theory.gravity") / p.get<double>("theory.arm"))});
    },
    .angle = true,
    .vacuum = 0.0,
    .words = "the pendulum",
    .sources = {"arnold-1989"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/solar_system.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry solar_system_theory;
const TheoryEntry solar_system_theory{
    .name = "solar-system",
    .formula = "q_i,tt = Σ_j G m_j (q_j − q_i)/|q_j − q_i|³: the Sun, Jupiter to Pluto",
    .parameters = {},
    .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<SolarSystem>>(SolarSystem{});
    },
    .words = "the outer solar system",
    .sources = {"hairer-lubich-wanner-2006"}};

}  // namespace delf

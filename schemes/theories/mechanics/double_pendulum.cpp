// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/double_pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry double_pendulum_theory;
const TheoryEntry double_pendulum_theory{.name = "double-pendulum",
                                         .formula = "L = q₁_t² + ½q₂_t² + q₁_t q₂_t cos(q₁ − q₂) + 2 cos q₁ + cos q₂",
                                         .parameters = {},
                                         .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                           return std::make_unique<TheoryOf<DoublePendulum>>(DoublePendulum{});
                                         },
                                         .angle = true,
                                         .words = "the double pendulum",
                                         .sources = {"arnold-1989"}};

}  // namespace delf

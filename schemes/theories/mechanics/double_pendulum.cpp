// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/double_pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry double_pendulum_theory;
const TheoryEntry double_pendulum_theory{"double-pendulum",
                                         "L = q₁_t² + ½q₂_t² + q₁_t q₂_t cos(q₁ − q₂) + 2 cos q₁ + cos q₂",
                                         {},
                                         [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                           return std::make_unique<TheoryOf<DoublePendulum>>(DoublePendulum{});
                                         },
                                         true};

}  // namespace delf

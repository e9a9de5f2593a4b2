// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/henon_heiles.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry henon_heiles_theory;
const TheoryEntry henon_heiles_theory{.name = "henon-heiles",
                                      .formula = "q₁_tt + q₁ + 2q₁q₂ = 0, q₂_tt + q₂ + q₁² − q₂² = 0",
                                      .parameters = {},
                                      .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                        return std::make_unique<TheoryOf<HenonHeiles>>(HenonHeiles{});
                                      },
                                      .words = "the Hénon–Heiles system",
                                      .sources = {"henon-heiles-1964"}};

}  // namespace delf

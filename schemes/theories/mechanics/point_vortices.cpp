// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/point_vortices.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry point_vortices_theory;
const TheoryEntry point_vortices_theory{"point-vortices",
                                        "three vortices in the plane: Γ_i x_i,t = −∂H/∂y_i, Γ_i y_i,t = ∂H/∂x_i",
                                        {},
                                        [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                          return std::make_unique<TheoryOf<ThreeVortices>>(ThreeVortices{});
                                        }};

extern const TheoryEntry two_vortices_theory;
const TheoryEntry two_vortices_theory{
    "two-vortices", "two vortices in a field 1 + |q|²", {}, [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<TwoVortices>>(TwoVortices{});
    }};

}  // namespace delf

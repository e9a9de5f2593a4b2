// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/point_vortices.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry point_vortices_theory;
const TheoryEntry point_vortices_theory{
    .name = "point-vortices",
    .formula = "three vortices in the plane: Γ_i x_i,t = −∂H/∂y_i, Γ_i y_i,t = ∂H/∂x_i",
    .parameters = {},
    .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<ThreeVortices>>(ThreeVortices{});
    },
    .words = "three planar point vortices",
    .sources = {"rowley-marsden-2002", "kraus-2017"}};

extern const TheoryEntry two_vortices_theory;
const TheoryEntry two_vortices_theory{.name = "two-vortices",
                                      .formula = "two vortices in a field 1 + |q|²",
                                      .parameters = {},
                                      .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                        return std::make_unique<TheoryOf<TwoVortices>>(TwoVortices{});
                                      },
                                      .words = "two planar vortices in a varying field",
                                      .sources = {"kraus-2017"}};

}  // namespace delf

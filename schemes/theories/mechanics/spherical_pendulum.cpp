// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/spherical_pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry spherical_pendulum_theory;
const TheoryEntry spherical_pendulum_theory{.name = "spherical-pendulum",
                                            .formula = "q_tt + e₃ = λq, |q| = 1",
                                            .parameters = {},
                                            .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                              return std::make_unique<TheoryOf<SphericalPendulum>>(SphericalPendulum{});
                                            },
                                            .words = "the spherical pendulum",
                                            .sources = {"arnold-1989"}};

}  // namespace delf

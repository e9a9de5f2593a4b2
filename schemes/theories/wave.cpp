// SPDX-License-Identifier: MIT
#include "schemes/theories/wave.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry wave_theory;
const TheoryEntry wave_theory{.name = "wave",
                              .formula = "φ_tt − φ_xx = 0",
                              .parameters = {},
                              .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                return std::make_unique<TheoryOf<Wave>>(Wave{});
                              },
                              .vacuum = 0.0,
                              .words = "the wave equation",
                              .sources = {"whitham-1974"}};

}  // namespace delf

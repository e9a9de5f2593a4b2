// SPDX-License-Identifier: MIT
#include "schemes/theories/coupled_sine_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry coupled_sine_gordon_theory;
const TheoryEntry coupled_sine_gordon_theory{.name = "coupled-sine-gordon",
                                             .formula = "φ_a,tt − φ_a,xx + m² sin φ_a + λ sin(φ_a − φ_b) = 0",
                                             .parameters = {mass_parameter(), lambda_parameter()},
                                             .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                               return std::make_unique<TheoryOf<CoupledSineGordon>>(CoupledSineGordon{
                                                   p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
                                             },
                                             .angle = true,
                                             .vacuum = 0.0,
                                             .words = "two coupled sine-Gordon equations",
                                             .sources = {"delf"}};

}  // namespace delf

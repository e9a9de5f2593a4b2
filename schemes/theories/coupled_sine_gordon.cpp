// SPDX-License-Identifier: MIT
#include "schemes/theories/coupled_sine_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry coupled_sine_gordon_theory;
const TheoryEntry coupled_sine_gordon_theory{"coupled-sine-gordon",
                                             "φ_a,tt − φ_a,xx + m² sin φ_a + λ sin(φ_a − φ_b) = 0",
                                             {mass_parameter(), lambda_parameter()},
                                             [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                               return std::make_unique<TheoryOf<CoupledSineGordon>>(CoupledSineGordon{
                                                   p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
                                             },
                                             true, 0.0};

}  // namespace delf

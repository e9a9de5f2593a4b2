// SPDX-License-Identifier: MIT
#include "schemes/theories/double_sine_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry double_sine_gordon_theory;
const TheoryEntry double_sine_gordon_theory{"double-sine-gordon",
                                            "φ_tt − φ_xx + m² sin φ + λ sin 2φ = 0",
                                            {mass_parameter(), lambda_parameter()},
                                            [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                              return std::make_unique<TheoryOf<DoubleSineGordon>>(DoubleSineGordon{
                                                  p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
                                            },
                                            true, 0.0};

}  // namespace delf

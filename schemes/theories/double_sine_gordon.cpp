// SPDX-License-Identifier: MIT
#include "schemes/theories/double_sine_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry double_sine_gordon_theory;
const TheoryEntry double_sine_gordon_theory{.name = "double-sine-gordon",
                                            .formula = "φ_tt − φ_xx + m² sin φ + λ sin 2φ = 0",
                                            .parameters = {mass_parameter(), lambda_parameter()},
                                            .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                              return std::make_unique<TheoryOf<DoubleSineGordon>>(DoubleSineGordon{
                                                  p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
                                            },
                                            .angle = true,
                                            .vacuum = 0.0,
                                            .words = "the double sine-Gordon equation",
                                            .sources = {"campbell-peyrard-sodano-1986"}};

}  // namespace delf

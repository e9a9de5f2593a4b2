// SPDX-License-Identifier: MIT
#include "schemes/theories/phi4.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry phi4_theory;
const TheoryEntry phi4_theory{"phi4",
                              "φ_tt − φ_xx + λ(φ³ − φ) = 0",
                              {lambda_parameter()},
                              [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                return std::make_unique<TheoryOf<PhiFour>>(PhiFour{p.get<double>("theory.lambda")});
                              },
                              false, 1.0};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/phi4.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry phi4_theory;
const TheoryEntry phi4_theory{.name = "phi4",
                              .formula = "φ_tt − φ_xx + λ(φ³ − φ) = 0",
                              .parameters = {lambda_parameter()},
                              .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                return std::make_unique<TheoryOf<PhiFour>>(PhiFour{p.get<double>("theory.lambda")});
                              },
                              .vacuum = 1.0,
                              .words = "the φ⁴ equation",
                              .sources = {"campbell-schonfeld-wingate-1983"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/complex_klein_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry complex_klein_gordon_theory;
const TheoryEntry complex_klein_gordon_theory{
    "complex-klein-gordon",
    "φ_tt − φ_xx + m²φ + λ|φ|²φ = 0",
    {mass_parameter(), lambda_parameter()},
    [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<ComplexKleinGordon>>(
          ComplexKleinGordon{p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
    },
    false, 0.0};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/klein_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry klein_gordon_theory;
const TheoryEntry klein_gordon_theory{
    "klein-gordon",
    "φ_tt − φ_xx + m²φ = 0",
    {mass_parameter()},
    [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<KleinGordon>>(KleinGordon{p.get<double>("theory.mass")});
    },
    false, 0.0};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/phi4.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry phi4_theory;
const TheoryEntry phi4_theory{
    "phi4", "φ_tt − φ_xx + λ(φ³ − φ) = 0", {"theory.lambda"},
    [](const Problem& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<PhiFour>>(PhiFour{p.lambda});
    }};

}  // namespace delf

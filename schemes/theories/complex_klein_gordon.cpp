// SPDX-License-Identifier: MIT
#include "schemes/theories/complex_klein_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry complex_klein_gordon_theory;
const TheoryEntry complex_klein_gordon_theory{
    "complex-klein-gordon", "φ_tt − φ_xx + m²φ + λ|φ|²φ = 0", {"theory.mass", "theory.lambda"},
    [](const Problem& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<ComplexKleinGordon>>(ComplexKleinGordon{p.mass, p.lambda});
    }};

}  // namespace delf

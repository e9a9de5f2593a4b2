// SPDX-License-Identifier: MIT
#include "schemes/theories/sine_gordon_impurity.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry sine_gordon_impurity_theory;
const TheoryEntry sine_gordon_impurity_theory{
    "sine-gordon-impurity",
    "φ_tt − φ_xx + m²(1 + ε exp(−((x − x₀)/w)²)) sin φ = 0",
    {"theory.mass", "theory.strength", "theory.width", "theory.position"},
    [](const Problem& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<SineGordonImpurity>>(
          SineGordonImpurity{p.mass, p.impurity_strength, p.impurity_width, p.impurity_position});
    }};

}  // namespace delf

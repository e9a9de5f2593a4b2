// SPDX-License-Identifier: MIT
#include "schemes/theories/sine_gordon_impurity.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry sine_gordon_impurity_theory;
const TheoryEntry sine_gordon_impurity_theory{
    .name = "sine-gordon-impurity",
    .formula = "φ_tt − φ_xx + m²(1 + ε exp(−((x − x₀)/w)²)) sin φ = 0",
    .parameters = {mass_parameter(),
                   {.key = "theory.strength", .fallback = 1.0, .help = "strength of the impurity"},
                   {.key = "theory.width",
                    .fallback = 1.0,
                    .help = "width of the impurity",
                    .unit = "length",
                    .range = {.low = 0, .open = true}},
                   {.key = "theory.position", .fallback = 0.0, .help = "position of the impurity", .unit = "length"}},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<SineGordonImpurity>>(
          SineGordonImpurity{p.get<double>("theory.mass"), p.get<double>("theory.strength"),
                             p.get<double>("theory.width"), p.get<double>("theory.position")});
    },
    .angle = true,
    .words = "the sine-Gordon equation with an impurity",
    .sources = {"fei-kivshar-vazquez-1992"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/kepler.hpp"

#include "schemes/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theory_registry.hpp"

namespace delf {

extern const TheoryEntry kepler_theory;
const TheoryEntry kepler_theory{
    "kepler", "q_tt + q/|q|³ = 0", {},
    [](const Problem&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<Kepler>>(Kepler{});
    }};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/kepler.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry kepler_theory;
const TheoryEntry kepler_theory{
    "kepler", "q_tt + q/|q|³ = 0", {}, [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<Kepler>>(Kepler{});
    }};

}  // namespace delf

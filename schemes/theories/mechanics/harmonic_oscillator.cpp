// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/harmonic_oscillator.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry harmonic_oscillator_theory;
const TheoryEntry harmonic_oscillator_theory{
    "harmonic-oscillator",
    "q_tt + m²q = 0",
    {mass_parameter()},
    [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<HarmonicOscillator>>(HarmonicOscillator{p.get<double>("theory.mass")});
    }};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/harmonic_oscillator.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry harmonic_oscillator_theory;
const TheoryEntry harmonic_oscillator_theory{
    .name = "harmonic-oscillator",
    .formula = "q_tt + m²q = 0",
    .parameters = {mass_parameter()},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<HarmonicOscillator>>(HarmonicOscillator{p.get<double>("theory.mass")});
    },
    .words = "the harmonic oscillator",
    .sources = {"arnold-1989"}};

}  // namespace delf

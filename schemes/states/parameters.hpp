// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "schemes/states/state_registry.hpp"

namespace delf::initial {

// Parameters that several states have.
Parameter position_parameter();
Parameter speed_parameter(double fallback);
Parameter separation_parameter();
Parameter frequency_parameter();
Parameter wavenumber_parameter(int fallback);
Parameter amplitude_parameter(double fallback);
Parameter epsilon_parameter();
Parameter width_parameter();

/// A number as a person writes it.
std::string text(double);

/// initial.speed with |v| < 1; `what` is the pulse, for the message.
double subluminal(const StateBuild&, const std::string& what);
/// initial.position, L/2 if not given.
double centre(const StateBuild&);
/// theory.mass > 0, which a pulse needs for its width.
double pulse_mass(const StateBuild&);

/// γ = 1/√(1 − v²)
double lorentz_factor(double speed);

}  // namespace delf::initial

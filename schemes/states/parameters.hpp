// SPDX-License-Identifier: MIT
#pragma once
#include <optional>
#include <string>

#include "lattice/lattice.hpp"
#include "schemes/state.hpp"

namespace delf::initial {

/// A number as a person writes it.
std::string text(double);

/// The parameter, or what stands for it when the scene does not give it. Throws BadInput naming the key unless finite.
double finite(const std::string& key, const std::optional<double>&, double fallback);
/// The same, and greater than zero.
double positive(const std::string& key, const std::optional<double>&, double fallback);

/// initial.speed with |v| < 1; `what` is the pulse, for the message.
double subluminal(const StateRequest&, double fallback, const std::string& what);
/// initial.position, L/2 if not given.
double centre(const StateRequest&, const Lattice&);
/// theory.mass > 0, which a pulse needs for its width.
double pulse_mass(const StateRequest&);

/// γ = 1/√(1 − v²)
double lorentz_factor(double speed);

}  // namespace delf::initial

// SPDX-License-Identifier: MIT
#pragma once
#include "tools/stability/stability_findings.hpp"

namespace delf {

/// Runs a scheme from noise on 33 sites, on 32 if it closes on an even number only, over a grid of Courant numbers up to `most` and of mh from 0.1 to 10, and asks theory for
/// the ends of stability on a finer one. Ends early, with what it has, when interrupted.
StabilityMap make_stability_map(const NamedScheme&, double most, std::uint64_t seed);

/// The dispersion relation at the Courant number and the mass of the scheme's problem. Throws BadInput as linear_theory.
DispersionCurve make_dispersion_curve(const NamedScheme&);

}  // namespace delf

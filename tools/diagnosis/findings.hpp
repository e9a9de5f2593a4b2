// SPDX-License-Identifier: MIT
#pragma once
#include <optional>

#include "tools/diagnosis/evidence.hpp"
#include "tools/diagnosis/sample.hpp"

namespace delf {

// One kind of finding each, in the file of its name. A finding is returned only if the rows confirm it: what it says was
// tried on them, and the equations that failed hold.

// Findings for equations that fail at few rows or sites:
std::optional<Finding> find_rounding(const Evidence&);
std::optional<Finding> find_wrapped(const Evidence&);
std::optional<Finding> find_doubled_frame(const Evidence&);
std::optional<Finding> find_dropped_frame(const Evidence&);
std::optional<Finding> find_exchanged_frames(const Evidence&);
std::optional<Finding> find_edited_value(const Evidence&);
std::optional<Finding> find_first_rows(const Evidence&);
std::optional<Finding> find_seam(const Evidence&);
std::optional<Finding> find_fixed_sites(const Evidence&);
std::optional<Finding> find_sponge(const Evidence&);

// Findings for equations that fail everywhere:
/// Finds the scheme that the rows solve, at the steps of the scene, on every second site, or with every second row.
std::optional<Finding> find_scheme(const Evidence&, const Sample&);
/// The one-step map that takes each frame to the next, in (φ, φ_t): by the momenta of the file, or by those that lead to the
/// next frame.
std::optional<Finding> find_one_step(const Evidence&, const Sample&);
/// φ_tt ≈ a φ_xx + b N′(φ) (+ c φ_t), for every scheme: what makes the rows solve its equations, or comes nearest.
std::optional<Finding> find_coefficients(const Evidence&, const Sample&);
/// D²φ and N′(φ) taken at other rows than the scheme's, by least squares: explicit Euler, averages, …
std::optional<Finding> find_time_weights(const Evidence&, const Sample&);

/// The keys that tell a scheme from that of the scene: "lattice.stencil = hexagon"; empty if it is the same.
std::string keys_of(const Problem& scheme, const Problem& scene);

}  // namespace delf

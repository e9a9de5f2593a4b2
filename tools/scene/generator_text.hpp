// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "jets/symmetry.hpp"

namespace delf {

/// The generator of a transformation of the fields, as text: what each field changes by, separated by commas, affine in
/// the fields: "1" is φ ↦ φ + ε, "-phi2, phi1" turns two fields into each other, "2*phi1 - 0.5, 0" does neither.
/// Throws BadInput (verify.generator) for what cannot be read.
LinearSymmetry read_generator(const std::string& text, const std::vector<std::string>& fields);

}  // namespace delf

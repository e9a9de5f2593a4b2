// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "schemes/theories/field_theory.hpp"

namespace delf {

/// Throws BadInput for a theory of another space: a field that is called x, as the place is, where there are several places.
void require_theory_on(const FieldTheory&, Space);

/// The multipliers of the theory's constraints as components: "lambda", or of several "lambda1", "lambda2", …
std::vector<Component> multipliers_of(const FieldTheory&);

}  // namespace delf

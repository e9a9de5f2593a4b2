// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/parameter.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {

/// The key by which a density as text names those of its fields that are angles.
inline constexpr auto angles_key = "theory.angles";

/// The fields of a theory that are angles: values 2π apart are the same state. All of a built-in theory that is one of
/// angles; those of theory.angles for a density as text, which the theory has tested.
std::vector<int> angles_of(const std::string& theory, const FieldTheory&, const ParameterValues&);

}  // namespace delf

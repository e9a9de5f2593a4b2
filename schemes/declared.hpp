// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

/// Adds the fallback of every declared parameter that has no value. Throws BadInput, naming the key, for a value of
/// another type, out of range, or none of the choices.
void complete(ParameterValues&, const std::vector<Parameter>& declared);

/// The declared parameter of that key, or null.
const Parameter* find_parameter(const std::vector<Parameter>& declared, std::string_view key);

/// A value as a scene writes it.
std::string to_text(const ParameterValue&);

}  // namespace delf

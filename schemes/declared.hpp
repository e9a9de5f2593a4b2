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

/// The names in a list, as the choices of a key.
template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& named : list) names.push_back(named.name);
  return names;
}

/// A value as a scene writes it.
std::string to_text(const ParameterValue&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <utility>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

/// The numbers theory.NAME among the values of a scene, as NAME: what its formulas may read.
std::vector<std::pair<std::string, double>> theory_numbers(const ParameterValues&);

}  // namespace delf

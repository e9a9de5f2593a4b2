// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// The name of a field in figures and pages: φ for phi, φ₁ for phi1; other names as they are. Keys, formulas and files have
/// phi, which can be typed.
std::string field_symbol(const std::string& name);

}  // namespace delf

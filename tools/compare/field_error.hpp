// SPDX-License-Identifier: MIT
#pragma once
#include <span>

namespace delf {

struct FieldError {
  double linf, l2;
};
/// L∞ and √(k Σ e²) over all fields.
FieldError field_error(std::span<const double> field, std::span<const double> solution, double space_step);

}  // namespace delf

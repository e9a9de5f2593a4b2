// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// A number by the name that the scene gives it.
struct NamedNumber {
  std::string name;
  double value;
};

}  // namespace delf

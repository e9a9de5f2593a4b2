// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "lattice/error.hpp"

namespace delf {

/// A value that none of the known names is, with the nearest of them.
BadInput unknown_name(const std::string& key, const std::string& value, const std::vector<std::string>& names);

}  // namespace delf

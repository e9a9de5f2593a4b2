// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>

namespace delf::fuzz {

/// What a target does with any bytes. It reads all that they say, or refuses them by BadInput; anything else is a fault.
void read_bytes(std::string_view bytes);

}  // namespace delf::fuzz

// SPDX-License-Identifier: MIT
#pragma once
#include <string_view>

namespace delf {

/// True if a scene may have several lines of a key, such as the points of a stencil: one value, joined by " | ".
inline bool may_repeat(std::string_view key) { return key == "stencil.point"; }

}  // namespace delf

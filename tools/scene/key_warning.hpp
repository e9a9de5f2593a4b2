// SPDX-License-Identifier: MIT
#pragma once
#include <fmt/format.h>

#include <string>

#include "tools/scene/settings.hpp"

namespace delf {

/// "kink.ini:7: lattice.mesh = 3: warning: WHY", or "command line: --lattice.mesh = 3: warning: WHY".
inline std::string key_warning(const Settings& settings, const Setting& s, const std::string& why) {
  return fmt::format("{}: {}{} = {}: warning: {}", settings.place(s.key), s.line == 0 ? "--" : "", s.key, s.value, why);
}

}  // namespace delf

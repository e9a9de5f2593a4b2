// SPDX-License-Identifier: MIT
#pragma once
#include <string>

#include "tools/report/failure.hpp"

namespace delf {

/// `delf list`: the names of one kind (theories, stencils, schemes, states, scenes, results), or of all.
ExitCode list(const std::string& kind);

}  // namespace delf

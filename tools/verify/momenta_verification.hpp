// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "tools/verify/verdict.hpp"
#include "tools/verify/verify_request.hpp"

namespace delf {

/// The scene's scheme has values that the file of rows has not (nodes inside cells), and starts from momenta, which the file
/// has: its one-step map is verified, and no equations. Throws BadScene for a file that cannot be read.
bool has_momenta_alone(const Scene&, const std::string& fields);

/// Verifies rows with momenta: what the program's own one-step map keeps (PhaseSpaceCheck); and, `alone`, if it is that
/// of the scene's scheme, with a diagnosis where it is not. Rows without momenta are left as they are.
void verify_momenta(const Scene&, const VerifyRequest&, const std::string& fields,
                    const std::vector<std::string>& nearby, bool alone, Verdict&);

}  // namespace delf

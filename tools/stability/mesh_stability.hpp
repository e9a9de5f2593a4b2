// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/complex/complex_scene.hpp"
#include "tools/report/failure.hpp"

namespace delf {

/// `delf stability` on a mesh: the longest step of each method that steps a mesh, a table on stdout and stability.json in
/// `folder`. Small waves about φ = 0 are oscillators, y″ = −ω² y, each of which a method steps by itself: its limit is that of
/// ωh over the largest ω of the mesh, and runs on the mesh just below it and above it show it. Exit code 1 if they do not.
ExitCode stability(const ComplexScene&, const std::filesystem::path& folder);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/report/failure.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

struct ComplexScene;

/// `delf convergence`: a scene at steps halved again and again, its errors and their order.
ExitCode convergence(const Scene&, const std::filesystem::path& folder);
/// The convergence on a mesh, whose sides are halved.
ExitCode convergence(const ComplexScene&, const std::filesystem::path& folder);

}  // namespace delf

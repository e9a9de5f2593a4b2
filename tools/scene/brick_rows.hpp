// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>

#include "tools/scene/scene.hpp"

namespace delf {

/// Sets lattice.first_row of a brick wall, where the scene does not say it, to the parity of a frame, from its /time in
/// steps and from lattice.first_row in the scene that the file has. Frames without a time are counted from an even one. A
/// file that cannot be read is left to whoever reads its rows.
void take_first_row(Scene&, const std::filesystem::path&, int frame);

}  // namespace delf

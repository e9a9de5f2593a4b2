// SPDX-License-Identifier: MIT
#pragma once
#include <map>
#include <string>

#include "tools/scene/scene.hpp"

namespace delf {

/// The keys of a resolved scene, as a file of rows has it: "lattice.length" → "40".
std::map<std::string, std::string> recorded_keys(const std::string& scene_text);
/// Throws BadScene, with both values, where such a scene gives the theory of this scene other parameters, or its rows another
/// space or other walls. Of another theory, method or stencil nothing is asked: rows may be tried by any.
void require_recorded_parameters(const Scene&, const std::string& file, const std::string& scene_text);

/// ", recorded with lattice.stencil = triangle", where method or stencil are others than this scene's; else empty.
std::string recorded_otherwise(const Scene&, const std::string& scene_text);

}  // namespace delf

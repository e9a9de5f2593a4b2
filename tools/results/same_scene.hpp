// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <vector>

#include "tools/results/result_folder.hpp"

namespace delf {

/// The keys of scene.ini that verify.json has other values of, in words: then other rows were verified than those of this
/// folder. A verification of rows from a file says nothing of their start and their number.
std::vector<std::string> other_scene(const ResultFolder&);

}  // namespace delf

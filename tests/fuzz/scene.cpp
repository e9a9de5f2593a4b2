// SPDX-License-Identifier: MIT
#include "tools/scene/scene.hpp"

#include "tests/fuzz/scratch_file.hpp"
#include "tests/fuzz/target.hpp"

// A scene, with all that follows from its keys before rows are made.
void delf::fuzz::read_bytes(std::string_view bytes) { read_scene(written(".ini", bytes), {}); }

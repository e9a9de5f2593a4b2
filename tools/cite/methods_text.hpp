// SPDX-License-Identifier: MIT
#pragma once
#include "tools/cite/paper_text.hpp"
#include "tools/complex/complex_scene.hpp"
#include "tools/results/result_folder.hpp"

namespace delf {

/// The methods section of a scene, with the numbers of a folder of its results; null: there are none. Throws BadScene for
/// a scene that cannot be run.
PaperText methods_text(const Scene&, const ResultFolder*);
PaperText methods_text(const ComplexScene&, const ResultFolder*);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <vector>

#include "tools/report/failure.hpp"
#include "tools/scene/settings.hpp"

namespace delf {

/// Makes a film of the recorded rows of a folder, beside their energy: film.mp4 by ffmpeg, or where that is missing film.gif by
/// gnuplot, and figures/film.png, a frame of it. It takes their place when it is whole. Throws BadScene for what has no rows to
/// show, and SystemFailure where one of these programs fails. Interrupted, it leaves none.
ExitCode make_film(const std::filesystem::path& folder, const std::vector<Setting>& keys);

}  // namespace delf

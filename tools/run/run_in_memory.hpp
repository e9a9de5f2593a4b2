// SPDX-License-Identifier: MIT
#pragma once
#include <exception>
#include <functional>
#include <string>

#include "tools/run/recorder.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The results of a run that writes no files, as texts: those that `delf run` writes and prints.
struct RunInMemory {
  std::string status, summary, report, scene, section;
  std::exception_ptr failure;  ///< after which the rows so far are there; null if there is none
};

/// A run of a scene on a lattice without a folder, without figures, and without a word. `begin` is called before the first
/// row, `seen` for each recorded row. Interrupt::asked() ends it early. Throws BadScene.
RunInMemory run_in_memory(const Scene&, const std::function<void(const RowNames&)>& begin, const Recorder::Seen& seen);

}  // namespace delf

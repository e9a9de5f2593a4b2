// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <exception>
#include <functional>
#include <string>

#include "tools/run/recorder.hpp"
#include "tools/scene/scene.hpp"

namespace delf {

/// The results of a run that writes no files, as texts: those that `delf run` writes and prints.
struct RunInMemory {
  std::string status, summary, report, scene, section;
  std::string state;           ///< of the end, to go on from to the same bits; empty if there is none
  std::exception_ptr failure;  ///< after which the rows so far are there; null if there is none
};

/// The rows of a run in memory, as they come.
struct SeenInMemory {
  /// Called before the first row. So many records of the run that this one goes on from are part of it, in front of its own.
  std::function<void(const RowNames&, std::uint64_t kept)> begin;
  Recorder::Seen record;
};

/// A run of a scene on a lattice without a folder, without figures, and without a word: from its first rows or, with the
/// `state` of an earlier run, from there. Interrupt::asked() ends it early. Throws BadScene.
RunInMemory run_in_memory(const Scene&, const std::string& state, const SeenInMemory&);

}  // namespace delf

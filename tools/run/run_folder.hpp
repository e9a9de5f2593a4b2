// SPDX-License-Identifier: MIT
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "tools/files/folder_lock.hpp"
#include "tools/outcome/outcome.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/run/checkpoints.hpp"
#include "tools/run/failures_of_run.hpp"
#include "tools/run/room_for_summary.hpp"
#include "tools/run/run.hpp"
#include "tools/run/run_files.hpp"

namespace delf {

/// The folder that a run writes to, from its first file to the last one. While it lives a signal only asks for an end, and
/// no other run writes there.
class RunFolder {
 public:
  /// Makes the folder, and removes what an earlier run left there; a run that is `resumed` goes on with it.
  RunFolder(const std::filesystem::path&, const Resumed& resumed, Outcome&);

  /// Begins with the files open: writes scene.ini, and gives them back what a checkpoint holds of them. `resolved`: the
  /// scene with all that is in force.
  Checkpoints begin(RunFiles&, const Scene&, const std::string& resolved);
  /// A part of the run after which the others are tried still.
  template <class Part>
  void attempt(const Part& part) {
    failures_.attempt(part);
  }
  const FailuresOfRun& failures() const { return failures_; }
  /// summary.json, figures and the report. `draw` says why there are no figures; empty if it drew what was wanted. Throws
  /// the first failure.
  ExitCode end(const Subject&, const Scene&, const std::function<std::string()>& draw);

 private:
  /// Makes the folder before it is locked.
  struct Made {
    explicit Made(const std::filesystem::path&);
  };

  std::filesystem::path path_;
  const Resumed& resumed_;
  Outcome& outcome_;
  Interrupt interrupt_;  ///< before, nothing is lost when a signal ends the program at once
  Made made_;
  FolderLock lock_;
  std::optional<RoomForSummary> room_;  ///< always there, once earlier files are gone
  FailuresOfRun failures_;
};

}  // namespace delf

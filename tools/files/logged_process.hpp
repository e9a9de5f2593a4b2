// SPDX-License-Identifier: MIT
#pragma once
#include <sys/types.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "tools/report/failure.hpp"

namespace delf {

/// A copy of this process that does some work and ends, so that whatever happens there harms nobody here. What it prints
/// goes to run.log in its folder.
struct LoggedProcess {
  pid_t pid;
  int end;  ///< of a pipe that is closed when the process ends
};

/// Starts the work in `folder`, which is there. The process ends with the exit code that the work returns; Ctrl-C is its parent's,
/// and it does not outlive that. Throws SystemFailure if there is no process or pipe: `what` it is for, and the key to lower.
LoggedProcess start_logged(const std::filesystem::path& folder, const std::string& what, const std::string& key,
                           const std::function<ExitCode()>& work);
/// Waits, a fifth of a second at most, and returns the numbers of those that have ended, the last first.
std::vector<std::size_t> ended_of(const std::vector<LoggedProcess>&);
/// Waits for the end, and returns the status as waitpid() has it. A process is asked once.
int status_of(const LoggedProcess&);
/// Ends it.
void give_up(const LoggedProcess&);

/// The first line of the error in run.log of a folder: the last one that is not indented, as a quoted text below it is.
std::string error_in_log(const std::filesystem::path& folder);

}  // namespace delf

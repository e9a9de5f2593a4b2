// SPDX-License-Identifier: MIT
#include "tools/files/logged_process.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fstream>

namespace delf {

namespace fs = std::filesystem;

namespace {

constexpr auto log_name = "run.log";

[[noreturn]] void carry_out(const fs::path& folder, const std::function<ExitCode()>& work) {
  setpgid(0, 0);  // Ctrl-C is the parent's
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // and no process outlives it
#endif
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  const int log = open((folder / log_name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (nothing < 0 || log < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(log, STDOUT_FILENO) < 0 ||
      dup2(log, STDERR_FILENO) < 0)
    _exit(static_cast<int>(ExitCode::system_failed));
  const ExitCode code = work();
  std::fflush(nullptr);
  _exit(static_cast<int>(code));
}

}  // namespace

LoggedProcess start_logged(const fs::path& folder, const std::string& what, const std::string& key,
                           const std::function<ExitCode()>& work) {
  int ends[2];
  if (pipe(ends) != 0)
    throw SystemFailure(fmt::format("no pipe to a {}: {}; lower {}", what, std::strerror(errno), key));
  fcntl(ends[0], F_SETFD, FD_CLOEXEC);
  fcntl(ends[1], F_SETFD, FD_CLOEXEC);
  std::fflush(nullptr);  // or the process would write it again
  const pid_t pid = fork();
  if (pid < 0) {
    close(ends[0]), close(ends[1]);
    throw SystemFailure(fmt::format("no process for a {}: {}; lower {}", what, std::strerror(errno), key));
  }
  if (pid == 0) {
    close(ends[0]);
    carry_out(folder, work);
  }
  close(ends[1]);
  return {pid, ends[0]};
}

std::vector<std::size_t> ended_of(const std::vector<LoggedProcess>& processes) {
  constexpr int milliseconds = 200;  // for a signal that came just before
  std::vector<pollfd> ends;
  for (const LoggedProcess& process : processes) ends.push_back({process.end, POLLIN, 0});
  std::vector<std::size_t> ended;
  if (poll(ends.data(), ends.size(), milliseconds) < 0) return ended;
  for (std::size_t i = ends.size(); i-- > 0;)
    if (ends[i].revents != 0) ended.push_back(i);
  return ended;
}

int status_of(const LoggedProcess& process) {
  int status = 0;
  while (waitpid(process.pid, &status, 0) < 0 && errno == EINTR) {
  }
  close(process.end);
  return status;
}

void give_up(const LoggedProcess& process) {
  kill(process.pid, SIGKILL);
  status_of(process);
}

std::string error_in_log(const fs::path& folder) {
  std::ifstream in(folder / log_name);
  std::string error;
  for (std::string line; std::getline(in, line);)
    if (!line.empty() && !line.starts_with("  ")) error = line;
  return error;
}

}  // namespace delf

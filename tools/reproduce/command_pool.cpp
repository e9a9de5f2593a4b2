// SPDX-License-Identifier: MIT
#include "tools/reproduce/command_pool.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "tools/files/text_file.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {

namespace {

using Clock = std::chrono::steady_clock;

struct PooledProcess {
  pid_t pid;
  std::size_t command;
  Clock::time_point begin;
};

// Everything that the process prints goes to run.log.
[[noreturn]] void be_a_command(const PooledCommand& command, ExitCode (*program)(const std::vector<std::string>&)) {
  setpgid(0, 0);  // Ctrl-C is the parent's
#ifdef __linux__
  prctl(PR_SET_PDEATHSIG, SIGKILL);  // and no command outlives it
#endif
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int nothing = open("/dev/null", O_RDONLY);
  const int log = open((command.folder / "run.log").c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0666);
  if (nothing < 0 || log < 0 || dup2(nothing, STDIN_FILENO) < 0 || dup2(log, STDOUT_FILENO) < 0 ||
      dup2(log, STDERR_FILENO) < 0)
    _exit(static_cast<int>(ExitCode::system_failed));
  const ExitCode code = program(command.words);
  std::fflush(nullptr);
  _exit(static_cast<int>(code));
}

PooledProcess begun(const PooledCommand& command, std::size_t number,
                    ExitCode (*program)(const std::vector<std::string>&)) {
  make_results_folder(command.folder);
  std::fflush(nullptr);  // or the process would write it again
  const pid_t pid = fork();
  if (pid < 0)
    throw SystemFailure(fmt::format("no process for a command: {}; lower reproduce.jobs", std::strerror(errno)));
  if (pid == 0) be_a_command(command, program);
  return {pid, number, Clock::now()};
}

}  // namespace

void carry_out_side_by_side(const std::vector<PooledCommand>& commands, int jobs,
                            ExitCode (*program)(const std::vector<std::string>&),
                            const std::function<void(std::size_t, int, double)>& ended) {
  constexpr useconds_t pause = 5000;
  constexpr int by_a_signal = 128;
  std::vector<PooledProcess> running;
  std::size_t next = 0;
  Progress progress(static_cast<std::int64_t>(commands.size()), "result");
  const auto give_up = [&] {
    for (const PooledProcess& process : running) {
      kill(process.pid, SIGKILL);
      while (waitpid(process.pid, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
  };
  try {
    while ((next < commands.size() || !running.empty()) && !Interrupt::asked()) {
      while (next < commands.size() && static_cast<int>(running.size()) < jobs)
        running.push_back(begun(commands[next], next, program)), ++next;
      for (std::size_t i = running.size(); i-- > 0;) {
        int status = 0;
        if (waitpid(running[i].pid, &status, WNOHANG) == 0) continue;
        const PooledProcess process = running[i];
        running.erase(running.begin() + static_cast<std::ptrdiff_t>(i));
        ended(process.command, WIFEXITED(status) ? WEXITSTATUS(status) : by_a_signal + WTERMSIG(status),
              seconds_since(process.begin));
      }
      progress.at(static_cast<std::int64_t>(next - running.size()));
      usleep(pause);
    }
  } catch (...) {
    give_up();
    throw;
  }
  give_up();
}

}  // namespace delf

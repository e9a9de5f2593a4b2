// SPDX-License-Identifier: MIT
#include "tools/reproduce/command_pool.hpp"

#include <sys/wait.h>

#include <chrono>

#include "tools/files/logged_process.hpp"
#include "tools/files/text_file.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {

void carry_out_side_by_side(const std::vector<PooledCommand>& commands, int jobs,
                            ExitCode (*program)(const std::vector<std::string>&),
                            const std::function<void(std::size_t, int, double)>& ended) {
  constexpr int by_a_signal = 128;
  struct Begun {
    std::size_t command;
    std::chrono::steady_clock::time_point begin;
  };
  std::vector<LoggedProcess> running;
  std::vector<Begun> begun;  // of each that is running
  std::size_t next = 0;
  Progress progress(static_cast<std::int64_t>(commands.size()), "result");
  const auto give_up_all = [&] {
    for (const LoggedProcess& process : running) give_up(process);
  };
  try {
    while ((next < commands.size() || !running.empty()) && !Interrupt::asked()) {
      for (; next < commands.size() && static_cast<int>(running.size()) < jobs; ++next) {
        const PooledCommand& command = commands[next];
        make_results_folder(command.folder);
        running.push_back(
            start_logged(command.folder, "command", "reproduce.jobs", [&] { return program(command.words); }));
        begun.push_back({next, std::chrono::steady_clock::now()});
      }
      for (const std::size_t i : ended_of(running)) {
        const auto place = static_cast<std::ptrdiff_t>(i);
        const LoggedProcess process = running[i];
        const Begun one = begun[i];
        running.erase(running.begin() + place), begun.erase(begun.begin() + place);
        const int status = status_of(process);
        ended(one.command, WIFEXITED(status) ? WEXITSTATUS(status) : by_a_signal + WTERMSIG(status),
              seconds_since(one.begin));
      }
      progress.at(static_cast<std::int64_t>(next - running.size()));
    }
  } catch (...) {
    give_up_all();
    throw;
  }
  give_up_all();
}

}  // namespace delf

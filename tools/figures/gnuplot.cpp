// SPDX-License-Identifier: MIT
#include "tools/figures/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "tools/figures/gnuplot_limit.hpp"
#include "tools/report/failure.hpp"

extern char** environ;

namespace delf {

namespace fs = std::filesystem;

ScratchFolder::ScratchFolder(const fs::path& parent) {
  std::string name = (parent / ".drawing-XXXXXX").string();
  if (!mkdtemp(name.data())) throw SystemFailure(fmt::format("{}: {}", name, std::strerror(errno)));
  path_ = name;
}

ScratchFolder::~ScratchFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

std::string run_gnuplot(const fs::path& folder, const std::string& script) {
  return run_gnuplot_within(std::chrono::minutes(2), folder, script);
}

std::string run_gnuplot_within(std::chrono::milliseconds limit, const fs::path& folder, const std::string& script) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "complaints", O_WRONLY | O_CREAT | O_TRUNC, 0600);
  posix_spawn_file_actions_adddup2(&actions, STDOUT_FILENO, STDERR_FILENO);
  std::string program = "gnuplot", option = "-d", argument = script;  // -d: no start-up files of the user
  char* arguments[] = {program.data(), option.data(), argument.data(), nullptr};
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "gnuplot", &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed == ENOENT || failed == EACCES)
    return "gnuplot is missing: install the package gnuplot-nox (or gnuplot) to have figures";
  if (failed) return fmt::format("gnuplot could not be started ({})", std::strerror(failed));

  int status = 0;
  const auto end = std::chrono::steady_clock::now() + limit;
  for (pid_t ended = 0; (ended = waitpid(child, &status, WNOHANG)) != child;) {
    if (ended < 0 && errno != EINTR) return fmt::format("gnuplot got lost ({})", std::strerror(errno));
    if (std::chrono::steady_clock::now() > end) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return fmt::format("gnuplot was ended: it took longer than {:.3g} s",
                         std::chrono::duration<double>(limit).count());
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFSIGNALED(status)) return fmt::format("gnuplot was ended by signal {}", WTERMSIG(status));
  std::ifstream complaints(folder / "complaints");
  std::string line, last;
  while (std::getline(complaints, line))
    if (line.find_first_not_of(" ^\t") != std::string::npos) last = line;
  return fmt::format("gnuplot could not draw ({})", last);
}

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

}  // namespace delf

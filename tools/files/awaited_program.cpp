// SPDX-License-Identifier: MIT
#include "tools/files/awaited_program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <sstream>
#include <thread>

#include "tools/files/started_program.hpp"
#include "tools/report/interrupt.hpp"

namespace delf {

std::string run_program(const AwaitedProgram& program, const std::filesystem::path& folder) {
  const std::string& name = program.words[0];
  const int complaints_file = open((folder / "complaints").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (complaints_file < 0) return fmt::format("{} could not be started ({})", name, std::strerror(errno));
  pid_t child = 0;
  const int failed = start_program(program.words, folder, complaints_file, complaints_file, child);
  close(complaints_file);
  if (failed == ENOENT || failed == EACCES) return program.if_missing;
  if (failed) return fmt::format("{} could not be started ({})", name, std::strerror(failed));

  int status = 0;
  const auto end = std::chrono::steady_clock::now() + program.limit;
  for (pid_t ended = 0; (ended = waitpid(child, &status, WNOHANG)) != child;) {
    if (ended < 0 && errno != EINTR) return fmt::format("{} got lost ({})", name, std::strerror(errno));
    const bool too_long = std::chrono::steady_clock::now() > end;
    if (too_long || (program.ends_with_us && Interrupt::asked())) {
      kill(child, SIGKILL);
      waitpid(child, &status, 0);
      return too_long ? fmt::format("{} was ended: it took longer than {:.3g} s", name,
                                    std::chrono::duration<double>(program.limit).count())
                      : fmt::format("{} was ended, as was asked for", name);
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return {};
  if (WIFSIGNALED(status)) return fmt::format("{} was ended by signal {}", name, WTERMSIG(status));
  std::ifstream complaints(folder / "complaints");
  std::string line, last;
  while (std::getline(complaints, line))
    if (line.find_first_not_of(" ^\t") != std::string::npos) last = line;
  return fmt::format("{} {} ({})", name, program.cannot, last);
}

bool is_installed(const std::string& program) {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path ? path : "/bin:/usr/bin");
  for (std::string folder; std::getline(folders, folder, ':');)
    if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0) return true;
  return false;
}

}  // namespace delf

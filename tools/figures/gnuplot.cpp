// SPDX-License-Identifier: MIT
#include "tools/figures/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <thread>

#include "tools/figures/gnuplot_limit.hpp"
#include "tools/files/started_program.hpp"
#include "tools/report/failure.hpp"

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
  const int complaints_file = open((folder / "complaints").c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
  if (complaints_file < 0) return fmt::format("gnuplot could not be started ({})", std::strerror(errno));
  pid_t child = 0;
  // -d: no start-up files of the user
  const int failed = start_program({"gnuplot", "-d", script}, folder, complaints_file, complaints_file, child);
  close(complaints_file);
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

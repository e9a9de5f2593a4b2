// SPDX-License-Identifier: MIT
#include "tools/figures/gnuplot.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "tools/figures/gnuplot_limit.hpp"
#include "tools/files/awaited_program.hpp"
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
  // -d: no start-up files of the user
  return run_program({{"gnuplot", "-d", script}, "could not draw", gnuplot_is_missing, limit}, folder);
}

std::string gnuplot_quoted(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? "''" : std::string(1, c == '\n' ? ' ' : c);
  return out + "'";
}

}  // namespace delf

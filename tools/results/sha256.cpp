// SPDX-License-Identifier: MIT
#include "tools/results/sha256.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <sstream>
#include <utility>

#include "lattice/index.hpp"
#include "tools/files/started_program.hpp"

namespace delf {

std::map<std::string, std::string> sha256_of(const std::filesystem::path& folder,
                                             const std::vector<std::string>& files) {
  int ends[2];
  if (files.empty() || pipe2(ends, O_CLOEXEC) != 0) return {};
  std::vector<std::string> words{"sha256sum", "--"};
  words.insert(words.end(), files.begin(), files.end());
  const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
  pid_t child = 0;
  const int failed = start_program(std::move(words), folder, ends[1], nowhere, child);
  close(nowhere);
  close(ends[1]);
  std::string text;
  char block[4096];
  for (ssize_t count; !failed && ((count = read(ends[0], block, sizeof block)) > 0 || (count < 0 && errno == EINTR));)
    if (count > 0) text.append(block, at(count));
  close(ends[0]);
  if (failed) return {};
  while (waitpid(child, nullptr, 0) < 0 && errno == EINTR) continue;

  std::map<std::string, std::string> sums;  // lines "SUM  NAME"; names that need quoting begin with a backslash
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);)
    if (line.size() > 66 && line.front() != '\\') sums[line.substr(66)] = line.substr(0, 64);
  return sums;
}

}  // namespace delf

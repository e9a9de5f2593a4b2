// SPDX-License-Identifier: MIT
#include "tools/page/sha256.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <sstream>

extern char** environ;

namespace delf {

std::map<std::string, std::string> sha256_of(const std::filesystem::path& folder,
                                             const std::vector<std::string>& files) {
  int ends[2];
  if (files.empty() || pipe2(ends, O_CLOEXEC) != 0) return {};
  std::vector<std::string> words{"sha256sum", "--"};
  words.insert(words.end(), files.begin(), files.end());
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, "sha256sum", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(ends[1]);
  std::string text;
  char block[4096];
  for (ssize_t count; !failed && ((count = read(ends[0], block, sizeof block)) > 0 || (count < 0 && errno == EINTR));)
    if (count > 0) text.append(block, static_cast<std::size_t>(count));
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

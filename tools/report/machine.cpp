// SPDX-License-Identifier: MIT
#include "tools/report/machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <thread>

namespace delf {

std::string machine_in_words() {
  static const std::string words = [] {
    std::ifstream file("/proc/cpuinfo");
    std::string processor = "unknown processor";
    for (std::string line; std::getline(file, line);)
      if (line.starts_with("model name")) {
        processor = line.substr(std::min(line.find(':') + 2, line.size()));
        break;
      }
    return fmt::format("{}, {} cores", processor, std::thread::hardware_concurrency());
  }();
  return words;
}

std::string compiler_in_words() {
#ifdef __clang__
  return "clang " __VERSION__ ", " DELF_FLAGS;
#else
  return "gcc " __VERSION__ ", " DELF_FLAGS;
#endif
}

}  // namespace delf

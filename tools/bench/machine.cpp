// SPDX-License-Identifier: MIT
#include "tools/bench/machine.hpp"

#include <fmt/format.h>

#include <fstream>
#include <string>
#include <thread>

#include "jets/simd/pack.hpp"

#ifndef DELF_BENCH_FLAGS
#define DELF_BENCH_FLAGS "unknown"
#endif
#ifndef DELF_BENCH_FAST_FLAGS
#define DELF_BENCH_FAST_FLAGS "unknown"
#endif
#ifndef DELF_VERSION
#define DELF_VERSION "unknown"
#endif

namespace delf::bench {

namespace {

std::string processor() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown processor";
}

#ifdef __clang__
constexpr const char* compiler = "clang " __VERSION__;
#else
constexpr const char* compiler = "gcc " __VERSION__;
#endif

}  // namespace

void print_machine() {
  fmt::print("machine   {}, {} cores, {} lanes\n", processor(), std::thread::hardware_concurrency(), lanes);
  fmt::print("compiler  {}\n", compiler);
  fmt::print("flags     {}; the auto-vectorised loop also {}\n", DELF_BENCH_FLAGS, DELF_BENCH_FAST_FLAGS);
  fmt::print("delf      {}\n\n", DELF_VERSION);
}

}  // namespace delf::bench

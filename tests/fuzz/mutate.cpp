// SPDX-License-Identifier: MIT
#include <sys/time.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "tests/fuzz/mutation.hpp"
#include "tests/fuzz/target.hpp"

// A target without libFuzzer: NAME [-runs=N] [-seed=S] [-bits=1] FOLDER…
//
// Each file of the folders as it is: those whose name begins with "wrong" are refused, the others read. Then they are changed
// at random N times, by bits alone with -bits=1. An exception that is no BadInput, a crash, or more than five seconds for one
// is a fault, and its bytes stay in fault.bytes; so is a target that refuses all, or reads all.
namespace {

namespace fs = std::filesystem;

constexpr const char* kept = "fault.bytes";
constexpr const char* usage =
    "usage: %s [-runs=N] [-seed=S] [-bits=1] FOLDER...\n"
    "Reads each file of the folders (tests/fuzz/seeds/NAME), then N random changes of them; a fault stays in "
    "fault.bytes.\n";

void keep(const std::string& bytes) { std::ofstream(kept, std::ios::binary) << bytes; }

const std::string* current = nullptr;

void ended_by(int signal) {
  // Not for other programs: what is called here may be in any state, and the process ends.
  const char* why = signal == SIGPROF || signal == SIGALRM ? "takes more than 5 s" : "crashes";
  std::fprintf(stderr, "%s: %s\n", kept, why);
  if (current) keep(*current);
  std::_Exit(1);
}

// So many seconds of this process, and twelve times as many on a busy machine; 0 ends the count.
void within(unsigned seconds) {
  const itimerval time{{0, 0}, {static_cast<time_t>(seconds), 0}};
  setitimer(ITIMER_PROF, &time, nullptr);
  alarm(12 * seconds);
}

// Whether the bytes are refused.
bool refuses(const std::string& bytes) {
  current = &bytes;
  within(5);
  bool refused = false;
  try {
    delf::fuzz::read_bytes(bytes);
  } catch (const delf::BadInput& bad) {
    refused = true;
    if (*bad.what() == '\0') std::fprintf(stderr, "%s: refused without a word\n", kept), keep(bytes), std::exit(1);
  } catch (const std::exception& other) {
    std::fprintf(stderr, "%s: %s\n", kept, other.what()), keep(bytes), std::exit(1);
  }
  within(0);
  return refused;
}

}  // namespace

int main(int count, char** arguments) {
  long runs = 1000, seed = 1, bits = 0;
  std::vector<std::pair<std::string, std::string>> seeds;  // names and bytes
  for (int n = 1; n < count; ++n) {
    const std::string_view argument = arguments[n];
    const auto number = [&](std::string_view name, long& value) {
      return argument.starts_with(name) && ((value = std::atol(arguments[n] + name.size())), true);
    };
    if (number("-runs=", runs) || number("-seed=", seed) || number("-bits=", bits)) continue;
    if (!fs::is_directory(argument)) {
      const bool help = argument == "--help" || argument == "-h";
      std::FILE* to = help ? stdout : stderr;
      if (!help) std::fprintf(to, "%s: no folder and no option\n", arguments[n]);
      std::fprintf(to, usage, fs::path(arguments[0]).filename().c_str());
      return help ? 0 : 2;
    }
    for (const auto& entry : fs::directory_iterator(argument)) {
      if (!entry.is_regular_file()) continue;
      std::ifstream in(entry.path(), std::ios::binary);
      seeds.emplace_back(entry.path().filename().string(), std::string(std::istreambuf_iterator<char>(in), {}));
    }
  }
  if (seeds.empty()) return std::fprintf(stderr, "no seeds: name folders of them\n"), 2;
  std::sort(seeds.begin(), seeds.end());
  for (const int signal : {SIGPROF, SIGALRM, SIGSEGV, SIGBUS, SIGFPE, SIGABRT, SIGILL}) std::signal(signal, ended_by);

  for (const auto& [name, bytes] : seeds)
    if (refuses(bytes) != name.starts_with("wrong"))
      return std::fprintf(stderr, "%s: the seed is %s\n", name.c_str(), name.starts_with("wrong") ? "read" : "refused"),
             1;
  delf::fuzz::Mutation mutation(static_cast<unsigned>(seed), bits != 0);
  long refused = 0;
  for (long n = 0; n < runs; ++n)
    if (refuses(mutation.of(seeds[static_cast<std::size_t>(n) % seeds.size()].second))) ++refused;
  std::printf("%zu seeds, %ld mutations, %ld of them refused\n", seeds.size(), runs, refused);
  return refused > 0 && refused < runs ? 0 : 1;
}

// SPDX-License-Identifier: MIT
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include "tools/command_line.hpp"
#include "tools/report/failure.hpp"

namespace {

bool returned = false;

// HDF5 ends the program where it has no memory for an identifier, with exit code 255 and no word.
void ended_by_a_library() {
  if (returned) return;
  std::fputs("delf: out of memory in a library, which ended the program; ask for fewer sites or records\n", stderr);
  _exit(static_cast<int>(delf::ExitCode::system_failed));
}

}  // namespace

int main(int count, char** words) {
  std::atexit(ended_by_a_library);
  auto code = delf::ExitCode::system_failed;
  try {
    code = delf::run_program({words + (count > 0 ? 1 : 0), words + count});
  } catch (const std::exception& error) {  // before run_program() can: no memory for the words themselves
    std::fputs("delf: out of memory\n", stderr);
    code = delf::exit_code(error);
  }
  returned = true;
  return static_cast<int>(code);
}

// SPDX-License-Identifier: MIT
#include <cstdio>
#include <exception>

#include "tools/command_line.hpp"
#include "tools/failure.hpp"

int main(int count, char** words) {
  try {
    return static_cast<int>(delf::run_program({words + (count > 0 ? 1 : 0), words + count}));
  } catch (const std::exception& error) {  // before run_program() can: no memory for the words themselves
    std::fputs("delf: out of memory\n", stderr);
    return static_cast<int>(delf::exit_code(error));
  }
}

// SPDX-License-Identifier: MIT
#include "tools/command_line.hpp"

int main(int count, char** words) {
  return static_cast<int>(delf::run_program({words + (count > 0 ? 1 : 0), words + count}));
}

// SPDX-License-Identifier: MIT
#include "tools/bench/command_line.hpp"

int main(int count, char** words) { return delf::bench::run({words + (count > 0 ? 1 : 0), words + count}); }

// SPDX-License-Identifier: MIT
#pragma once

namespace delf::bench {

/// What numbers depend on: the processor, the compiler, its flags, the version.
void print_machine();

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#pragma once

namespace delf::bench {

/// The conditions of a measurement: the processor, the compiler, its flags, the version.
void print_machine();

}  // namespace delf::bench

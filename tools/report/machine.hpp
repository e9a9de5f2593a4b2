// SPDX-License-Identifier: MIT
#pragma once
#include <string>

namespace delf {

/// The processor and its number of cores, in words.
std::string machine_in_words();
/// The compiler that this program was made by, and its flags, without those of warnings.
std::string compiler_in_words();

}  // namespace delf

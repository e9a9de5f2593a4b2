// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>

#include "lattice/error.hpp"
#include "tests/fuzz/target.hpp"

// A target under libFuzzer. Exceptions other than BadInput end the process, and libFuzzer keeps the bytes.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  try {
    delf::fuzz::read_bytes({reinterpret_cast<const char*>(bytes), size});
  } catch (const delf::BadInput& bad) {
    if (*bad.what() == '\0') __builtin_trap();  // refused without a word
  }
  return 0;
}

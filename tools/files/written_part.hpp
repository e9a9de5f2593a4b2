// SPDX-License-Identifier: MIT
#pragma once
#include <bit>
#include <cstdint>
#include <span>
#include <string_view>

namespace delf {

/// FNV-1a, h ← (h xor x)·p, of bytes or of the 64 bits of numbers: a change of any one of them changes it, in the time of a
/// product. It does not depend on the pieces in which they are added.
class Checksum {
 public:
  void add(std::string_view bytes) {
    for (const char c : bytes) add(std::uint64_t{static_cast<unsigned char>(c)});
  }
  void add(std::span<const double> numbers) {
    for (const double x : numbers) add(std::bit_cast<std::uint64_t>(x));
  }
  bool operator==(const Checksum&) const = default;

 private:
  void add(std::uint64_t x) { value_ = (value_ ^ x) * 0x100000001b3; }
  std::uint64_t value_ = 0xcbf29ce484222325;
};

/// The beginning of a file that a checkpoint counts on: so many bytes, or frames, and what they are.
struct WrittenPart {
  std::uint64_t size = 0;
  Checksum sum = {};
};

}  // namespace delf

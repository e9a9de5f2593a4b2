// SPDX-License-Identifier: MIT
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>
#include <random>
#include <string>

namespace delf::fuzz {

/// Random changes of bytes: of a bit, or, unless `bits_only`, of what hands and broken disks change.
class Mutation {
 public:
  Mutation(unsigned seed, bool bits_only) : random_(seed), bits_only_(bits_only) {}

  std::string of(std::string bytes) {
    if (bits_only_) {
      if (!bytes.empty()) flip(bytes, place(bytes.size() - 1));
      return bytes;
    }
    for (std::size_t n = 1 + place(2); n > 0; --n) {
      const std::size_t at = place(bytes.size()), length = std::min(bytes.size() - at, 1 + place(40));
      switch (place(5)) {
        case 0:
          if (at < bytes.size()) flip(bytes, at);
          break;
        case 1:
          bytes.erase(at, length);
          break;
        case 2:
          bytes.insert(place(bytes.size()), bytes.substr(at, length));
          break;
        case 3:
          if (place(3) == 0) bytes.resize(at);
          break;
        case 4:
          if (at < bytes.size()) bytes[at] = static_cast<char>(place(255));
          break;
        default:
          bytes.insert(at, words[place(words.size() - 1)]);
      }
    }
    return bytes;
  }

 private:
  static constexpr std::array words{"1e999",      "-1", "0", "nan", "inf", "=", "[", "]", "\n", "#",  "1e-320",
                                    "2147483648", ",",  "x", ":",   "(",   "^", "*", "/", "'",  "\r", ";"};
  std::size_t place(std::size_t most) { return random_() % (most + 1); }
  void flip(std::string& bytes, std::size_t at) { bytes[at] = static_cast<char>(bytes[at] ^ (1 << place(7))); }

  std::mt19937 random_;
  bool bits_only_;
};

}  // namespace delf::fuzz

// SPDX-License-Identifier: MIT
#pragma once
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace delf {

enum class KeyType { real, integer, toggle, choice, text, times };

/// The numbers that a key may take: low ≤ value ≤ high, or low < value where the lower end is open.
struct Limits {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open = false;
};

/// A key of a scene: how its value is read, what it means, and what holds when it is not given.
struct Key {
  std::string_view name;  ///< "lattice.sites"
  KeyType type;
  std::string_view fallback;   ///< the value in force when the key is not given, if there is one
  std::string_view otherwise;  ///< if there is none: what holds then, in words
  std::string_view meaning;
  std::string_view unit = {};
  Limits range = {};
  std::vector<std::string> (*choices)() = nullptr;
};

/// Every key, in the order of the sections. Parsing, `delf help run`, the scene.ini of a run and the suggestions for
/// unknown keys are all made from this table.
std::span<const Key> keys();
/// The key of that name, or null.
const Key* find_key(std::string_view name);
/// The key that an unknown name was probably meant to be, or an empty string.
std::string nearest_key(std::string_view unknown);

}  // namespace delf

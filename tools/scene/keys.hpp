// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

enum class KeyType { real, integer, toggle, choice, text, times };

/// A key of a scene: how its value is read, what it means, and what holds when it is not given.
struct Key {
  std::string name;  ///< "lattice.sites"
  KeyType type;
  std::string fallback;   ///< the value in force when the key is not given, if there is one
  std::string otherwise;  ///< if there is none: what holds then, in words
  std::string meaning;
  std::string unit = {};
  Limits range = {};
  std::vector<std::string> choices = {};
};

/// "lattice" of "lattice.sites": a view of the name that is given.
constexpr std::string_view section_of(std::string_view name) { return name.substr(0, name.find('.')); }

/// The key that a parameter is.
Key key_of(const Parameter&);

/// Every key in the order of the sections, those that theories, methods and states declare at the end of theirs. Parsing,
/// `delf help run`, the scene.ini of a run and the suggestions for unknown keys are all made from this table.
std::span<const Key> keys();
/// The key of that name, as the first that declares it does; or null.
const Key* find_key(std::string_view name);
/// The key that an unknown name was probably meant to be, or an empty string.
std::string nearest_key(std::string_view unknown, std::span<const Key> known);
/// Puts the key behind the last one of its section, or in place of the one of its name.
void insert_key(std::vector<Key>& table, Key);

/// scene: by a scene for itself, as measure.NAME.
enum class DeclaredBy { theory, method, state, scene };
/// The key whose value is the name: theory.name, scheme.method, initial.state; there is none for a scene.
std::string_view chosen_by(DeclaredBy);

/// A theory, a method or a state with the keys that it declares.
struct Declaration {
  DeclaredBy kind;
  std::string_view name;
  std::span<const Parameter> parameters;
};
std::vector<Declaration> declarations();
/// The names of those that declare the key.
std::vector<std::string> declared_by(std::string_view key);

}  // namespace delf

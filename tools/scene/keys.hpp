// SPDX-License-Identifier: MIT
#pragma once
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "schemes/parameter.hpp"

namespace delf {

enum class KeyType { real, integer, toggle, choice, text };
/// The type of a key, from its fallback and its choices.
KeyType type_of(const Parameter&);
/// The text in force when the key is not given; empty where there is none.
std::string fallback_of(const Parameter&);

/// "lattice" of "lattice.sites": a view of the name that is given.
constexpr std::string_view section_of(std::string_view name) { return name.substr(0, name.find('.')); }

/// Every key in the order of the sections, those that theories, methods and states declare at the end of theirs. Parsing,
/// `delf help run`, the scene.ini of a run and the suggestions for unknown keys are all made from this table.
std::span<const Parameter> keys();
/// The key of that name, as the first that declares it does; or null.
const Parameter* find_key(std::string_view name);
/// The key that an unknown name was probably meant to be, or an empty string.
std::string nearest_key(std::string_view unknown, std::span<const Parameter> known);
/// Puts the key behind the last one of its section, or in place of the one of its name.
void insert_key(std::vector<Parameter>& table, Parameter);

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

// SPDX-License-Identifier: MIT
#include "tools/scene/keys.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "lattice/nearest_name.hpp"
#include "schemes/declared.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/scene/program_keys.hpp"

namespace delf {

namespace {

using Names = std::vector<std::string>;

std::vector<Parameter> all_keys() {
  std::vector<Parameter> table = scene_keys();
  std::ranges::move(command_keys(), std::back_inserter(table));
  for (const Declaration& declaration : declarations())
    for (const Parameter& p : declaration.parameters) {
      if (const auto known = std::ranges::find(table, p.key, &Parameter::key); known != table.end()) {
        // each of several methods has its own choices (Values::known): the table lists all of them
        for (const std::string& name : p.choices)
          if (std::ranges::find(known->choices, name) == known->choices.end()) known->choices.push_back(name);
        continue;
      }
      Parameter key = p;
      const Names owners = declared_by(p.key);
      if (declaration.kind == DeclaredBy::method)
        key.help = fmt::format("method = {}: {}", fmt::join(owners, " or "), key.help);
      if (declaration.kind == DeclaredBy::state && owners.size() == 1)
        key.help = fmt::format("state = {}: {}", owners.front(), key.help);
      if (declaration.kind == DeclaredBy::state && owners.size() > 1) key.otherwise = states_own;  // each has its own
      insert_key(table, std::move(key));
    }
  return table;
}

const std::vector<Parameter>& table() {
  static const std::vector<Parameter> keys = all_keys();
  return keys;
}

}  // namespace

KeyType type_of(const Parameter& key) {
  if (std::holds_alternative<double>(key.fallback)) return KeyType::real;
  if (std::holds_alternative<int>(key.fallback)) return KeyType::integer;
  return key.choices.empty() ? KeyType::text : key.choices == on_or_off ? KeyType::toggle : KeyType::choice;
}

std::string fallback_of(const Parameter& key) { return key.otherwise.empty() ? to_text(key.fallback) : std::string(); }

std::span<const Parameter> keys() { return table(); }

const Parameter* find_key(std::string_view name) {
  const auto key = std::ranges::find(table(), name, &Parameter::key);
  return key == table().end() ? nullptr : &*key;
}

std::string_view chosen_by(DeclaredBy kind) {
  if (kind == DeclaredBy::scene) return {};
  return kind == DeclaredBy::theory ? "theory.name" : kind == DeclaredBy::method ? "scheme.method" : "initial.state";
}

std::vector<Declaration> declarations() {
  std::vector<Declaration> all;
  for (const TheoryEntry* entry : theory_entries()) all.push_back({DeclaredBy::theory, entry->name, entry->parameters});
  for (const MethodEntry* entry : method_entries()) all.push_back({DeclaredBy::method, entry->name, entry->parameters});
  for (const StateEntry* entry : state_entries()) all.push_back({DeclaredBy::state, entry->name, entry->parameters});
  return all;
}

std::vector<std::string> declared_by(std::string_view key) {
  Names names;
  for (const Declaration& declaration : declarations())
    if (std::ranges::find(declaration.parameters, key, &Parameter::key) != declaration.parameters.end())
      names.emplace_back(declaration.name);
  return names;
}

void insert_key(std::vector<Parameter>& table, Parameter key) {
  if (const auto same = std::ranges::find(table, key.key, &Parameter::key); same != table.end()) {
    *same = std::move(key);
    return;
  }
  const auto last = std::find_if(table.rbegin(), table.rend(),
                                 [&](const Parameter& k) { return section_of(k.key) == section_of(key.key); });
  table.insert(last == table.rend() ? table.end() : last.base(), std::move(key));
}

std::string nearest_key(std::string_view unknown, std::span<const Parameter> known) {
  // without its section, or with a wrong one, a key is known by its last part: --sites, lattice.position
  const auto last = [](std::string_view name) { return name.substr(name.rfind('.') + 1); };
  Names full, same_last;
  for (const Parameter& key : known) {
    full.emplace_back(key.key);
    if (last(key.key) == last(unknown)) same_last.emplace_back(key.key);
  }
  if (const auto close = nearest(unknown, full)) return *close;
  if (!same_last.empty()) return same_last.front();
  Names lasts;
  for (const Parameter& key : known) lasts.emplace_back(last(key.key));
  const auto close = nearest(last(unknown), lasts);
  const auto at = close ? std::find(lasts.begin(), lasts.end(), *close) : lasts.end();
  return at == lasts.end() ? std::string() : full[at - lasts.begin()];
}

}  // namespace delf

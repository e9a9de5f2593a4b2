// SPDX-License-Identifier: MIT
#include "tools/scene/declared_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/stencil_text.hpp"
#include "lattice/error.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/scene/keys.hpp"
#include "tools/scene/program_keys.hpp"

namespace delf {
namespace {

// A section of names that a scene is free to choose.
bool is_measure(std::string_view key) { return key.starts_with("measure.") && key != "measure."; }

// Keys that no theory, method or state declares are not to be redefined.
void declare(Settings& settings, const Parameter& p, DeclaredBy kind, const std::string& owner) {
  if (find_key(p.key) && declared_by(p.key).empty())
    throw BadScene(fmt::format("{}: {} has a meaning already; choose another name in the theory",
                               settings.file().string(), p.key));
  settings.declare({p, kind, owner});
}

const TheoryEntry* chosen_theory(Settings& settings) {
  const std::string name(chosen_by(DeclaredBy::theory));
  for (const TheoryEntry* entry : theory_entries())
    for (const std::string& key : entry->chosen_by) {
      if (!settings.find(key)) continue;
      if (const Setting* given = settings.find(name); given && given->value != entry->name)
        settings.keep_one_of(name, key, {});
      if (settings.find(key)) settings.imply(name, entry->name, key);
    }
  const Setting* given = settings.find(name);
  const auto at = std::ranges::find(theory_entries(), given ? given->value : fallback_of(*find_key(name)),
                                    [](const TheoryEntry* entry) { return entry->name; });
  return at == theory_entries().end() ? nullptr : *at;  // whoever reads theory.name says so
}

// Reads what the settings give; numbers that cannot be read are left to whoever reads them.
void read(const Settings& settings, const Parameter& p, ParameterValues& values) {
  const Setting* given = settings.find(p.key);
  if (!given) return;
  if (std::holds_alternative<std::string>(p.fallback)) values[p.key] = given->value;
  if (!std::holds_alternative<double>(p.fallback)) return;
  try {
    values[p.key] = number_of(given->value, p.key);
  } catch (const BadInput&) {
  }
}

std::vector<std::string> declare_theory(Settings& settings, const TheoryEntry& entry) {
  ParameterValues values;
  if (entry.further) {
    for (const Parameter& p : entry.parameters) read(settings, p, values);
    for (const Parameter& p : entry.further(values)) {
      declare(settings, p, DeclaredBy::theory, entry.name);
      read(settings, p, values);
    }
  }
  std::vector<std::string> fields;
  const auto theory = make_theory(entry, values);
  for (const Component& field : theory->fields()) fields.push_back(field.name);
  return fields;
}

/// A key that several states read, such as initial.p, takes the place of none.
bool is_shared_by_states(const std::string& key) {
  return std::ranges::any_of(state_entries(), [&](const StateEntry* entry) {
    return std::ranges::count(entry->parameters, key, &Parameter::key) > 0;
  });
}

void declare_states(Settings& settings, const std::vector<std::string>& fields) {
  const std::string name(chosen_by(DeclaredBy::state));
  for (const StateEntry* entry : state_entries()) {
    if (!entry->further) continue;
    for (const Parameter& p : entry->further(fields)) {
      declare(settings, p, DeclaredBy::state, entry->name);
      const Setting *given = settings.find(p.key), *other = settings.find(name);
      if (!given || (other && is_shared_by_states(p.key))) continue;
      // the command line wins, as it does for keys of one name
      if (other && other->value != entry->name && given->line == 0 && other->line != 0)
        settings.keep_one_of(name, p.key, {});
      settings.imply(name, entry->name, p.key);
    }
  }
}

// measure.NAME: one line each, of any name
void declare_measures(Settings& settings) {
  std::vector<std::string> names;
  for (const Setting& s : settings.all())
    if (is_measure(s.key) && std::ranges::find(names, s.key) == names.end()) names.push_back(s.key);
  for (const std::string& name : names)
    settings.declare({{.key = name,
                       .fallback = "",
                       .help = "an expression of measurements; see `delf help measures`",
                       .otherwise = "none"},
                      DeclaredBy::scene,
                      {}});
}

constexpr std::string_view of_boundary = "boundary.";

/// boundary.NAME on a mesh; which parts there are is known once the mesh is read.
void declare_parts(Settings& settings) {
  const Setting* const space = settings.find("lattice.space");
  if (!space || space->value != "complex") return;
  const std::vector<Setting> all(settings.all().begin(), settings.all().end());
  for (const Setting& s : all)
    if (s.key.starts_with(of_boundary) && !settings.key(s.key))
      settings.declare({{.key = s.key,
                         .fallback = "",
                         .help = "the part of this name of a mesh's boundary: see boundary.mesh",
                         .choices = {"fixed", "natural", "periodic:PART", formula_choice},
                         .otherwise = "as boundary.mesh"},
                        DeclaredBy::scene,
                        {}});
}

}  // namespace

void declare_keys(Settings& settings) {
  declare_measures(settings);
  declare_parts(settings);
  try {
    if (settings.find("stencil.sites")) settings.imply("lattice.stencil", stencil_as_text, "stencil.sites");
    if (const TheoryEntry* entry = chosen_theory(settings)) declare_states(settings, declare_theory(settings, *entry));
  } catch (const BadInput& bad) {
    throw settings.located(bad);
  }
}

bool may_be_declared(std::string_view key) {
  return std::ranges::any_of(theory_entries(),
                             [key](const TheoryEntry* e) { return e->further && key.starts_with("theory."); }) ||
         is_measure(key) || key.starts_with(of_boundary) || key.starts_with("initial.") || key.starts_with("exact.");
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "schemes/state.hpp"

namespace delf {

/// The space that a state can live in: a circle; a circle or an interval; a line; a point; or any.
enum class Place { circle, interval, line, point, anywhere };

struct StateEntry;

/// The arguments that a state is built from.
struct StateBuild {
  const StateEntry& entry;
  const StateRequest& request;
  const Lattice& lattice;
  ParameterValues values;  ///< in force: those of the request, and the fallbacks of the entry
  bool exact;              ///< the entry names the theory as one whose field equation the state solves

  double number(std::string_view key) const { return values.get<double>(key); }
  double number(std::string_view key, double otherwise) const { return values.maybe<double>(key).value_or(otherwise); }
  double mass() const { return number("theory.mass", 1); }
  double lambda() const { return number("theory.lambda", 1); }
};

/// A state that a scene can name by initial.state: a constant of this type stands at the end of each file in
/// schemes/states/.
struct StateEntry {
  std::string name;
  std::string formula;
  std::vector<Parameter> parameters;     ///< that it reads
  std::vector<std::string> exact;        ///< theories whose field equation it solves
  std::vector<std::string> approximate;  ///< other theories that may start from it
  Place place;
  /// Called for a theory and a place that fit, with finite values. Null: the rows are read from initial.file.
  std::unique_ptr<State> (*build)(const StateBuild&);
  bool any_theory = false;            ///< every theory may start from it …
  std::vector<std::string> but = {};  ///< … but these
  /// The length over which the narrowest pulse changes, as it moves: 1/(γm) for a kink of sine-Gordon. Null: no pulses.
  double (*width)(const StateBuild&) = nullptr;
  /// Parameters that belong to fields of these names; null: none. Where a scene gives one of them, and no initial.state, the
  /// state is chosen by that.
  std::vector<Parameter> (*further)(const std::vector<std::string>& fields) = nullptr;
  std::vector<std::string> sources = {};  ///< the solution or the data, as keys of tools/cite/references.bib
};

/// All that it reads from fields of these names.
std::vector<Parameter> parameters_of(const StateEntry&, const std::vector<std::string>& fields);

/// All states, the built-in ones first: a new state adds one line there.
const std::vector<const StateEntry*>& state_entries();
/// Adds a state of a program's own, before the first scene is read; the entry must outlive all use.
void register_state(const StateEntry&);
/// Throws BadInput, with the nearest name, if there is none of that name.
const StateEntry& find_state(const std::string& name);
/// The width of a state that make_state() makes, as its entry declares it; infinite for what has no pulses.
double width_of(const StateRequest&, const Lattice&);
/// "sine-gordon, phi4; approximately: sine-gordon-impurity"
std::string theories_in_words(const StateEntry&);

}  // namespace delf

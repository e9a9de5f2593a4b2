// SPDX-License-Identifier: MIT
#include "schemes/states/state_registry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/nearest_name.hpp"
#include "schemes/declared.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/states/parameters.hpp"

namespace delf {

extern const StateEntry mps_collision_state, kink_state, antikink_state, kink_antikink_state, kink_kink_state,
    kink_gas_state, soliton_bounce_state, two_soliton_bounce_state, breather_state, kink_train_state, plane_wave_state,
    wave_packet_state, kepler_orbit_state, pendulum_swing_state, coupled_kinks_state, coupled_breathers_state,
    charged_wave_state, charged_packet_state, great_circle_state, spherical_swing_state, solar_system_state,
    point_state, noise_state, formula_state, rows_of_file_state;

namespace {

std::vector<const StateEntry*>& registry() {
  // clang-format off
  static std::vector<const StateEntry*> entries{
      &mps_collision_state,
      &kink_state,
      &antikink_state,
      &kink_antikink_state,
      &kink_kink_state,
      &kink_gas_state,
      &soliton_bounce_state,
      &two_soliton_bounce_state,
      &breather_state,
      &kink_train_state,
      &plane_wave_state,
      &wave_packet_state,
      &kepler_orbit_state,
      &pendulum_swing_state,
      &coupled_kinks_state,
      &coupled_breathers_state,
      &charged_wave_state,
      &charged_packet_state,
      &great_circle_state,
      &spherical_swing_state,
      &solar_system_state,
      &point_state,
      &noise_state,
      &formula_state,
      &rows_of_file_state,
  };
  // clang-format on
  return entries;
}

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

bool holds(const std::vector<std::string>& names, const std::string& name) {
  return std::ranges::find(names, name) != names.end();
}

bool belongs_to(const StateEntry& entry, const std::string& theory) {
  return (entry.any_theory && !holds(entry.but, theory)) || holds(entry.exact, theory) ||
         holds(entry.approximate, theory);
}

void check_place(const StateEntry& entry, const Lattice& lattice, const std::string& what) {
  const bool at_a_point = lattice.space() == Space::point;
  if (entry.place == Place::circle && !lattice.is_circle())
    throw BadInput("initial.state", what + "goes around a circle; use lattice.space=circle");
  if (entry.place == Place::interval && lattice.space() != Space::interval)
    throw BadInput("initial.state", what + "bounces off walls; use lattice.space=interval");
  if (entry.place == Place::line && at_a_point)
    throw BadInput("initial.state", what + "has an extent in space; use lattice.space=circle or interval");
  if (entry.place == Place::point && !at_a_point)
    throw BadInput("initial.state", what + "has no extent in space; use lattice.space=point");
}

// Every number that the scene gives must be one, whether the state reads it or not.
void check_finite(const ParameterValues& values) {
  for (const auto& [key, value] : values)
    if (const double* number = std::get_if<double>(&value); number && !std::isfinite(*number))
      throw BadInput(key, key + " = " + initial::text(*number) + ": not a finite number; choose a finite one");
}

StateBuild build_of(const StateEntry& entry, const StateRequest& request, const Lattice& lattice) {
  StateBuild build{entry, request, lattice, request.values, holds(entry.exact, request.theory)};
  check_finite(build.values);
  complete(build.values, parameters_of(entry, request.fields));
  return build;
}

}  // namespace

const std::vector<const StateEntry*>& state_entries() { return registry(); }

void register_state(const StateEntry& entry) { registry().push_back(&entry); }

std::vector<Parameter> parameters_of(const StateEntry& entry, const std::vector<std::string>& fields) {
  std::vector<Parameter> all = entry.parameters;
  if (entry.further)
    for (Parameter& p : entry.further(fields)) all.push_back(std::move(p));
  return all;
}

const StateEntry& find_state(const std::string& name) {
  std::vector<std::string> known;
  for (const StateEntry* entry : state_entries()) {
    if (entry->name == name) return *entry;
    known.push_back(entry->name);
  }
  const auto near = nearest(name, known);
  throw BadInput("initial.state", "initial.state = " + name + ": no such state; " +
                                      (near ? "did you mean " + *near + "?" : "choose one of " + joined(known)));
}

std::string theories_in_words(const StateEntry& entry) {
  if (entry.any_theory) return entry.but.empty() ? "any" : "any but " + joined(entry.but);
  if (entry.approximate.empty() || entry.exact.empty()) return joined(entry.exact) + joined(entry.approximate);
  return joined(entry.exact) + "; approximately: " + joined(entry.approximate);
}

double width_of(const StateRequest& request, const Lattice& lattice) {
  const StateEntry& entry = find_state(request.name);
  return entry.width ? entry.width(build_of(entry, request, lattice)) : std::numeric_limits<double>::infinity();
}

std::unique_ptr<State> make_state(const StateRequest& request, const Lattice& lattice) {
  const StateEntry& entry = find_state(request.name);
  const std::string what = "initial.state = " + request.name + ": ";
  if (!entry.build) throw std::logic_error(what + "not made here but read from initial.file");
  if (!belongs_to(entry, request.theory))
    throw BadInput("initial.state",
                   what + "not a state of " + request.theory + "; it belongs to " + theories_in_words(entry));
  check_place(entry, lattice, what);

  auto state = entry.build(build_of(entry, request, lattice));
  if (lattice.is_circle() && request.winding && *request.winding != state->winding())
    throw BadInput("boundary.winding", "boundary.winding = " + std::to_string(*request.winding) + ": the state " +
                                           request.name + " winds " + std::to_string(state->winding()) +
                                           " times; set boundary.winding=" + std::to_string(state->winding()));
  if (lattice.is_circle() && gain_of(request.values) != 0 && !entry.further)
    throw BadInput("boundary.gain", "boundary.gain = " + initial::text(gain_of(request.values)) + ": the state " +
                                        request.name +
                                        " gains nothing beside its winding; leave it out, or give the field by a "
                                        "formula or a file");
  return state;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/theory_registry.hpp"

#include "jets/scaled_density.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/unknown_name.hpp"

namespace delf {

extern const TheoryEntry wave_theory, klein_gordon_theory, sine_gordon_theory, phi4_theory, double_sine_gordon_theory,
    sine_gordon_impurity_theory, pendulum_theory, kepler_theory, coupled_sine_gordon_theory,
    complex_klein_gordon_theory, wave_map_theory, harmonic_oscillator_theory, henon_heiles_theory,
    double_pendulum_theory, spherical_pendulum_theory, solar_system_theory, lotka_volterra_theory,
    point_vortices_theory, two_vortices_theory, charged_particle_theory, guiding_centre_theory, text_theory;

namespace {

std::vector<const TheoryEntry*>& entries() {
  static std::vector<const TheoryEntry*> all{&wave_theory,
                                             &klein_gordon_theory,
                                             &sine_gordon_theory,
                                             &phi4_theory,
                                             &double_sine_gordon_theory,
                                             &sine_gordon_impurity_theory,
                                             &coupled_sine_gordon_theory,
                                             &complex_klein_gordon_theory,
                                             &wave_map_theory,
                                             &pendulum_theory,
                                             &kepler_theory,
                                             &harmonic_oscillator_theory,
                                             &henon_heiles_theory,
                                             &double_pendulum_theory,
                                             &spherical_pendulum_theory,
                                             &solar_system_theory,
                                             &lotka_volterra_theory,
                                             &point_vortices_theory,
                                             &two_vortices_theory,
                                             &charged_particle_theory,
                                             &guiding_centre_theory,
                                             &text_theory};
  return all;
}

}  // namespace

Parameter mass_parameter() {
  return {.key = "theory.mass",
          .fallback = 1.0,
          .help = "m, where a theory has one",
          .unit = "1/length",
          .range = {.low = 0}};
}
Parameter lambda_parameter() {
  return {.key = "theory.lambda", .fallback = 1.0, .help = "the second coupling, where a theory has one"};
}

const std::vector<const TheoryEntry*>& theory_entries() { return entries(); }
void register_theory(const TheoryEntry& entry) { entries().push_back(&entry); }

const TheoryEntry& find_theory(const std::string& name) { return find_entry(theory_entries(), "theory.name", name); }

std::vector<Parameter> parameters_of(const TheoryEntry& entry, const ParameterValues& values) {
  std::vector<Parameter> all = entry.parameters;
  if (entry.further)
    for (Parameter& p : entry.further(values)) all.push_back(std::move(p));
  return all;
}

// Makes the theory in the units of theory.speed and theory.scale, if they are given.
std::unique_ptr<FieldTheory> make_theory(const TheoryEntry& entry, ParameterValues given) {
  complete(given, parameters_of(entry, given));
  auto theory = entry.make(given);
  const double speed = given.maybe<double>("theory.speed").value_or(1),
               scale = given.maybe<double>("theory.scale").value_or(1);
  if (speed == 1 && scale == 1) return theory;
  if (theory->constraint())
    throw BadInput("theory.scale",
                   "theory.speed, theory.scale: for theories without constraints, which have units of "
                   "their own; leave it out");
  return std::make_unique<FieldTheory>(std::make_shared<ScaledDensity>(theory->shared_density(), speed, scale), nullptr,
                                       theory->fields());
}

}  // namespace delf

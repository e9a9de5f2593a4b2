// SPDX-License-Identifier: MIT
#include <algorithm>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/nearest_name.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"

namespace delf {
namespace {

using Names = std::vector<std::string>;
using Builder = std::unique_ptr<State> (*)(const StateRequest&, const Lattice&);

/// Where a state can live: on a circle, or also between walls; at a point; or it does not matter.
enum class Place { circle, line, point, anywhere };

struct Entry {
  std::string name, formula, parameters;
  Names exact;        ///< theories whose field equation it solves
  Names approximate;  ///< theories that may start from it
  Place place;
  Builder build;            ///< null: read elsewhere
  bool any_theory = false;  ///< every theory may start from it …
  Names but{};              ///< … but these
};

const std::vector<Entry>& table() {
  const Names sine_gordon{"sine-gordon"}, impurity{"sine-gordon-impurity"}, none{};
  const Names kinks{"sine-gordon", "double-sine-gordon", "phi4"};
  const Names linear{"wave", "klein-gordon"}, nonlinear{"sine-gordon", "double-sine-gordon", "sine-gordon-impurity"};
  const Names kepler{"kepler"}, pendulum{"pendulum"}, coupled{"coupled-sine-gordon"};
  const Names charged{"complex-klein-gordon"}, sphere{"wave-map"};
  static const std::vector<Entry> entries{
      {"mps-collision",
       "phi~(x - c t) | 2 pi | 2 pi - phi~(x - 3L/4 + c t) on the first, middle two and last quarters of the circle, "
       "phi~ = pi + 2 am(P (x - L/8)/(L/4); 1 - epsilon)",
       "epsilon (1e-6)", none, sine_gordon, Place::circle, initial::mps_collision},
      {"kink",
       "4 atan exp(m s), s = gamma (x - x0 - v t); phi4: tanh(sqrt(lambda/2) s); double-sine-gordon: "
       "2 arccot(-(m/mu) sinh(mu s)), mu^2 = m^2 + 2 lambda",
       "position (L/2), speed (0)", kinks, impurity, Place::line, initial::kink},
      {"antikink", "the kink with s = -gamma (x - x0 - v t)", "position (L/2), speed (0)", kinks, impurity, Place::line,
       initial::antikink},
      {"kink-antikink", "4 atan(sinh(gamma m (v t - d/2))/(v cosh(gamma m (x - x0))))",
       "position (L/2), speed (0.5), separation d (L/4)", sine_gordon, impurity, Place::line, initial::kink_antikink},
      {"kink-kink", "4 atan(v sinh(gamma m (x - x0))/cosh(gamma m (v t - d/2)))",
       "position (L/2), speed (0.5), separation d (L/4)", sine_gordon, impurity, Place::line, initial::kink_kink},
      {"breather",
       "4 atan(eta cos(omega t')/(omega cosh(eta x'))), eta^2 = m^2 - omega^2, t' = gamma (t - v (x - x0)), "
       "x' = gamma (x - x0 - v t)",
       "position (L/2), speed (0), frequency omega (0.6 m)", sine_gordon, impurity, Place::line, initial::breather},
      {"kink-train", "pi + 2 am(2 K (x - x0 - v t)/l; kappa), l = L/|winding|, m l = 2 kappa K sqrt(1 - v^2)",
       "position (L/2), speed, or else epsilon = 1 - kappa (1e-6), boundary.winding (1)", sine_gordon, none,
       Place::circle, initial::kink_train},
      {"plane-wave",
       "A cos(q (x - x0) - omega t), q = 2 pi n/L, omega^2 = q^2 + m^2; between walls the standing mode n times "
       "cos(omega t)",
       "amplitude (1 if the theory is linear, else 0.1), wavenumber n (1), position (0)", linear, nonlinear,
       Place::line, initial::plane_wave},
      {"wave-packet", "A exp(-s^2/2w^2) cos(2 pi n s/L), s = x - x0, each mode with its own omega",
       "amplitude (1 if the theory is linear, else 0.1), width w (L/20), wavenumber n (8), position (L/2)", linear,
       nonlinear, Place::circle, initial::wave_packet},
      {"kepler-orbit", "(cos E - e, sqrt(1 - e^2) sin E), E - e sin E = t", "eccentricity e (0.6)", kepler, none,
       Place::point, initial::kepler_orbit},
      {"pendulum-swing", "2 asin(k sn(K + m t; k)), k = sin(A/2)", "amplitude A (2)", pendulum, none, Place::point,
       initial::pendulum_swing},
      {"coupled-kinks", "the sine-Gordon kink in both components; with a separation d, at x0 - d/2 and x0 + d/2",
       "position x0 (L/2), speed (0), separation d (0; else exact only if lambda = 0)", coupled, none, Place::line,
       initial::coupled_kinks},
      {"coupled-breathers",
       "the sine-Gordon breather in both components; with a separation d, at x0 - d/2 and x0 + d/2",
       "position x0 (L/2), speed (0), frequency (0.6 m), separation d (0; else exact only if lambda = 0)", coupled,
       none, Place::line, initial::coupled_breathers},
      {"charged-wave", "A exp(i(q x - omega t)), q = 2 pi n/L, omega^2 = q^2 + m^2 + lambda A^2",
       "amplitude (1), wavenumber n (1)", charged, none, Place::circle, initial::charged_wave},
      {"charged-packet", "A exp(-s^2/2w^2) exp(i(q s - omega t)), s = x - x0, q = 2 pi n/L, omega^2 = q^2 + m^2",
       "amplitude (0.1), width w (L/20), wavenumber n (8), position (L/2)", none, charged, Place::circle,
       initial::charged_packet},
      {"great-circle",
       "cos(alpha) e1 + sin(alpha) e2, alpha = A cos(q (x - t)) + (A/2) sin(2 q x) cos(2 q t), q = 2 pi n/L, e1 and e2 "
       "fixed and orthogonal",
       "amplitude (1), wavenumber n (1)", sphere, none, Place::circle, initial::great_circle},
      {"noise",
       "a sum of M smooth modes of random amplitude and phase, scaled to max |phi| = A in each component",
       "amplitude (0.1), wavenumber M (8), run.seed (1)",
       none,
       none,
       Place::line,
       initial::noise,
       true,
       {"kepler", "wave-map"}},  // singular at 0; not on the sphere
      {"file", "rows read from a file", "file", none, none, Place::anywhere, nullptr, true}};
  return entries;
}

std::string joined(const Names& names) {
  std::string line;
  for (const std::string& name : names) line += (line.empty() ? "" : ", ") + name;
  return line;
}

// "sine-gordon, phi4; approximately: sine-gordon-impurity"
std::string theories_of(const Entry& entry) {
  if (entry.any_theory) return entry.but.empty() ? "any" : "any but " + joined(entry.but);
  if (entry.approximate.empty() || entry.exact.empty()) return joined(entry.exact) + joined(entry.approximate);
  return joined(entry.exact) + "; approximately: " + joined(entry.approximate);
}

bool belongs_to(const Entry& entry, const std::string& theory) {
  const auto holds = [&](const Names& names) { return std::find(names.begin(), names.end(), theory) != names.end(); };
  return (entry.any_theory && !holds(entry.but)) || holds(entry.exact) || holds(entry.approximate);
}

const Entry& find(const std::string& name) {
  Names known;
  for (const Entry& entry : table()) {
    if (entry.name == name) return entry;
    known.push_back(entry.name);
  }
  const auto near = nearest(name, known);
  throw BadInput("initial.state", "initial.state = " + name + ": no such state; " +
                                      (near ? "did you mean " + *near + "?" : "choose one of " + joined(known)));
}

void check_place(const Entry& entry, const Lattice& lattice, const std::string& what) {
  const bool at_a_point = lattice.space() == Space::point;
  if (entry.place == Place::circle && !lattice.is_circle())
    throw BadInput("initial.state", what + "goes around a circle; use lattice.space=circle");
  if (entry.place == Place::line && at_a_point)
    throw BadInput("initial.state", what + "has an extent in space; use lattice.space=circle or interval");
  if (entry.place == Place::point && !at_a_point)
    throw BadInput("initial.state", what + "has no extent in space; use lattice.space=point");
}

// Every number that the scene gives must be one, whether the state reads it or not.
void check_finite(const StateRequest& r) {
  initial::finite("theory.mass", r.mass, 1);
  initial::finite("theory.lambda", r.lambda, 1);
  initial::finite("initial.position", r.position, 0);
  initial::finite("initial.speed", r.speed, 0);
  initial::finite("initial.separation", r.separation, 0);
  initial::finite("initial.frequency", r.frequency, 0);
  initial::finite("initial.wavenumber", r.wavenumber, 0);
  initial::finite("initial.amplitude", r.amplitude, 0);
  initial::finite("initial.epsilon", r.epsilon, 0);
  initial::finite("initial.width", r.width, 0);
  initial::finite("initial.eccentricity", r.eccentricity, 0);
}

}  // namespace

std::unique_ptr<State> make_state(const StateRequest& request, const Lattice& lattice) {
  const Entry& entry = find(request.name);
  const std::string what = "initial.state = " + request.name + ": ";
  if (!entry.build) throw std::logic_error(what + "not made here but read from initial.file");
  if (!belongs_to(entry, request.theory))
    throw BadInput("initial.state",
                   what + "not a state of " + request.theory + "; it belongs to " + theories_of(entry));
  check_place(entry, lattice, what);

  check_finite(request);
  auto state = entry.build(request, lattice);
  if (lattice.is_circle() && request.winding && *request.winding != state->winding())
    throw BadInput("boundary.winding", "boundary.winding = " + std::to_string(*request.winding) + ": the state " +
                                           request.name + " winds " + std::to_string(state->winding()) +
                                           " times; set boundary.winding=" + std::to_string(state->winding()));
  return state;
}

const std::vector<StateInfo>& states() {
  static const std::vector<StateInfo> list = [] {
    std::vector<StateInfo> infos;
    for (const Entry& e : table()) infos.push_back({e.name, e.formula, e.parameters, theories_of(e)});
    return infos;
  }();
  return list;
}

}  // namespace delf

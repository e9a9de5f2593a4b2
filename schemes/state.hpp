// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"

namespace delf {

/// What a scene says of its initial state; a quantity that is not given takes the state's own default.
struct StateRequest {
  std::string name;               ///< as in `delf list states`
  std::string theory;             ///< theory.name
  double mass = 1;                ///< theory.mass
  double lambda = 1;              ///< theory.lambda
  int components = 1;             ///< of the theory's field
  std::optional<double> position, speed, separation, frequency, wavenumber, amplitude, epsilon, width, eccentricity;
  std::optional<int> winding;     ///< boundary.winding, if the scene gives it
  std::uint64_t seed = 1;         ///< run.seed
};

/// A field φ(t, x) and its velocity φ_t(t, x) to start from and, where it solves the field equation, to compare with.
/// A field of d components is written site by site: out[i·d + a]. Values are unwrapped: on a circle
/// φ(t, x + L) = φ(t, x) + 2π·winding, and a pulse that goes round keeps counting.
class State {
 public:
  virtual ~State() = default;
  /// d
  virtual int components() const { return 1; }
  /// φ(t, x_i) at every site.
  virtual void values(double t, const Lattice&, std::span<double> out) const = 0;
  /// φ_t(t, x_i) at every site.
  virtual void velocities(double t, const Lattice&, std::span<double> out) const = 0;
  /// values() solves the theory's field equation at all times, so that errors can be measured against it.
  virtual bool exact() const = 0;
  /// The last time at which values() can be compared with: later the tail of a pulse is above 1e-2 at a wall, or at the
  /// seam of a circle, where it would meet its own image. Infinity for waves and pulses that go round; 0 if not exact.
  virtual double exact_until() const { return exact() ? std::numeric_limits<double>::infinity() : 0.0; }
  /// values() at t = h is a second row to start from (always so when exact; also for the paper's collision).
  virtual bool knows_second_row() const { return exact(); }
  /// (φ(x + L) − φ(x))/2π, the same for every component
  virtual int winding() const { return 0; }
  /// One line for reports: formula, source, the parameters in force.
  virtual std::string description() const = 0;
};

/// Throws BadInput naming the key: an unknown state (with the nearest known name), a state that the theory does not
/// have or the space does not allow, |v| ≥ 1, a frequency outside (0, m), an eccentricity outside [0, 1), a winding
/// that is not the state's own, a wave that the sites do not resolve. Throws std::logic_error for `file`, which is read
/// elsewhere.
std::unique_ptr<State> make_state(const StateRequest&, const Lattice&);

struct StateInfo {
  std::string name, formula, parameters, theories;
};
/// Every state make_state knows, for `delf list states`.
const std::vector<StateInfo>& states();

}  // namespace delf

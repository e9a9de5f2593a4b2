// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "lattice/lattice.hpp"
#include "schemes/parameter.hpp"

namespace delf {

/// The initial state as a scene asks for it; a parameter that is not given takes the state's own default.
struct StateRequest {
  std::string name;                 ///< as in `delf list states`
  std::string theory;               ///< theory.name
  ParameterValues values = {};      ///< initial.KEY as given, and theory.KEY; a mass or lambda that is not here is 1
  int components = 1;               ///< of the theory's field
  std::vector<std::string> fields = {"phi"};  ///< their names
  std::optional<int> winding = {};  ///< boundary.winding, if the scene gives it
  std::uint64_t seed = 1;           ///< run.seed
  /// The theory's velocities of given momenta, ∂ℓ/∂q̇(q, q̇) = p; nothing where there are none. Asked by states that are
  /// given by momenta.
  std::function<std::optional<std::vector<double>>(std::span<const double> q, std::span<const double> p)> velocity_of =
      {};
};

/// One component of a field at one point of spacetime.
struct FieldPoint {
  double phi = 0, phi_t = 0, phi_x = 0;
};

/// A field φ(t, x) with its first derivatives, to start from and, where it solves the field equation, to compare with.
/// Values are unwrapped: on a circle φ(t, x + L) = φ(t, x) + 2π·winding, and a pulse that goes round keeps counting.
class State {
 public:
  virtual ~State() = default;
  /// d
  virtual int components() const { return 1; }
  /// φ, φ_t and φ_x of every component, out[a], at any point x; at any time too where the state is exact.
  virtual void at(double t, double x, std::span<FieldPoint> out) const = 0;
  /// φ(t, x_i) at every site, out[i·d + a].
  virtual void values(double t, const Lattice&, std::span<double> out) const;
  /// φ_t(t, x_i) at every site.
  virtual void velocities(double t, const Lattice&, std::span<double> out) const;
  /// at() solves the theory's field equation at all times, so that errors can be measured against it.
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
/// that is not the state's own, a wave that the sites do not resolve. Throws std::logic_error for a state that is read
/// from a file.
std::unique_ptr<State> make_state(const StateRequest&, const Lattice&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <vector>

#include "schemes/simulation.hpp"
#include "schemes/stability/symbol.hpp"

namespace delf {

struct CourantInterval {
  double from = 0, to = 0;
};

/// A mode of the scheme that grows without an amplification factor outside the unit circle.
struct GhostMode {
  double theta = 0;
  std::complex<double> z;
  std::string words;
};

/// The linear stability of a scheme about φ = 0, from its symbol.
struct LinearTheory {
  std::vector<CourantInterval> stable;  ///< Courant numbers, in order, up to the most that was asked for
  std::vector<GhostMode> ghosts;        ///< in the middle of the first of them

  /// The beginning of the first instability from below: 0 if nothing is stable, infinity if everything is up to `most`.
  double first_limit(double most) const;
  bool is_stable(double courant) const;
  /// No end of an interval is nearer than `relative` of it.
  bool is_clear(double courant, double relative) const;
};

/// theory.mass, or 1 if the problem has none.
inline double mass_of(const Problem& p) { return p.parameters.maybe<double>("theory.mass").value_or(1); }

/// The small waves that a scheme is tried on, by its Courant number.
struct LinearWaves {
  Problem scheme;
  std::optional<double> mass_step;  ///< mh of klein-gordon; none: those of its own theory about φ = 0

  /// On a circle of `sites`. Of klein-gordon with h = 1, k = 1/courant and m = mass_step, so that mh stays as the Courant
  /// number changes; of its own theory at the scheme's own k.
  Problem on_circle(double courant, int sites) const;
  /// "mh = 0.5" or "k = 0.1".
  std::string in_words() const;
};

/// The stable Courant numbers in (0, most], from `samples` of them, and the ghosts in the middle of the first
/// interval. Throws BadInput for a scheme that cannot be built, or has no symbol.
LinearTheory linear_theory(const LinearWaves&, double most, int samples = 120);

/// The wave that grows most at one Courant number: its θ, and |z|.
struct WorstWave {
  double theta = 0, amplification = 1;
  /// log |z|: what a step adds to log |φ|. 0 if nothing grows, infinite where a step has no solution.
  double rate() const { return amplification > 1 ? std::log(amplification) : 0; }
};

/// The growth of a scheme's waves at one Courant number: of any length, and those of a circle of N sites, θ = 2πj/N.
/// Throws as linear_theory.
class WaveGrowth {
 public:
  WaveGrowth(const LinearWaves&, double courant);

  const WorstWave& of_all() const { return worst_; }
  WorstWave on_circle(int sites) const;
  /// The number of sites, of least, least + stride, … most, whose circle has a wave near enough to the worst of all for
  /// its growth to show with the fewest updates of a site (steps × sites).
  int best_circle(int least, int most, int stride) const;

 private:
  WorstWave nearest(int sites) const;  ///< of a circle's waves to the worst of all

  Symbol symbol_;
  WorstWave worst_;
};

struct FrequencyPoint {
  double wave_number;  ///< qk
  double numerical;    ///< ωk of the scheme
  double exact;        ///< √((qk)² + (mk)²)
};
/// The dispersion relation of a scheme of klein-gordon, at `count` wave numbers from 0 to the largest that its nodes
/// resolve. Throws as linear_theory.
std::vector<FrequencyPoint> frequencies(const Problem& scheme, double courant, double mass_space_step, int count);

}  // namespace delf

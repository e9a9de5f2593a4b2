// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/stability/linear_theory.hpp"

namespace delf {

/// The growth of noise of size 1e-8: none beyond rounding, linear in the number of steps, exponential, or the scheme
/// cannot be stepped.
enum class Growth { bounded, linear, exponential, refused };
const char* to_string(Growth);

struct ObservedGrowth {
  Growth kind = Growth::bounded;
  double rate = 0;     ///< of log |φ| from step to step, over the second half
  std::string reason;  ///< why it was refused
  bool stable() const { return kind == Growth::bounded || kind == Growth::linear; }
};

/// True if the waves can be stepped on a circle of so many sites: bricks close on an even number only.
bool closes_on(const LinearWaves&, int sites);

/// Steps from random rows and compares the largest |φ| of the second and of the fourth quarter of the run.
ObservedGrowth observe_growth(const Problem&, int steps, std::uint64_t seed);

/// Runs at one Courant number, compared with theory.
struct Probe {
  double courant = 0;
  bool theory_stable = false;  ///< for waves of any length
  Growth observed = Growth::bounded;
  int sites = 0, steps = 0;  ///< of the run that grew most
  double growth = 0;         ///< log |z|, by theory, of the worst wave that this run's circle has
  bool resolved = true;      ///< false: see Unresolved
};

/// A wave that grows by theory, and so slowly, or is so far from those of any circle that is not too large, that no run
/// of LimitRequest::work could tell.
struct Unresolved {
  double courant = 0;
  double theta = 0, growth = 0;  ///< of the worst of all waves: its θ and log |z|
  int sites = 0;                 ///< of the circle on which it would take least
  double steps = 0;              ///< that it would take there; infinite: that circle has no wave that grows
};

/// The stability limit of a scheme for some waves, by theory and by running.
struct Limit {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scheme;
  std::optional<double> mass_step;              ///< mh of klein-gordon; none: of its own theory
  std::string waves;                            ///< LinearWaves::in_words()
  double theory = unknown, observed = unknown;  ///< Courant numbers; infinite: none up to the most examined
  LinearTheory symbol;
  std::vector<Probe> probes;               ///< runs that were compared with theory
  std::vector<Unresolved> unresolved;      ///< Courant numbers at which no run can decide
  bool limit_unresolved = false;           ///< observed is above theory, and all that lies between is unresolved
  std::optional<Growth> even, odd;         ///< inside the first interval, on N and N − 1 sites
  std::string left_out;                    ///< why there is none of it, or empty
  std::vector<std::string> disagreements;  ///< in words

  bool agrees() const { return disagreements.empty(); }
};

struct LimitRequest {
  double most = 3;  ///< Courant numbers up to here
  int sites = 64;   ///< even; N − 1 is run too where the scheme allows it
  int steps = 2000;
  double work = 200;         ///< sites × steps of a run for a wave known to grow: at most so many times the above
  double agreement = 0.01;   ///< relative, of limits
  int samples = 120;         ///< of theory, in Courant numbers
  int grid = 24;             ///< Courant numbers to run at, besides those that theory makes interesting
  double theory_factor = 1;  ///< a fault: theory's intervals times this
  double waves_factor = 1;   ///< a fault: theory's waves are those of Courant numbers divided by this
  std::uint64_t seed = 1;

  /// log |z| of a wave of the circle of `sites` that takes all the work to be seen. Slower ones are unresolved.
  double least_growth() const;
};

/// Runs upwards from small Courant numbers, bisects the first instability to 0.3 %, and tries the middle of every
/// interval of theory. Runs are on N and N − 1 sites. Where theory has a growing wave that they do not show, a further
/// run is on the circle that suits this wave best, for as many steps as its |z| requires, up to `work`. Each run is
/// compared with theory for the waves of its own circle. Disagreements are reported, not thrown.
Limit find_limit(const std::string& name, const LinearWaves&, const LimitRequest&);

/// Compares runs with given intervals.
Limit compare_with_runs(const std::string& name, const LinearWaves&, const LinearTheory& intervals,
                        const LimitRequest&);

}  // namespace delf

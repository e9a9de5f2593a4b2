// SPDX-License-Identifier: MIT
#pragma once
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "tools/linear_theory.hpp"

namespace delf {

/// How noise of size 1e-8 fares: stays within what rounding makes of it, grows like the number of steps, grows like a
/// power of it, or cannot be stepped.
enum class Growth { bounded, linear, exponential, refused };
const char* to_string(Growth);

struct ObservedGrowth {
  Growth kind = Growth::bounded;
  double rate = 0;     ///< of log |φ| from step to step, over the second half
  std::string reason;  ///< why it was refused
  bool stable() const { return kind == Growth::bounded || kind == Growth::linear; }
};

/// Steps from random rows and looks at the largest |φ| of the second and of the fourth quarter of the run.
ObservedGrowth observe_growth(const Problem&, int steps, std::uint64_t seed);

/// A run at one Courant number, against what theory says of it.
struct Probe {
  double courant = 0;
  bool theory_stable = false;
  Growth observed = Growth::bounded;
};

/// The stability limit of a scheme at one mh, by theory and by running.
struct Limit {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::string scheme;
  double mass_step = 0;
  double theory = unknown, observed = unknown;  ///< Courant numbers; infinite: none up to the most looked at
  LinearTheory symbol;
  std::vector<Probe> probes;               ///< runs that were compared with theory
  std::optional<Growth> even, odd;         ///< inside the first interval, on N and N − 1 sites
  std::string left_out;                    ///< why there is none of it, or empty
  std::vector<std::string> disagreements;  ///< in words

  bool agrees() const { return disagreements.empty(); }
};

struct LimitRequest {
  double most = 3;  ///< Courant numbers up to here
  int sites = 64;   ///< even; N − 1 is run too where the scheme allows it
  int steps = 2000;
  double agreement = 0.01;   ///< relative, of limits
  double theory_factor = 1;  ///< a fault: theory's Courant numbers times this
  std::uint64_t seed = 1;
};

/// Runs upwards from small Courant numbers, bisects the first instability to 0.3 %, and looks into the middle of every
/// interval that theory has. Disagreements are told, not thrown.
Limit find_limit(const std::string& name, const Problem& scheme, double mass_step, const LimitRequest&);

}  // namespace delf

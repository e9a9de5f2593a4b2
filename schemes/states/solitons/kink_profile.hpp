// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>

#include "schemes/states/state_registry.hpp"

namespace delf::initial {

/// A kink at rest, centred at 0: f″ = −N′(f), rising from one vacuum to the next, f′ = √(−2N(f)).
class KinkProfile {
 public:
  virtual ~KinkProfile() = default;
  virtual double f(double s) const = 0;
  virtual double slope(double s) const = 0;
  /// The distance to the vacuum is C·e^{−rate·|s|} far away.
  virtual double tail_factor() const = 0;
  virtual double tail_rate() const = 0;
  /// f(+∞)
  virtual double upper() const = 0;
  /// Two of them are a solution in closed form, and pass through each other.
  virtual bool integrable() const { return false; }
  /// f(s), as a report writes it, with its parameters.
  virtual std::string formula() const = 0;
};

/// The profile of sine-gordon, double-sine-gordon or phi4. Throws BadInput for a mass or lambda without a kink.
std::unique_ptr<KinkProfile> kink_profile(const StateBuild&);

}  // namespace delf::initial

// SPDX-License-Identifier: MIT
#include "schemes/states/solitons/train_profile.hpp"

#include <boost/math/tools/toms748_solve.hpp>
#include <cmath>
#include <cstdint>
#include <string>

#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

// κK(κ) grows with κ from 0 to ∞; the modulus where it is `target`, sought in z = ln(κ²/κ′²).
constexpr double z_least = -700, z_most = 1400;

double modulus_times_K(double z) {
  const Jacobi j = Jacobi::from_logit(z);
  return j.modulus() * j.K();
}

Jacobi with_modulus_times_K(double target) {
  const auto f = [target](double z) { return std::log(modulus_times_K(z) / target); };
  std::uintmax_t iterations = 200;
  const auto [lower, upper] =
      boost::math::tools::toms748_solve(f, z_least, z_most, boost::math::tools::eps_tolerance<double>(52), iterations);
  return Jacobi::from_logit((lower + upper) / 2);
}

}  // namespace

double TrainProfile::phi(double xi) const {
  // am(u + 2K) = am(u) + π
  const double n = std::round(xi / period), u = 2 * jacobi.K() * (xi - n * period) / period;
  return std::numbers::pi + 2 * (jacobi.am(u) + n * std::numbers::pi);
}

double TrainProfile::slope(double xi) const {
  const double n = std::round(xi / period), u = 2 * jacobi.K() * (xi - n * period) / period;
  return 2 * jacobi.dn(jacobi.am(u)) * 2 * jacobi.K() / period;
}

TrainProfile TrainProfile::from_epsilon(double epsilon, double period, double mass) {
  if (!(epsilon > 0 && epsilon < 1))
    throw BadInput("initial.epsilon",
                   "initial.epsilon = " + text(epsilon) + ": the modulus is 1 - epsilon; choose 0 < epsilon < 1");
  const Jacobi jacobi = Jacobi::from_epsilon(epsilon);
  // v = √(1 − (mΛ/2κK)²)                                                        Marsden–Patrick–Shkoller §5.2
  const double r = mass * period / (2 * jacobi.modulus() * jacobi.K());
  if (!(r < 1)) {
    std::string message =
        "initial.epsilon = " + text(epsilon) + ": such kinks fit no period as long as " + text(period);
    // at rest κK = mΛ/2 and ε = κ′²/(1 + κ)
    if (mass * period / 2 < 350) {
      const Jacobi rest = with_modulus_times_K(mass * period / 2);
      const double most = rest.complementary_modulus() * rest.complementary_modulus() / (1 + rest.modulus());
      message += "; choose epsilon < " + text(most) + ", or a shorter lattice.length";
    } else {
      message += "; choose a shorter lattice.length";
    }
    throw BadInput("initial.epsilon", message);
  }
  return {jacobi, period, std::sqrt((1 - r) * (1 + r))};
}

TrainProfile TrainProfile::from_speed(double speed, double period, double mass) {
  // κK = mΛ/(2√(1 − v²))
  const double target = mass * period * lorentz_factor(speed) / 2;
  if (!(target > modulus_times_K(z_least) && target < modulus_times_K(z_most)))
    throw BadInput("initial.speed", "initial.speed = " + text(speed) + ": with a period of " + text(period) +
                                        " each kink is alone; use initial.state=kink, or a shorter lattice.length");
  return {with_modulus_times_K(target), period, speed};
}

}  // namespace delf::initial

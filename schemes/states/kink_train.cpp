// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstddef>
#include <numbers>

#include "lattice/error.hpp"
#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/train_profile.hpp"

namespace delf::initial {
namespace {

/// n kinks (n < 0: antikinks) side by side around a circle: φ = π ± 2 am(2K(x − x₀ − vt)/Λ; κ), Λ = L/|n|.
class KinkTrain final : public State {
 public:
  KinkTrain(TrainProfile profile, int winding, double position, double mass)
      : train_(profile), winding_(winding), sign_(winding < 0 ? -1 : 1), position_(position), mass_(mass) {}

  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i) {
      const double phi = train_.phi(lattice.position(i) - position_ - train_.speed * t);
      out[static_cast<std::size_t>(i)] = sign_ > 0 ? phi : 2 * std::numbers::pi - phi;
    }
  }
  // φ_t = −v φ_x
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] =
          -sign_ * train_.speed * train_.slope(lattice.position(i) - position_ - train_.speed * t);
  }
  bool exact() const override { return true; }
  int winding() const override { return winding_; }
  std::string description() const override {
    const Jacobi& j = train_.jacobi;
    return std::string("kink-train: phi = pi ") + (sign_ > 0 ? "+" : "-") +
           " 2 am(2 K (x - x0 - v t)/period; kappa), period = " + text(train_.period) + ", x0 = " + text(position_) +
           ", v = " + text(train_.speed) + ", m = " + text(mass_) +
           ", 1 - kappa = " + text(j.complementary_modulus() * j.complementary_modulus() / (1 + j.modulus())) +
           ", winding = " + std::to_string(winding_);
  }

 private:
  TrainProfile train_;
  int winding_;
  double sign_, position_, mass_;
};

}  // namespace

std::unique_ptr<State> kink_train(const StateRequest& request, const Lattice& lattice) {
  const int n = request.winding.value_or(1);
  if (n == 0)
    throw BadInput("boundary.winding", "boundary.winding = 0: a train has at least one kink; choose 1, -1, 2, ...");
  if (std::abs(static_cast<double>(n)) > lattice.sites() / 2)
    throw BadInput("boundary.winding", "boundary.winding = " + std::to_string(n) + ": " +
                                           std::to_string(lattice.sites()) + " sites resolve at most " +
                                           std::to_string(lattice.sites() / 2) + " kinks; raise lattice.sites");
  const double m = pulse_mass(request), period = lattice.length() / std::abs(static_cast<double>(n));
  const TrainProfile profile =
      request.speed ? TrainProfile::from_speed(subluminal(request, 0, "kink"), period, m)
                    : TrainProfile::from_epsilon(finite("initial.epsilon", request.epsilon, 1e-6), period, m);
  return std::make_unique<KinkTrain>(profile, n, centre(request, lattice), m);
}

}  // namespace delf::initial

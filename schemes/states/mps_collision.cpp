// SPDX-License-Identifier: MIT
#include <cstddef>
#include <cstdint>
#include <numbers>

#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/train_profile.hpp"

namespace delf::initial {
namespace {

/// The collision of Marsden–Patrick–Shkoller §5.2: one kink of a train of period L/4 on the first quarter of the
/// circle, its mirror image on the last, the vacuum 2π between. With x̄ = L − x and each soliton translated exactly,
///
///     φ̃(x − ct − L/8)   on [0, L/4),     2π   on [L/4, 3L/4),     φ̃(x̄ − ct − L/8)   on [3L/4, L)
///
/// where φ̃ is centred at 0; the paper writes the last as 2π − φ̃(x − 3L/4 + ct), which is the same. It solves no
/// field equation: there is a corner at each quarter.
class MpsCollision final : public State {
 public:
  MpsCollision(TrainProfile profile, double epsilon, double mass) : train_(profile), epsilon_(epsilon), mass_(mass) {}

  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] = outside(lattice, i) ? train_.phi(xi(t, lattice, i)) : 2 * std::numbers::pi;
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    for (int i = 0; i < lattice.sites(); ++i)
      out[static_cast<std::size_t>(i)] = outside(lattice, i) ? -train_.speed * train_.slope(xi(t, lattice, i)) : 0.0;
  }
  bool exact() const override { return false; }
  bool knows_second_row() const override { return true; }
  std::string description() const override {
    return "mps-collision (Marsden-Patrick-Shkoller 5.2): a kink pi + 2 am(P (x - c t - L/8)/(L/4); kappa) on the "
           "first "
           "quarter, its mirror image on the last, 2 pi between; 1 - kappa = " +
           text(epsilon_) + ", P = " + text(2 * train_.jacobi.K()) + ", c = " + text(train_.speed) +
           ", m = " + text(mass_);
  }

 private:
  // branches by integers: 4i < N, 4i < 3N
  static bool in_first_quarter(const Lattice& lattice, int i) { return std::int64_t{4} * i < lattice.sites(); }
  static bool outside(const Lattice& lattice, int i) {
    return in_first_quarter(lattice, i) || std::int64_t{4} * i >= std::int64_t{3} * lattice.sites();
  }
  // x − ct − L/8, or x̄ − ct − L/8: sites i and N − i agree to the bit
  double xi(double t, const Lattice& lattice, int i) const {
    const double x = lattice.position(in_first_quarter(lattice, i) ? i : lattice.sites() - i);
    return x - train_.period / 2 - train_.speed * t;
  }

  TrainProfile train_;
  double epsilon_, mass_;
};

}  // namespace

std::unique_ptr<State> mps_collision(const StateRequest& request, const Lattice& lattice) {
  const double m = pulse_mass(request), epsilon = finite("initial.epsilon", request.epsilon, 1e-6);
  return std::make_unique<MpsCollision>(TrainProfile::from_epsilon(epsilon, lattice.length() / 4, m), epsilon, m);
}

}  // namespace delf::initial

// SPDX-License-Identifier: MIT

#include <array>

#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

constexpr std::size_t coordinates = 18;  // three of each body

// Positions and velocities relative to the Sun on 5 September 1994, at 0h00, in astronomical units and days: Hairer, Lubich
// and Wanner, Geometric Numerical Integration, I.2.4, after Ahnerts Kalender für Sternfreunde 1994.
constexpr std::array<double, coordinates> q{0,           0,           0,            // the Sun
                                            -3.5023653,  -3.8169847,  -1.5507963,   // Jupiter
                                            9.0755314,   -3.0458353,  -1.6483708,   // Saturn
                                            8.3101420,   -16.2901086, -7.2521278,   // Uranus
                                            11.4707666,  -25.7294829, -10.8169456,  // Neptune
                                            -15.5387357, -25.2225594, -3.1902382};  // Pluto
constexpr std::array<double, coordinates> v{0,          0,           0,             //
                                            0.00565429, -0.00412490, -0.00190589,   //
                                            0.00168318, 0.00483525,  0.00192462,    //
                                            0.00354178, 0.00137102,  0.00055029,    //
                                            0.00288930, 0.00114527,  0.00039677,    //
                                            0.00276725, -0.00170702, -0.00136504};

/// The planets as they were; where they go is for a scheme to find.
class Planets final : public State {
 public:
  int components() const override { return coordinates; }
  void at(double t, double, std::span<FieldPoint> out) const override {
    for (std::size_t a = 0; a < coordinates; ++a) out[a] = {q[a] + t * v[a], v[a], 0};
  }
  bool exact() const override { return false; }
  std::string description() const override {
    return "solar-system: the Sun and the outer planets on 5 September 1994, relative to the Sun";
  }
};

std::unique_ptr<State> planets(const StateBuild&) { return std::make_unique<Planets>(); }

}  // namespace
}  // namespace initial

extern const StateEntry solar_system_state;
const StateEntry solar_system_state{.name = "solar-system",
                                    .formula = "the Sun and the outer planets on 5 September 1994",
                                    .parameters = {},
                                    .exact = {},
                                    .approximate = {"solar-system"},
                                    .place = Place::point,
                                    .build = initial::planets,
                                    .sources = {"hairer-lubich-wanner-2006"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>
#include <vector>

#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {

extern const StateEntry kink_state, breather_state;

namespace initial {
namespace {

/// A pulse of sine-Gordon in each of two components. Where both are the same, sin(φ₁ − φ₂) = 0 and the coupling does
/// nothing: the pair then solves the coupled equations as each solves its own.
class CoupledPair final : public State {
 public:
  CoupledPair(std::unique_ptr<State> first, std::unique_ptr<State> second, bool solves, std::string line)
      : first_(std::move(first)), second_(std::move(second)), exact_(solves), description_(std::move(line)) {}

  int components() const override { return 2; }
  void at(double t, double x, std::span<FieldPoint> out) const override {
    first_->at(t, x, out.first(1));
    second_->at(t, x, out.subspan(1, 1));
  }
  bool exact() const override { return exact_ && first_->exact() && second_->exact(); }
  double exact_until() const override {
    return exact() ? std::min(first_->exact_until(), second_->exact_until()) : 0.0;
  }
  int winding() const override { return first_->winding(); }
  std::string description() const override { return description_; }

 private:
  std::unique_ptr<State> first_, second_;
  bool exact_;
  std::string description_;
};

std::unique_ptr<State> coupled(const StateBuild& build, const StateEntry& one) {
  const double x0 = centre(build), d = build.number("initial.separation");
  const auto pulse = [&](double position) {
    StateBuild alone{one, build.request, build.lattice, build.values, true};
    alone.values["initial.position"] = position;
    return one.build(alone);
  };
  auto first = pulse(x0 - d / 2), second = pulse(x0 + d / 2);
  const bool solves = d == 0 || build.lambda() == 0;
  std::string line = build.request.name + ", ";
  if (d == 0) line += "both components: " + first->description();
  else line += "first component: " + first->description() + "; second component: " + second->description();
  if (!solves) line += "; together not an exact solution of " + build.request.theory;
  return std::make_unique<CoupledPair>(std::move(first), std::move(second), solves, std::move(line));
}

Parameter separation() {
  Parameter p = separation_parameter();
  p.help += "; other than 0, exact only if lambda = 0";
  return p;
}

}  // namespace
}  // namespace initial

extern const StateEntry coupled_kinks_state;
const StateEntry coupled_kinks_state{
    .name = "coupled-kinks",
    .formula = "the sine-Gordon kink in both components; with a separation d, at x0 - d/2 and x0 + d/2",
    .parameters = {initial::position_parameter(), initial::speed_parameter(0), initial::separation()},
    .exact = {"coupled-sine-gordon"},
    .approximate = {},
    .place = Place::line,
    .build = [](const StateBuild& build) { return initial::coupled(build, kink_state); },
    .width = [](const StateBuild& build) { return kink_state.width(build); },
    .sources = {"delf"}};

extern const StateEntry coupled_breathers_state;
const StateEntry coupled_breathers_state{
    .name = "coupled-breathers",
    .formula = "the sine-Gordon breather in both components; with a separation d, at x0 - d/2 and x0 + d/2",
    .parameters = {initial::position_parameter(), initial::speed_parameter(0), initial::frequency_parameter(),
                   initial::separation()},
    .exact = {"coupled-sine-gordon"},
    .approximate = {},
    .place = Place::line,
    .build = [](const StateBuild& build) { return initial::coupled(build, breather_state); },
    .width = [](const StateBuild& build) { return breather_state.width(build); },
    .sources = {"delf"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/states/momenta.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

/// A body at q with the velocity v, which would go on in a straight line; where it goes is for a scheme to find.
class Point final : public State {
 public:
  Point(std::vector<double> q, std::vector<double> v) : q_(std::move(q)), v_(std::move(v)) {}

  int components() const override { return static_cast<int>(q_.size()); }
  void at(double t, double, std::span<FieldPoint> out) const override {
    for (std::size_t a = 0; a < q_.size(); ++a) out[a] = {q_[a] + t * v_[a], v_[a], 0};
  }
  bool exact() const override { return false; }
  std::string description() const override { return "point: q = (" + list(q_) + "), q_t = (" + list(v_) + ")"; }

 private:
  static std::string list(const std::vector<double>& numbers) {
    std::string words;
    for (const double x : numbers) words += (words.empty() ? "" : ", ") + text(x);
    return words;
  }

  std::vector<double> q_, v_;
};

std::unique_ptr<State> point(const StateBuild& build) {
  const int d = build.request.components;
  std::vector<double> q = numbers(build, "initial.q", d), v = numbers(build, "initial.v", d);
  if (build.values.has("initial.p")) {
    if (build.values.has("initial.v"))
      throw BadInput("initial.p", "initial.p: the momenta follow from initial.v; give one of the two");
    v = velocities_of_momenta(build, q, "initial.v");
  }
  return std::make_unique<Point>(std::move(q), std::move(v));
}

Parameter list_parameter(const char* key, const char* help, const char* unit, const char* otherwise) {
  return {key, std::string(), help, unit, {}, {}, otherwise};
}

}  // namespace
}  // namespace initial

extern const StateEntry point_state;
const StateEntry point_state{
    .name = "point",
    .formula = "q and q_t, or q and p = dL/dq_t",
    .parameters = {initial::list_parameter("initial.q", "q of every field, separated by commas", "", "0"),
                   initial::list_parameter("initial.v", "q_t of every field, separated by commas", "1/time", "0"),
                   initial::list_parameter("initial.p", "p = dL/dq_t of every field, in place of initial.v", "",
                                           "that of initial.v")},
    .exact = {},
    .approximate = {},
    .place = Place::point,
    .build = initial::point,
    .any_theory = true,
    .sources = {"delf"}};

}  // namespace delf

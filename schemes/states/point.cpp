// SPDX-License-Identifier: MIT
#include <charconv>
#include <cmath>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"
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

/// "0.25, 0.125": as many numbers as the theory has fields; zeros if the key is not given.
std::vector<double> numbers(const StateBuild& build, const std::string& key, int count) {
  const auto given = build.values.maybe<std::string>(key);
  std::vector<double> list;
  if (!given) return std::vector<double>(count, 0.0);
  const auto refuse = [&](const std::string& why) { throw BadInput(key, key + " = " + *given + ": " + why); };
  for (const std::string& word : parts_of(*given)) {
    double x = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
    if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(x))
      refuse("is not a list of finite numbers; write one like 0.25, -1e-3");
    list.push_back(x);
  }
  if (static_cast<int>(list.size()) != count)
    refuse("the theory " + build.request.theory + " has " + std::to_string(count) +
           (count == 1 ? " field" : " fields") + "; give as many numbers");
  return list;
}

std::unique_ptr<State> point(const StateBuild& build) {
  const int d = build.request.components;
  std::vector<double> q = numbers(build, "initial.q", d), v = numbers(build, "initial.v", d);
  if (build.values.has("initial.p")) {
    if (build.values.has("initial.v"))
      throw BadInput("initial.p", "initial.p: the momenta follow from initial.v; give one of the two");
    const std::vector<double> p = numbers(build, "initial.p", d);
    const auto velocity = build.request.velocity_of ? build.request.velocity_of(q, p) : std::nullopt;
    if (!velocity)
      throw BadInput("initial.p", "initial.p: no velocities have these momenta at initial.q; give initial.v");
    v = *velocity;
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
    "point",
    "q and q_t, or q and p = dL/dq_t",
    {initial::list_parameter("initial.q", "q of every field, separated by commas", "", "0"),
     initial::list_parameter("initial.v", "q_t of every field, separated by commas", "1/time", "0"),
     initial::list_parameter("initial.p", "p = dL/dq_t of every field, in place of initial.v", "",
                             "that of initial.v")},
    {},
    {},
    Place::point,
    initial::point,
    true,
    {"wave-map", "spherical-pendulum"}};  // their constraint would be broken

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "schemes/states/builders.hpp"
#include "schemes/states/parameters.hpp"

namespace delf::initial {
namespace {

/// A pulse of sine-Gordon in each of two components. Where both are the same, sin(φ₁ − φ₂) = 0 and the coupling does
/// nothing: the pair then solves the coupled equations as each solves its own.
class CoupledPair final : public State {
 public:
  CoupledPair(std::unique_ptr<State> first, std::unique_ptr<State> second, bool solves, std::string line)
      : first_(std::move(first)), second_(std::move(second)), exact_(solves), description_(std::move(line)) {}

  int components() const override { return 2; }
  void values(double t, const Lattice& lattice, std::span<double> out) const override {
    interleave(&State::values, t, lattice, out);
  }
  void velocities(double t, const Lattice& lattice, std::span<double> out) const override {
    interleave(&State::velocities, t, lattice, out);
  }
  bool exact() const override { return exact_ && first_->exact() && second_->exact(); }
  double exact_until() const override {
    return exact() ? std::min(first_->exact_until(), second_->exact_until()) : 0.0;
  }
  int winding() const override { return first_->winding(); }
  std::string description() const override { return description_; }

 private:
  using Writer = void (State::*)(double, const Lattice&, std::span<double>) const;
  void interleave(Writer write, double t, const Lattice& lattice, std::span<double> out) const {
    const auto sites = static_cast<std::size_t>(lattice.sites());
    std::vector<double> row(sites);
    std::size_t a = 0;
    for (const State* pulse : {first_.get(), second_.get()}) {
      (pulse->*write)(t, lattice, row);
      for (std::size_t i = 0; i < sites; ++i) out[2 * i + a] = row[i];
      ++a;
    }
  }

  std::unique_ptr<State> first_, second_;
  bool exact_;
  std::string description_;
};

using Builder = std::unique_ptr<State> (*)(const StateRequest&, const Lattice&);

std::unique_ptr<State> coupled(const StateRequest& request, const Lattice& lattice, Builder build, const char* name) {
  const double x0 = centre(request, lattice), d = finite("initial.separation", request.separation, 0);
  const auto pulse = [&](double position) {
    StateRequest one = request;
    one.name = name;
    one.position = position;
    return build(one, lattice);
  };
  auto first = pulse(x0 - d / 2), second = pulse(x0 + d / 2);
  const bool solves = d == 0 || request.lambda == 0;
  std::string line = request.name + ", ";
  if (d == 0) line += "both components: " + first->description();
  else line += "first component: " + first->description() + "; second component: " + second->description();
  if (!solves) line += "; together not an exact solution of " + request.theory;
  return std::make_unique<CoupledPair>(std::move(first), std::move(second), solves, std::move(line));
}

}  // namespace

std::unique_ptr<State> coupled_kinks(const StateRequest& r, const Lattice& lattice) {
  return coupled(r, lattice, kink, "kink");
}
std::unique_ptr<State> coupled_breathers(const StateRequest& r, const Lattice& lattice) {
  return coupled(r, lattice, breather, "breather");
}

}  // namespace delf::initial

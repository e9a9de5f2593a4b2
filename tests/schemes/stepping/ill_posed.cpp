// SPDX-License-Identifier: MIT
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "jets/tables/rectangle_jet.hpp"
#include "jets/tables/triangle_jet.hpp"
#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/scheme.hpp"
#include "schemes/stepping/undetermined.hpp"
#include "schemes/theories/sine_gordon.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

/// (y₂ − y₁)² between neighbours of one row
struct OneRow {
  StencilPattern pattern() const { return StencilPattern({{0, 0}, {0, 1}}); }
  std::vector<VertexValue> values() const { return {{0, 0}, {1, 0}}; }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    return (y[1] - y[0]) * (y[1] - y[0]);
  }
};

/// y₀³, which component 1 is listed in and does not enter
struct Absent {
  StencilPattern pattern() const { return StencilPattern({{0, 0}}); }
  std::vector<VertexValue> values() const { return {{0, 0}, {0, 1}}; }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    return y[0] * y[0] * y[0] + 0.0 * y[1];
  }
};

/// λ(φ² − 1), λ the component `multiplier`
struct Unit {
  int multiplier;
  StencilPattern pattern() const { return StencilPattern({{0, 0}}); }
  std::vector<VertexValue> values() const { return {{0, 0}, {0, multiplier}}; }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    return y[1] * (y[0] * y[0] - 1.0);
  }
};

template <class L>
std::shared_ptr<const StencilFamily> family(L lagrangian) {
  return std::make_shared<LagrangianFamily<L>>(lagrangian);
}

/// What the refusal says, or "accepted".
std::string refusal(std::vector<std::shared_ptr<const StencilFamily>> families, std::vector<Component> components,
                    const Lattice& lattice = Lattice::circle(20, 10)) {
  try {
    require_determined(Evolution(lattice, std::move(families), 0.1, {}, std::move(components)));
  } catch (const BadInput& bad) {
    return bad.key() + ": " + bad.what();
  }
  return "accepted";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const Component phi{"phi"}, psi{"psi"}, lambda{"lambda", Role::multiplier, {}}, mu{"mu", Role::multiplier, {}};

}  // namespace

TEST_CASE("ill-posed systems are refused, and say by name what is not determined") {
  const auto action = Scheme{rectangle, SineGordon{1}}.family();
  CHECK(refusal({action, family(Unit{1})}, {phi, lambda}) == "accepted");

  const std::string nobody = refusal({action, family(Absent{})}, {phi, psi});
  CAPTURE(nobody);
  CHECK(holds(nobody, "psi has no equation at any site"));

  const std::string too_many = refusal({action, family(Unit{1}), family(Unit{2})}, {phi, lambda, mu});
  CAPTURE(too_many);
  CHECK(holds(too_many, "determine the unknown of mu"));

  const std::string still = refusal({family(OneRow{})}, {phi});
  CAPTURE(still);
  CHECK(holds(still, "no row leads to the next"));
}

TEST_CASE("a slab whose Jacobian is singular at every state is refused, and says along which wave") {
  const Component a{"a"}, b{"b"};
  const auto density = expression("b*a_t - 0.5*(a_x^2 + b_x^2) + 0.5*(a^2 + b^2)^2", {.fields = {"a", "b"}});
  const auto action = Scheme{triangle, density}.family();
  for (const int N : {2, 4, 6, 20, 24, 200}) {
    CAPTURE(N);
    const std::string even = refusal({action}, {a, b}, Lattice::circle(N, 10));
    CAPTURE(even);
    CHECK(holds(even, "no equation of a step changes with b at sites 0, 1"));
    CHECK(holds(even, "in the ratio 1 : -1"));
  }
  for (const int N : {3, 5, 21, 25}) CHECK(refusal({action}, {a, b}, Lattice::circle(N, 10)) == "accepted");
  for (const int N : {4, 5, 20}) CHECK(refusal({action}, {a, b}, Lattice::interval(N, 10)) == "accepted");
}

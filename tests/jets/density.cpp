// SPDX-License-Identifier: MIT
#include "jets/density.hpp"

#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"

using namespace delf;

namespace {

struct Good {
  auto operator()(const auto& j) const { return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - exp(j.phi); }
};
struct Constant {
  auto operator()(const auto&) const { return 1.0; }
};
struct NotConst {
  auto operator()(const auto& j) { return j.phi_t * j.phi_t; }
};
struct ReturnsNothing {
  void operator()(const auto&) const {}
};
struct ReturnsText {
  const char* operator()(const auto&) const { return ""; }
};
struct NumbersOnly {
  double operator()(const Jet<double>& j) const { return j.phi_t * j.phi_t; }
};
struct NoPacks {
  double operator()(const Jet<double>& j) const { return j.phi; }
  Dual<double, 3> operator()(const Jet<Dual<double, 3>>& j) const { return j.phi; }
};
struct TakesReference {
  auto operator()(auto& j) const requires(!std::is_const_v<std::remove_reference_t<decltype(j)>>) { return j.phi; }
};
struct Two {
  static constexpr int components = 2;
  auto operator()(const auto& j) const { return j.phi_t[0] * j.phi_t[1] - j.phi[0] * j.phi_x[1]; }
};
struct Located {
  static constexpr bool placed = true;
  auto operator()(const auto& j) const { return j.phi_t * j.phi_t - sin(j.x - j.t) * j.phi; }
};
struct PlacedTwo {
  static constexpr int components = 2;
  static constexpr bool placed = true;
  auto operator()(const auto& j) const { return j.phi[1] * j.phi_t[0] + j.t * j.x; }
};

}  // namespace

static_assert(Density<Good> && Density<Two> && Density<Located> && Density<PlacedTwo>);
static_assert(Density<Wave> && Density<KleinGordon> && Density<SineGordon> && Density<PhiFour> &&
              Density<DoubleSineGordon> && Density<SineGordonImpurity>);
static_assert(!Density<NotConst>, "the operator must be const");
static_assert(!Density<ReturnsNothing> && !Density<ReturnsText>, "it must return a number");
static_assert(!Density<Constant>, "it must return a number of the kind that it was given: 1.0 has no derivatives");
static_assert(!Density<NumbersOnly> && !Density<NoPacks>, "it must work for any kind of number");
static_assert(!Density<TakesReference>, "it must take const auto&");
static_assert(!Density<int> && !Density<Jet<double>>, "it must be a function");

TEST_CASE("a density says its components and whether it is placed, and has neither by default") {
  CHECK((components_of<Good>() == 1 && components_of<Two>() == 2 && components_of<PlacedTwo>() == 2));
  CHECK((is_placed<Located>() && is_placed<PlacedTwo>() && is_placed<SineGordonImpurity>()));
  CHECK_FALSE((is_placed<Good>() || is_placed<Two>() || is_placed<SineGordon>()));
  CHECK(std::is_same_v<JetFor<double, Good>, Jet<double, 1>>);
  CHECK(std::is_same_v<JetFor<double, PlacedTwo>, PlacedJet<double, 2>>);
}

TEST_CASE("every theory has the density of its field equation at a jet") {
  // ℓ = ½φ_t² − ½φ_x² + N(φ) at φ = 0.8, φ_t = 0.5, φ_x = −0.3
  const double y = 0.8, kinetic = 0.5 * (0.25 - 0.09);
  Jet<double> j{y, 0.5, -0.3};
  CHECK(std::abs(Wave{}(j)-kinetic) < 1e-15);
  CHECK(std::abs(KleinGordon{1.3}(j) - (kinetic - 0.5 * 1.69 * y * y)) < 1e-15);
  CHECK(std::abs(SineGordon{1.2}(j) - (kinetic + 1.44 * (std::cos(y) - 1))) < 1e-15);
  CHECK(std::abs(PhiFour{0.7}(j) - (kinetic - 0.175 * (y * y - 1) * (y * y - 1))) < 1e-15);
  CHECK(std::abs(DoubleSineGordon{1.1, 0.4}(j) - (kinetic + 1.21 * (std::cos(y) - 1) + 0.2 * (std::cos(2 * y) - 1))) <
        1e-15);
  PlacedJet<double> p;
  p.phi = y, p.phi_t = 0.5, p.phi_x = -0.3, p.t = 2, p.x = 1.1;
  const double depth = 1.21 * (1 + 0.6 * std::exp(-1.0));  // (x − x₀)/w = 1
  CHECK(std::abs(SineGordonImpurity{1.1, 0.6, 0.8, 0.3}(p) - (kinetic + depth * (std::cos(y) - 1))) < 1e-15);
}

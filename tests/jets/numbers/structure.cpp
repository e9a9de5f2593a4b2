// SPDX-License-Identifier: MIT
#include "jets/numbers/structure.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "jets/batch_of.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

template <class D>
Nonlinearity nonlinearity(const D& density) {
  return structure_of(density).nonlinearity;
}

constexpr auto kinetic = [](const auto& j) { return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x); };

/// A density from a lambda, of d components.
template <class F, int d = 1, bool located = false>
struct From {
  static constexpr int components = d;
  static constexpr bool placed = located;
  F f;
  auto operator()(const auto& j) const { return f(j); }
};
template <int d = 1, bool located = false, class F>
From<F, d, located> from(F f) {
  return {f};
}

/// A random polynomial of (φ, φ_t, φ_x), written with all the operations that a density may use for one: a program for
/// a stack, so that it runs on any kind of number.
struct Program {
  struct Operation {
    char what;  // a variable v, a constant c, + − * n(egation) p(ower)
    int which;
    double value;
  };
  std::vector<Operation> operations;

  template <class J>
  auto operator()(const J& j) const {
    using T = std::decay_t<decltype(j.phi)>;
    std::vector<T> stack;
    for (const Operation& o : operations) {
      if (o.what == 'v') {
        stack.push_back(o.which == 0 ? j.phi : o.which == 1 ? j.phi_t : j.phi_x);
      } else if (o.what == 'c') {
        stack.push_back(T(o.value));
      } else if (o.what == 'n') {
        stack.back() = -stack.back();
      } else if (o.what == 'p') {
        stack.back() = pow(stack.back(), o.value);
      } else {
        const T b = stack.back();
        stack.pop_back();
        T& a = stack.back();
        a = o.what == '+' ? a + b : o.what == '-' ? a - b : a * b;
      }
    }
    return stack.back();
  }

  /// Appends an expression of that depth.
  void grow(Random& random, int depth) {
    if (depth == 0 || random(0, 1) < 0.15) {
      if (random(0, 1) < 0.75) operations.push_back({'v', random.pick(0, 2), 0});
      else operations.push_back({'c', 0, random(0, 1) < 0.2 ? 0.0 : random(0.5, 2)});
      return;
    }
    const double choice = random(0, 1);
    grow(random, depth - 1);
    if (choice < 0.1) return operations.push_back({'n', 0, 0});
    if (choice < 0.2) return operations.push_back({'p', 0, static_cast<double>(random.pick(1, 3))});
    grow(random, depth - 1);
    operations.push_back({choice < 0.5 ? '+' : choice < 0.6 ? '-' : '*', 0, 0});
  }
};

using Inner = Dual<double, 3>;
using Outer = Dual<Inner, 3>;

/// Gradient and Hessian at a random jet.
Outer sampled(const Program& program, Random& random) {
  const auto variable = [&](int i) { return Outer::variable(Inner::variable(random(0.5, 1.5), i), i); };
  Jet<Outer> j{variable(0), variable(1), variable(2)};
  return program(j);
}

/// The largest contradiction, relative, between what is said of a program and samples of it.
double contradiction(const Program& program, const Abstract& claim, Random& random) {
  Outer at[4];
  for (Outer& x : at) x = sampled(program, random);
  double worst = 0;
  for (int a = 0; a < 3; ++a) {
    if (!(claim.depends >> a & 1u))
      for (const Outer& x : at) worst = std::max(worst, std::abs(x.d[a].value));
    for (int b = 0; b < 3; ++b) {
      double least = at[0].d[a].d[b], most = least;
      for (const Outer& x : at) least = std::min(least, x.d[a].d[b]), most = std::max(most, x.d[a].d[b]);
      const double scale = 1 + std::max(std::abs(least), std::abs(most));
      if (!(claim.nonzero[a] >> b & 1u)) worst = std::max({worst, std::abs(least), std::abs(most)});
      if (!(claim.varying[a] >> b & 1u)) worst = std::max(worst, (most - least) / scale);
    }
  }
  return worst;
}

/// The largest change of ℓ(φ, φ_t, φ_x), relative, by a reflection that is said to leave it as it is.
double change_by_reflections(const Program& program, std::uint8_t even, Random& random) {
  double worst = 0;
  for (int r = 0; r < 3; ++r)
    for (int n = 0; n < 4 && (even >> r & 1) != 0; ++n) {
      const double phi = random(-1.5, 1.5), phi_t = random(-1.5, 1.5), phi_x = random(-1.5, 1.5);
      const double as_it_is = program(Jet<double>{phi, phi_t, phi_x}),
                   reflected = program(Jet<double>{r == 0 ? -phi : phi, r == 1 ? -phi_t : phi_t, r == 2 ? -phi_x : phi_x});
      worst = std::max(worst, std::abs(reflected - as_it_is) / (1 + std::abs(as_it_is)));
    }
  return worst;
}

/// The reflection of φ_x leaves a density of that lambda as it is, by its form alone.
template <class F>
bool is_even(F f) {
  return structure_of(from(f)).of_density.even >> static_cast<int>(Reflection::phi_x) & 1;
}

}  // namespace

TEST_CASE("theories without a potential, or with a quadratic one, are linear") {
  CHECK(nonlinearity(Wave{}) == Nonlinearity::none);
  CHECK(nonlinearity(KleinGordon{1.3}) == Nonlinearity::none);
}

TEST_CASE("theories with a potential of φ are nonlinear in values alone, also where it depends on x") {
  CHECK(nonlinearity(SineGordon{}) == Nonlinearity::values);
  CHECK(nonlinearity(PhiFour{}) == Nonlinearity::values);
  CHECK(nonlinearity(DoubleSineGordon{}) == Nonlinearity::values);
  CHECK(nonlinearity(SineGordonImpurity{}) == Nonlinearity::values);
}

TEST_CASE("a potential whose coefficient is zero is not there") {
  CHECK(nonlinearity(KleinGordon{0}) == Nonlinearity::none);
  CHECK(nonlinearity(SineGordon{0}) == Nonlinearity::none);
  CHECK(nonlinearity(PhiFour{0}) == Nonlinearity::none);
  CHECK(nonlinearity(DoubleSineGordon{0, 0}) == Nonlinearity::none);
  CHECK(nonlinearity(SineGordonImpurity{0}) == Nonlinearity::none);
  CHECK(nonlinearity(DoubleSineGordon{0, 1}) == Nonlinearity::values);
}

TEST_CASE("a density that is nonlinear in a derivative is nonlinear in all") {
  const auto born_infeld = from([](const auto& j) { return -sqrt(1.0 - j.phi_t * j.phi_t + j.phi_x * j.phi_x); });
  const auto mixed = from([](const auto& j) { return j.phi * j.phi_t * j.phi_t; });
  const auto chain_of_springs = from([](const auto& j) { return kinetic(j) - pow(j.phi_x, 4.0); });
  const auto by_value = from([](const auto& j) { return kinetic(j) + sin(j.phi) * j.phi_x; });
  const auto quotient = from([](const auto& j) { return j.phi_t * j.phi_t / (1.0 + j.phi * j.phi); });
  CHECK(nonlinearity(born_infeld) == Nonlinearity::all);
  CHECK(nonlinearity(mixed) == Nonlinearity::all);
  CHECK(nonlinearity(chain_of_springs) == Nonlinearity::all);
  CHECK(nonlinearity(by_value) == Nonlinearity::all);
  CHECK(nonlinearity(quotient) == Nonlinearity::all);
}

TEST_CASE("products of two jet components and shifts of them are still linear") {
  CHECK(nonlinearity(from([](const auto& j) { return kinetic(j) + 3.0 * j.phi * j.phi_t + j.phi - 2.0; })) ==
        Nonlinearity::none);
  CHECK(nonlinearity(from([](const auto& j) { return (j.phi_t + j.phi) * (j.phi_x - 1.0) / 2.0; })) ==
        Nonlinearity::none);
  CHECK(nonlinearity(from([](const auto& j) { return pow(j.phi_t, 2.0) + pow(j.phi, 1.0) + pow(j.phi, 0.0); })) ==
        Nonlinearity::none);
}

TEST_CASE("coefficients that depend on the place are not constant") {
  const auto medium =
      from<1, true>([](const auto& j) { return 0.5 * (2.0 + sin(j.x)) * j.phi_t * j.phi_t - j.phi_x * j.phi_x; });
  const auto pumped = from<1, true>([](const auto& j) { return kinetic(j) - cos(j.t) * j.phi * j.phi; });
  const auto driven = from<1, true>([](const auto& j) { return kinetic(j) + sin(j.t) * j.phi; });
  const auto apart = from<1, true>([](const auto& j) { return kinetic(j) + sin(j.t); });
  CHECK(nonlinearity(medium) == Nonlinearity::all);
  CHECK(nonlinearity(pumped) == Nonlinearity::values);
  CHECK(nonlinearity(driven) == Nonlinearity::values);
  CHECK(nonlinearity(apart) == Nonlinearity::none);
}

TEST_CASE("fields of two components: coupled values are values, coupled velocities are not") {
  CHECK(nonlinearity(from<2>([](const auto& j) {
          return j.phi_t[0] * j.phi_t[0] + j.phi_t[1] * j.phi_t[1] - cos(j.phi[0] - j.phi[1]);
        })) == Nonlinearity::values);
  CHECK(nonlinearity(from<2>([](const auto& j) { return j.phi_t[0] * j.phi[1] - j.phi_x[0] * j.phi_x[1]; })) ==
        Nonlinearity::none);
  CHECK(nonlinearity(from<2>([](const auto& j) { return j.phi_t[0] * j.phi[1] * j.phi[0]; })) == Nonlinearity::all);
  const auto structure = structure_of(from<2>([](const auto& j) { return j.phi_t[0] * j.phi[1]; }));
  // variables φ¹ φ² φ_t¹ φ_t² φ_x¹ φ_x²: ∂²/∂φ²∂φ_t¹ alone
  for (std::size_t a = 0; a < 6; ++a)
    CHECK(structure.of_density.nonzero[a] == (a == 1 ? 1u << 2 : a == 2 ? 1u << 1 : 0u));
}

TEST_CASE("of random polynomials nothing is claimed constant or absent that is not") {
  Random random(17);
  int constant_entries = 0, absent_entries = 0;
  for (int n = 0; n < 3000; ++n) {
    Program program;
    program.grow(random, random.pick(1, 5));
    const DensityStructure structure = structure_of(program);
    CHECK(contradiction(program, structure.of_density, random) < 1e-10);
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        const bool nonzero = structure.of_density.nonzero[a] >> b & 1u,
                   varying = structure.of_density.varying[a] >> b & 1u;
        CHECK((nonzero || !varying));
        constant_entries += nonzero && !varying;
        absent_entries += !nonzero;
      }
  }
  CHECK(constant_entries > 1000);  // and much is claimed
  CHECK(absent_entries > 1000);
}

TEST_CASE("the sampling can fail: φ³ claimed to have a constant Hessian, φφ_t claimed to have none") {
  Random random(18);
  Program cube, product;
  cube.operations = {{'v', 0, 0}, {'p', 0, 3}};
  product.operations = {{'v', 0, 0}, {'v', 1, 0}, {'*', 0, 0}};
  Abstract constant = structure_of(cube).of_density, none = structure_of(product).of_density;
  constant.varying.fill(0);
  none.nonzero.fill(0);
  CHECK(contradiction(cube, constant, random) > 0.01);
  CHECK(contradiction(product, none, random) > 0.01);
}

TEST_CASE("of random polynomials no reflection is claimed that changes them") {
  Random random(19);
  int claimed = 0;
  for (int n = 0; n < 3000; ++n) {
    Program program;
    program.grow(random, random.pick(1, 5));
    const std::uint8_t even = structure_of(program).of_density.even;
    CHECK(change_by_reflections(program, even, random) < 1e-12);
    for (int r = 0; r < 3; ++r) claimed += even >> r & 1;
    CHECK((even >> static_cast<int>(Reflection::phi_t) & 1) == (even >> static_cast<int>(Reflection::in_time) & 1));
  }
  CHECK(claimed > 1000);
  // the sampling can fail: φ_x³ claimed to be even
  Program cube;
  cube.operations = {{'v', 2, 0}, {'p', 0, 3}};
  CHECK(change_by_reflections(cube, 1u << static_cast<int>(Reflection::phi_x), random) > 0.01);
}

TEST_CASE("even functions of an odd number are even, and so are products of two odd ones") {
  CHECK(is_even([](const auto& j) { return cos(j.phi_x) + cosh(j.phi_x) + sinc(j.phi_x) + cosm1(j.phi_x); }));
  CHECK(is_even([](const auto& j) { return sin(j.phi_x) * j.phi_x + tan(j.phi_x) * sinh(j.phi_x); }));
  CHECK(is_even([](const auto& j) { return tanh(j.phi_x) / j.phi_x - atan(j.phi_x) * (1.0 / j.phi_x); }));
  CHECK(is_even([](const auto& j) { return pow(j.phi_x, 4.0) + pow(j.phi_x, -2.0) + pow(j.phi_x, 3.0) * j.phi_x; }));
  CHECK(is_even([](const auto& j) { return -sqrt(1.0 - j.phi_t * j.phi_t + j.phi_x * j.phi_x) + exp(j.phi); }));
  CHECK(is_even([](const auto& j) { return sin(sin(j.phi_x)) * j.phi_t * sin(-j.phi_x); }));
}

TEST_CASE("a density that a reflection changes is not claimed to be even") {
  CHECK_FALSE(is_even([](const auto& j) { return j.phi_x; }));
  CHECK_FALSE(is_even([](const auto& j) { return sin(j.phi_x) + cos(j.phi_x); }));
  CHECK_FALSE(is_even([](const auto& j) { return tan(j.phi_x) + sinh(j.phi_x) + tanh(j.phi_x) + atan(j.phi_x); }));
  CHECK_FALSE(is_even([](const auto& j) { return exp(j.phi_x); }));
  CHECK_FALSE(is_even([](const auto& j) { return sqrt(2.0 + j.phi_x) + log(2.0 + j.phi_x); }));
  CHECK_FALSE(is_even([](const auto& j) { return pow(j.phi_x, 3.0) + pow(j.phi_x, -1.0); }));
  CHECK_FALSE(is_even([](const auto& j) { return pow(j.phi_x, 2.5); }));
  CHECK_FALSE(is_even([](const auto& j) { return j.phi_t * j.phi_x; }));
  CHECK_FALSE(is_even([](const auto& j) { return cos(1.0 + j.phi_x); }));
  CHECK_FALSE(is_even([](const auto& j) { return cos(j.phi_t + j.phi_x); }));
  // in all rates together: not in each
  const auto turning = structure_of(from<2>([](const auto& j) { return j.phi_t[0] * j.phi_t[1] + j.phi_x[0] * j.phi[1]; }));
  const auto even = [&](Reflection r) { return (turning.of_density.even >> static_cast<int>(r) & 1) != 0; };
  CHECK(even(Reflection::in_time));
  CHECK_FALSE(even(Reflection::phi_x));
  CHECK_FALSE(even(Reflection::phi));
}

TEST_CASE("a quadratic density is even where the entries between slots cancel in numbers") {
  const auto even = [](const auto& f, Reflection r) { return BatchOf(from(f)).is_even(r); };
  const auto wave = [](const auto& j) { return (j.phi_t - j.phi_x) * (j.phi_t + j.phi_x) + exp(j.phi); };
  const auto skew = [](const auto& j) { return (j.phi_t - j.phi_x) * (j.phi_t + 2.0 * j.phi_x) + exp(j.phi); };
  const auto pushed = [](const auto& j) { return (j.phi_t - j.phi_x) * (j.phi_t + j.phi_x + 1.0); };
  CHECK_FALSE(is_even(wave));  // its form alone does not say so
  CHECK(even(wave, Reflection::phi_x));
  CHECK(even(wave, Reflection::in_time));
  CHECK_FALSE(even(wave, Reflection::phi));
  CHECK_FALSE(even(skew, Reflection::phi_x));
  CHECK_FALSE(even(skew, Reflection::in_time));
  CHECK_FALSE(even(pushed, Reflection::phi_x));
  const auto driven = from<1, true>([](const auto& j) { return j.phi_x * j.phi_x + sin(j.x) * j.phi_x; });
  CHECK_FALSE(BatchOf(driven).is_even(Reflection::phi_x));
  const auto medium = from<1, true>([](const auto& j) { return (2.0 + sin(j.x)) * j.phi_x * j.phi_x; });
  CHECK(BatchOf(medium).is_even(Reflection::phi_x));
}

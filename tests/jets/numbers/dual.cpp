// SPDX-License-Identifier: MIT
#include "jets/numbers/dual.hpp"

#include <numbers>

#include "tests/catch.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

using Number = Dual<double, 2>;
using Second = Dual<Number, 2>;

struct Derivatives {
  double value;
  std::array<double, 2> gradient;
  std::array<std::array<double, 2>, 2> hessian;
};

/// By differentiation, of f(u, v).
template <class F>
Derivatives differentiated(const F& f, double u, double v) {
  const Number once = f(Number::variable(u, 0), Number::variable(v, 1));
  const Second twice = f(Second::variable(Number::variable(u, 0), 0), Second::variable(Number::variable(v, 1), 1));
  CHECK(std::abs(twice.value.value - once.value) <= 1e-15 * std::abs(once.value));
  Derivatives result{once.value, {once.d[0], once.d[1]}, {}};
  for (std::size_t i = 0; i < 2; ++i)
    for (std::size_t j = 0; j < 2; ++j) result.hessian[i][j] = twice.d[i].d[j];
  return result;
}

/// The largest difference of gradient and Hessian to central differences of fourth order, over some points.
template <class F>
double against_differences(const F& f) {
  Random random(3);
  double worst = 0;
  constexpr double e = 3e-4;
  const auto slope = [](auto&& g) { return (8 * (g(e) - g(-e)) - (g(2 * e) - g(-2 * e))) / (12 * e); };
  for (int n = 0; n < 20; ++n) {
    const double u = random(0.3, 1.2), v = random(0.4, 1.1);
    const Derivatives d = differentiated(f, u, v);
    CHECK(std::abs(d.value - f(u, v)) < 1e-15 * (1 + std::abs(d.value)));
    const auto gradient = [&](double x, double y) { return differentiated(f, x, y).gradient; };
    worst = std::max({worst, std::abs(d.gradient[0] - slope([&](double s) { return f(u + s, v); })),
                      std::abs(d.gradient[1] - slope([&](double s) { return f(u, v + s); }))});
    for (std::size_t i = 0; i < 2; ++i)
      worst = std::max({worst, std::abs(d.hessian[i][0] - slope([&](double s) { return gradient(u + s, v)[i]; })),
                        std::abs(d.hessian[i][1] - slope([&](double s) { return gradient(u, v + s)[i]; }))});
    CHECK(std::abs(d.hessian[0][1] - d.hessian[1][0]) < 1e-12);
  }
  return worst;
}

/// A function of one variable with its first two derivatives.
template <class F>
void check_closed_form(const char* name, const F& f, double (*slope)(double), double (*curvature)(double)) {
  CAPTURE(name);
  for (const double u : {0.2, 0.6, 0.9, 1.4}) {
    const Derivatives d = differentiated([&](auto x, auto) { return f(x); }, u, 0);
    CHECK(std::abs(d.gradient[0] - slope(u)) < 1e-14 * (1 + std::abs(slope(u))));
    CHECK(std::abs(d.hessian[0][0] - curvature(u)) < 2e-14 * (1 + std::abs(curvature(u))));
    CHECK((d.gradient[1] == 0 && d.hessian[0][1] == 0 && d.hessian[1][1] == 0));
  }
}

}  // namespace

TEST_CASE("gradient and Hessian of every operation agree with finite differences") {
  CHECK(against_differences([](auto u, auto v) { return u + v; }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return u - v; }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return u * v; }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return u / v; }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return -u * u * v; }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return 2.0 * u + (v - 3.0) - (1.5 - u) * 0.5 + (0.2 + v) / 4.0; }) <
        1e-9);
  CHECK(against_differences([](auto u, auto v) { return 1.0 / (u + v * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) {
          u += v;
          v *= u;
          u -= v;
          return u * v;
        }) < 1e-9);
}

TEST_CASE("gradient and Hessian of every function agree with finite differences") {
  CHECK(against_differences([](auto u, auto v) { return sin(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return cos(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return tan(0.5 * u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return exp(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return log(u + v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return sqrt(u + v * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return sinh(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return cosh(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return tanh(u * v); }) < 1e-9);
  CHECK(against_differences([](auto u, auto v) { return pow(u * v, 2.7); }) < 1e-9);
}

TEST_CASE("the comparison can fail: a sine whose slope has the wrong sign is found") {
  const auto wrong = []<class T>(T u, T) {
    if constexpr (requires { u.d; }) return chain(u, sin(u.value), -cos(u.value));
    else return sin(u);
  };
  CHECK(against_differences(wrong) > 0.1);
}

TEST_CASE("first and second derivatives are those of the closed forms") {
  using std::cos, std::cosh, std::exp, std::sin, std::sinh, std::tan, std::tanh;
  check_closed_form(
      "sin", [](auto u) { return sin(u); }, [](double u) { return cos(u); }, [](double u) { return -sin(u); });
  check_closed_form(
      "cos", [](auto u) { return cos(u); }, [](double u) { return -sin(u); }, [](double u) { return -cos(u); });
  check_closed_form(
      "tan", [](auto u) { return tan(u); }, [](double u) { return 1 / (cos(u) * cos(u)); },
      [](double u) { return 2 * tan(u) / (cos(u) * cos(u)); });
  check_closed_form(
      "exp", [](auto u) { return exp(u); }, [](double u) { return exp(u); }, [](double u) { return exp(u); });
  check_closed_form(
      "log", [](auto u) { return log(u); }, [](double u) { return 1 / u; }, [](double u) { return -1 / (u * u); });
  check_closed_form(
      "sqrt", [](auto u) { return sqrt(u); }, [](double u) { return 0.5 / std::sqrt(u); },
      [](double u) { return -0.25 / (u * std::sqrt(u)); });
  check_closed_form(
      "sinh", [](auto u) { return sinh(u); }, [](double u) { return cosh(u); }, [](double u) { return sinh(u); });
  check_closed_form(
      "cosh", [](auto u) { return cosh(u); }, [](double u) { return sinh(u); }, [](double u) { return cosh(u); });
  check_closed_form(
      "tanh", [](auto u) { return tanh(u); }, [](double u) { return 1 / (cosh(u) * cosh(u)); },
      [](double u) { return -2 * tanh(u) / (cosh(u) * cosh(u)); });
  check_closed_form(
      "pow", [](auto u) { return pow(u, -1.5); }, [](double u) { return -1.5 * std::pow(u, -2.5); },
      [](double u) { return 3.75 * std::pow(u, -3.5); });
  check_closed_form(
      "1/u", [](auto u) { return 1.0 / u; }, [](double u) { return -1 / (u * u); },
      [](double u) { return 2 / (u * u * u); });
}

TEST_CASE("whole powers are differentiated at 0 as polynomials are") {
  for (int p = 0; p <= 4; ++p) {
    CAPTURE(p);
    const Derivatives d = differentiated([p](auto u, auto) { return pow(u, static_cast<double>(p)); }, 0, 0);
    CHECK(d.value == (p == 0 ? 1 : 0));
    CHECK(d.gradient[0] == (p == 1 ? 1 : 0));
    CHECK(d.hessian[0][0] == (p == 2 ? 2 : 0));
  }
}

TEST_CASE("a dual of packs is a dual of numbers in every lane") {
  Random random(8);
  const auto f = [](auto u, auto v) { return exp(-0.3 * u) * sin(u * v) / (2.0 + cos(v)) - sqrt(u) * pow(v, 1.5); };
  Pack u, v;
  for (int l = 0; l < lanes; ++l) u.v[l] = random(0.2, 2), v.v[l] = random(0.2, 2);
  const auto packed = f(Dual<Pack, 2>::variable(u, 0), Dual<Pack, 2>::variable(v, 1));
  for (int l = 0; l < lanes; ++l) {
    const Number one = f(Number::variable(u[l], 0), Number::variable(v[l], 1));
    CHECK(std::abs(packed.value[l] - one.value) < 1e-14);
    for (int i : {0, 1}) CHECK(std::abs(packed.derivative(i)[l] - one.derivative(i)) < 1e-14);
  }
}

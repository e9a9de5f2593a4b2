// SPDX-License-Identifier: MIT
#include "jets/expressions/expression.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <vector>

#include "jets/batch_of.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/theories/complex_klein_gordon.hpp"
#include "schemes/theories/coupled_sine_gordon.hpp"
#include "schemes/theories/mechanics/kepler.hpp"
#include "schemes/theories/mechanics/pendulum.hpp"
#include "schemes/theories/wave_map.hpp"
#include "tests/catch.hpp"
#include "tests/jets/catalogue.hpp"
#include "tests/jets/random.hpp"

using namespace delf;
using delf::testing::Random;

namespace {

struct Rows {
  std::vector<std::vector<Pack>> memory;
  std::vector<double*> rows;
  std::vector<const double*> constant;

  Rows(int n, int count) : memory(at(n), std::vector<Pack>(count / lanes, Pack(0.0))) {
    for (auto& row : memory) {
      rows.push_back(reinterpret_cast<double*>(row.data()));
      constant.push_back(rows.back());
    }
  }
  void fill(Random& random, double low, double high) {
    for (auto& row : memory)
      for (Pack& p : row)
        for (int l = 0; l < lanes; ++l) p.v[l] = random(low, high);
  }
};

/// The largest difference of two sets of rows, relative to the largest number.
double difference(const Rows& a, const Rows& b, int count) {
  double worst = 0, largest = 0;
  for (std::size_t r = 0; r < a.rows.size(); ++r)
    for (int i = 0; i < count; ++i) {
      const double d = std::abs(a.rows[r][i] - b.rows[r][i]);
      worst = d <= worst ? worst : d;
      largest = std::max(largest, std::abs(b.rows[r][i]));
    }
  return worst / std::max(largest, 1.0);
}

/// More packs than a block, and not a multiple of it.
constexpr int count = (2 * 64 + 3) * lanes;

/// Every number that two densities give, and all that is proved of them.
void check_same(const BatchDensity& text, const BatchDensity& compiled, double low = -1.5, double high = 1.5,
                double tolerance = 1e-14) {
  const int m = compiled.variables(), d = compiled.components();
  REQUIRE((text.components() == d && text.slots() == compiled.slots()));
  CHECK(text.is_placed() == compiled.is_placed());
  CHECK(text.nonlinearity() == compiled.nonlinearity());
  for (int a = 0; a < m; ++a) {
    CHECK(text.depends_on(a) == compiled.depends_on(a));
    for (int b = 0; b < m; ++b) {
      INFO("entry " << a << ", " << b);
      CHECK(text.is_constant(a, b) == compiled.is_constant(a, b));
      CHECK(text.is_zero(a, b) == compiled.is_zero(a, b));
    }
    CHECK(text.constant_gradient()[a] == Approx(compiled.constant_gradient()[a]).margin(tolerance));
  }
  for (std::size_t i = 0; i < compiled.constant_hessian().size(); ++i)
    CHECK(text.constant_hessian()[i] == Approx(compiled.constant_hessian()[i]).epsilon(tolerance));

  Random random(5);
  Rows jets(m, count), x(1, count);
  jets.fill(random, low, high), x.fill(random, low, high);
  const JetBatch batch{count, jets.constant.data(), 0.7, x.rows[0]};
  const auto compare = [&](const char* what, int rows, const auto& evaluate) {
    INFO(what);
    Rows of_text(rows, count), of_compiled(rows, count);
    evaluate(text, of_text.rows.data());
    evaluate(compiled, of_compiled.rows.data());
    CHECK(difference(of_text, of_compiled, count) < tolerance);
  };
  compare("value", 1, [&](const BatchDensity& D, double* const* out) { D.value(batch, out[0]); });
  compare("gradient", m, [&](const BatchDensity& D, double* const* out) { D.gradient(batch, out); });
  compare("both", m + 1, [&](const BatchDensity& D, double* const* out) { D.gradient(batch, out, out[m]); });
  compare("hessian", m * m, [&](const BatchDensity& D, double* const* out) { D.hessian(batch, out); });
  compare("slope", d, [&](const BatchDensity& D, double* const* out) { D.slope(batch, out); });
  compare("curvature", d * d, [&](const BatchDensity& D, double* const* out) { D.curvature(batch, out); });
  compare("place", 2, [&](const BatchDensity& D, double* const* out) { D.place_gradient(batch, out[0], out[1]); });
}

std::string message_of(const std::string& text, const ExpressionNames& names = {}) {
  try {
    expression(text, names);
  } catch (const BadInput& bad) {
    CHECK(bad.key() == "theory.density");
    return bad.what();
  }
  return "accepted";
}

// Written twice in the tests, as a functor and as text.
struct First {
  auto operator()(const auto& j) const {
    return exp(-(j.phi * j.phi)) * sinh(j.phi_t * j.phi_x) + tanh(j.phi) * j.phi_t * j.phi_t / (2.0 + cos(j.phi)) +
           pow(2.0 + sin(j.phi_x), 1.7) * j.phi_t - tan(0.3 * j.phi) * cosh(j.phi_x);
  }
};
struct Second {
  static constexpr int jet_order = 2, components = 2;
  static constexpr bool placed = true;
  auto operator()(const auto& j) const {
    const auto r = sqrt(1.0 + j.phi[0] * j.phi[0] + j.phi_x[1] * j.phi_x[1]);
    return 0.5 * j.phi_t[0] * j.phi_t[0] / r +
           log(2.0 + j.phi_tt[1] * j.phi_tt[1]) * j.phi_tx[0] * sin(j.x + 2.0 * j.t) -
           j.phi_xx[1] * j.phi_xx[1] * j.phi_xx[1] * r + j.phi_t[1] * j.phi_t[1] * exp(j.phi[1] / r) / (r * r * r);
  }
};

}  // namespace

TEST_CASE("every built-in density as text has the numbers and the structure of the compiled one") {
  const auto check = [](const auto& density, const char* text, const ExpressionNames& names, double low = -1.5) {
    INFO(text);
    check_same(*expression(text, names), BatchOf(density), low);
  };
  check(Wave{}, "0.5*(phi_t^2 - phi_x^2)", {});
  check(KleinGordon{1.3}, "0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*m^2*phi^2", {.parameters = {{"m", 1.3}}});
  check(SineGordon{1.2}, "phi_t^2/2 - phi_x^2/2 + m^2*(cos(phi) - 1)", {.parameters = {{"m", 1.2}}});
  check(PhiFour{0.7}, "let w = phi^2 - 1\n0.5*(phi_t^2 - phi_x^2) - lambda/4*w^2", {.parameters = {{"lambda", 0.7}}});
  check(DoubleSineGordon{1.1, 0.4}, "0.5*(phi_t^2 - phi_x^2) + m^2*(cos(phi) - 1) - 0.5*l*(1 - cos(2*phi))",
        {.parameters = {{"m", 1.1}, {"l", 0.4}}});
  check(SineGordonImpurity{1.1, 0.6, 0.8, 0.3},
        "let s = (x - x0)/w; let depth = m^2*(1 + eps*exp(-s^2)); 0.5*(phi_t^2 - phi_x^2) + depth*cosm1(phi)",
        {.parameters = {{"m", 1.1}, {"eps", 0.6}, {"w", 0.8}, {"x0", 0.3}}});
  check(CoupledSineGordon{1.3, 0.7},
        "0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) + m^2*(cos(u) + cos(v) - 2) + c*(cos(u - v) - 1)",
        {{"u", "v"}, {{"m", 1.3}, {"c", 0.7}}});
  check(ComplexKleinGordon{1.3, 0.7}, "let s = u^2 + v^2; 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2) - 0.5*m^2*s - 0.25*l*s^2",
        {{"u", "v"}, {{"m", 1.3}, {"l", 0.7}}});
  check(WaveMap{}, "0.5*(a_t^2 + b_t^2 + c_t^2 - a_x^2 - b_x^2 - c_x^2)", {{"a", "b", "c"}, {}});
  check(Pendulum{1.4}, "0.5*phi_t^2 + w^2*cosm1(phi)", {.parameters = {{"w", 1.4}}});
  check(Kepler{}, "0.5*(u_t^2 + v_t^2) + 1/sqrt(u^2 + v^2)", {{"u", "v"}, {}}, 0.3);
}

TEST_CASE("derivatives of random expressions agree with automatic differentiation and differences") {
  check_same(*expression("exp(-phi^2)*sinh(phi_t*phi_x) + tanh(phi)*phi_t^2/(2 + cos(phi)) + (2 + sin(phi_x))^1.7*phi_t"
                         " - tan(0.3*phi)*cosh(phi_x)"),
             BatchOf(First{}), -1.5, 1.5, 1e-13);
  check_same(*expression("let r = sqrt(1 + u^2 + v_x^2)\n"
                         "0.5*u_t^2/r + log(2 + v_tt^2)*u_tx*sin(x + 2*t) - v_xx^3*r + v_t^2*exp(v/r)*r^-3",
                         {{"u", "v"}, {}}),
             BatchOf(Second{}), -1.5, 1.5, 1e-13);
  // atan, which functors do not have, and exponents that vary: against central differences
  const auto l = expression("0.5*phi_t^2*atan(phi*phi_x) + (2 + phi_x^2)^(phi) + pow(2 + phi, phi_t)");
  Random random(9);
  const int m = l->variables();
  Rows jets(m, lanes), g(m, lanes), up(1, lanes), down(1, lanes), H(m * m, lanes), g_up(m, lanes), g_down(m, lanes);
  jets.fill(random, -1, 1);
  const JetBatch batch{lanes, jets.constant.data()};
  l->gradient(batch, g.rows.data());
  l->hessian(batch, H.rows.data());
  const double e = 1e-5;
  for (int a = 0; a < m; ++a) {
    const auto shift = [&](double by) {
      for (int i = 0; i < lanes; ++i) jets.rows[a][i] += by;
    };
    shift(e), l->value(batch, up.rows[0]), l->gradient(batch, g_up.rows.data());
    shift(-2 * e), l->value(batch, down.rows[0]), l->gradient(batch, g_down.rows.data());
    shift(e);
    for (int i = 0; i < lanes; ++i) {
      CHECK(g.rows[a][i] == Approx((up.rows[0][i] - down.rows[0][i]) / (2 * e)).margin(1e-8));
      for (int b = 0; b < m; ++b)
        CHECK(H.rows[a * m + b][i] == Approx((g_up.rows[b][i] - g_down.rows[b][i]) / (2 * e)).margin(1e-7));
    }
  }
}

TEST_CASE("random sums and products have the derivatives that differences have") {
  Random random(77);
  const std::vector<std::string> leaves{"phi", "phi_t", "phi_x", "x", "t", "2", "0.5", "c", "phi", "phi_t", "0", "1"};
  const std::vector<std::string> functions{"sin", "cos", "cosm1", "tanh", "atan", "exp"};
  const auto make = [&](const auto& self, int depth) -> std::string {
    const auto sub = [&] { return self(self, depth - 1); };
    if (depth == 0) return leaves[random.pick(0, 11)];
    switch (random.pick(0, 7)) {
      case 0:
        return "(" + sub() + " + " + sub() + ")";
      case 1:
        return "(" + sub() + " - " + sub() + ")";
      case 2:
        return "(" + sub() + "*" + sub() + ")";
      case 3:
        return "(" + sub() + "/(2 + sin(" + sub() + ")))";
      case 4:
        return "(-" + sub() + ")";
      case 5:
        return "sin(" + sub() + ")^3";
      default:
        return functions[random.pick(0, 5)] + "(0.3*" + sub() + ")";
    }
  };
  for (int n = 0; n < 60; ++n) {
    const std::string text = "0.5*phi_t^2 + " + make(make, 4);
    INFO(text);
    const auto l = expression(text, {.parameters = {{"c", 0.3}}});
    const int m = 3;
    Rows jets(m, lanes), x(1, lanes), g(m, lanes), H(m * m, lanes), g_up(m, lanes), g_down(m, lanes), up(1, lanes),
        down(1, lanes);
    jets.fill(random, -1, 1), x.fill(random, -1, 1);
    const JetBatch batch{lanes, jets.constant.data(), 0.4, x.rows[0]};
    l->gradient(batch, g.rows.data());
    l->hessian(batch, H.rows.data());
    const double e = 1e-5;
    bool gradients = true, hessians = true, structure = true;
    for (int a = 0; a < m; ++a) {
      const auto shift = [&](double by) {
        for (int i = 0; i < lanes; ++i) jets.rows[a][i] += by;
      };
      shift(e), l->value(batch, up.rows[0]), l->gradient(batch, g_up.rows.data());
      shift(-2 * e), l->value(batch, down.rows[0]), l->gradient(batch, g_down.rows.data());
      shift(e);
      for (int i = 0; i < lanes; ++i) {
        const double slope = (up.rows[0][i] - down.rows[0][i]) / (2 * e);
        gradients = gradients && std::abs(g.rows[a][i] - slope) < 1e-6 * (1 + std::abs(slope));
        structure = structure && (l->depends_on(a) || std::abs(slope) < 1e-7);
        for (int b = 0; b < m; ++b) {
          const double second = (g_up.rows[b][i] - g_down.rows[b][i]) / (2 * e);
          const double h = H.rows[a * m + b][i];
          hessians = hessians && std::abs(h - second) < 1e-6 * (1 + std::abs(second));
          structure = structure && (!l->is_zero(a, b) || h == 0) &&
                      (!l->is_constant(a, b) || std::abs(h - l->constant_hessian()[a * m + b]) < 1e-12);
        }
      }
    }
    CHECK(gradients);
    CHECK(hessians);
    CHECK(structure);
  }
}

TEST_CASE("precedence of operators is that of mathematics") {
  const auto value = [](const std::string& text) { return number_of(text, "test"); };
  CHECK(value("2 + 3*4 - 6/2/3") == 13);
  CHECK(value("-2^2") == -4);
  CHECK(value("2^-1") == 0.5);
  CHECK(value("2^3^2") == 512);
  CHECK(value("2*-3 + --4") == -2);
  CHECK(value("(1 + 2)*3e0 + .5 + 1.") == 10.5);
  CHECK(value("cos(pi) + sqrt(16) + pow(2, 3)") == Approx(11));
  CHECK(value("let a = 2; let b = a^2\na + b") == 6);
  CHECK(message_of("0.5*phi_t^2 + (2 + phi)^-103 + phi^-1e300") == "accepted");
}

TEST_CASE("text that is no density is refused with its place and what was expected") {
  const auto says = [](const std::string& text, const std::string& part, const ExpressionNames& names = {}) {
    const std::string message = message_of(text, names);
    INFO(text.substr(0, 200) << "\n" << message);
    CHECK(message.find(part) != std::string::npos);
    CHECK(message.size() < 400);
    CHECK(message.find('\n') == std::string::npos);
  };
  says("0.5*phi_t^2 + * 3", "density: character 15, at \"* 3\": expected a number, a name or (, found \"*\"");
  says("0.5*phi_t**2", "at \"*2\": expected a number, a name or (, found \"*\"; powers are written with ^");
  says("*phi", "density: character 1, at \"*phi\": expected a number, a name or (, found \"*\"");
  says("0.5 phi_t", "character 5, at \"phi_t\": expected an operator or the end, found \"phi_t\"");
  says("0.5*(phi_t^2", "character 13, after \"0.5*(phi_t^2\": expected an operator or ), found the end");
  says("0.5*phi_t^2)", "character 12, at \")\": expected an operator or the end, found \")\"");
  says("", "density: character 1: expected a number, a name or (, found the end");
  says("let w = phi^2\n", "line 2, character 1: expected a number, a name or (, found the end");
  says("let w = phi^2\n0.5*phi_t^2 + cos(w",
       "line 2, character 20, after \"0.5*phi_t^2 + cos(w\": expected an operator or ), found the end");
  says("let = 2\nphi", "line 1, character 5, at \"= 2\": expected a name after let");
  says("let w 2\nphi", "line 1, character 7, at \"2\": expected = after let and a name, found \"2\"");
  says("let phi = 2\nphi", "phi has a meaning already");
  says("0.5*ph_t^2", "character 5, at \"ph_t^2\": unknown name ph_t; did you mean phi_t?");
  says("0.5*phi_t^2 + sen(phi)", "unknown name sen; did you mean sin?");
  says("0.5*phi_t^2 + qwertyuiop", "unknown name qwertyuiop; known: t, x, phi");
  says("0.5*phi_t^2 + abs(phi)", "character 15, at \"abs(phi)\": abs is not differentiable");
  says("0.5*phi_t^2 + sin phi", "expected ( after the function sin");
  says("0.5*phi_t^2 + phi(2)", "phi is not a function; write * for a product");
  says("0.5*phi_t^2 + pow(phi)", "pow takes two arguments, not 1");
  says("0.5*phi_t^2 + sin(phi, 2)", "sin takes one argument, not 2");
  says("0.5*phi_t^2 + phi/0", "character 20, after \"0.5*phi_t^2 + phi/0\": division by zero");
  says("0.5*phi_t^2 + log(-1)*phi", "this is not a finite number");
  says("0.5*phi_t^2 + 1e999", "outside the range of double precision");
  says("0.5*φ_t^2", "character 5, at \"φ_t^2\": the byte 0xcf is no character of a formula");
  says(std::string("0.5*phi_t^2\0+ 1", 15), "character 12, at \"?+ 1\": the byte 0x00");
  says("0.5*phi_x^2 + phi", "does not determine the field phi: phi_t does not occur; add a term such as 0.5*phi_t^2");
  says("3", "does not determine the field phi: neither it nor its derivatives occur");
  says("phi_t + phi_x^2", "phi_t occurs only linearly");
  says("0.5*u_t^2", "does not determine the field v", {{"u", "v"}, {}});
  says("0.5*phi_t^2", "\"sin\" has a meaning already", {{"sin"}, {}});
  says("0.5*phi_t^2", "\"x\" has a meaning already", {.parameters = {{"x", 1}}});
  says("0.5*phi_t^2", "\"2a\" is no name", {.parameters = {{"2a", 1}}});
  CHECK(message_of("0.5*phi_t^2 - 0.5*phi_x^2") == "accepted");
}

TEST_CASE("no text takes long or exhausts the stack") {
  const auto begin = std::chrono::steady_clock::now();
  const std::string long_sum = [] {
    std::string text = "0.5*phi_t^2";
    for (int i = 0; i < 3000; ++i) text += " + sin(phi*" + std::to_string(i) + ")";
    return text;
  }();
  CHECK(message_of(std::string(1 << 20, '1')).find("has 1048576 characters, more than 65536") != std::string::npos);
  CHECK(message_of(std::string(100'000, '(')).find("characters, more than") != std::string::npos);
  CHECK(message_of(std::string(50'000, '(')).find("nested more than 200 deep") != std::string::npos);
  CHECK(message_of("0.5*phi_t^2 + " + std::string(60'000, '-') + "phi") == "accepted");
  CHECK(message_of("0.5*phi_t^2 + phi" + [] {
          std::string powers;
          for (int i = 0; i < 30'000; ++i) powers += "^1";
          return powers;
        }()) == "accepted");
  std::string doubling = "let a0 = phi + phi_x\n", product = "0.5*phi_t^2 + phi";
  for (int i = 1; i < 60; ++i)
    doubling += "let a" + std::to_string(i) + " = sin(a" + std::to_string(i - 1) + ")*a" + std::to_string(i - 1) + "\n";
  CHECK(message_of(doubling + "0.5*phi_t^2 + a59") == "accepted");
  for (int i = 0; i < 5'000; ++i) product += "*phi";
  CHECK(message_of(product) == "accepted");
  CHECK(message_of(long_sum) == "accepted");
  CHECK(std::chrono::steady_clock::now() - begin < std::chrono::seconds(5));  // a quarter of a second on a free core
}

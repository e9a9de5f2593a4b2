// SPDX-License-Identifier: MIT
#include "jets/expressions/equations.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <vector>

#include "jets/expressions/euler_lagrange.hpp"
#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/index.hpp"
#include "schemes/families/jet_family.hpp"
#include "tests/catch.hpp"
#include "tests/jets/expressions/random_expression.hpp"

using namespace delf;
using namespace delf::expressions;
using delf::testing::Random;
using delf::testing::random_expression;

namespace {

std::vector<std::string> continuous(const std::string& text, const ExpressionNames& names = {},
                                    Notation n = Notation::plain) {
  return field_equations(*expression(text, names), n);
}
using Lines = std::vector<std::string>;

const StencilTable& table(const std::string& name) {
  return std::ranges::find(named_tables(), name, &NamedTable::name)->table;
}

/// A printed discrete equation, its right side left out, with a name for each value that it reads: phi(j+1,i-1) → y8.
struct Discrete {
  std::string text;
  Names names;
  std::map<std::pair<int, int>, int> variable_of;  ///< of (time, space)

  explicit Discrete(std::string equation) {
    equation = equation.substr(0, equation.find(" = 0"));
    names.constants = {{"h", 0.4}, {"k", 0.7}, {"m", 1.3}};
    for (int time = -2; time <= 2; ++time)
      for (int space = -3; space <= 3; ++space) {
        const auto index = [](const char* letter, int by) {
          return letter + (by > 0 ? "+" + std::to_string(by) : by < 0 ? std::to_string(by) : std::string());
        };
        const int v = static_cast<int>(names.variables.size());
        const std::string value = "phi(" + index("j", time) + "," + index("i", space) + ")",
                          name = "y" + std::to_string(v);
        variable_of[{time, space}] = v;
        names.variables.emplace_back(name, v);
        for (std::size_t at; (at = equation.find(value)) != std::string::npos;)
          equation.replace(at, value.size(), name);
      }
    text = equation;
  }
  double operator()(const std::vector<double>& y) const {
    Graph graph;
    return Evaluation(graph, parse(graph, text, names, "test")).operator()<double>([&](int v) { return y[v]; });
  }
};

}  // namespace

TEST_CASE("field equations are written as in papers") {
  CHECK(continuous("0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)", {.parameters = {{"m", 1}}}) ==
        Lines{"phi_tt - phi_xx + m^2*sin(phi) = 0"});
  CHECK(continuous("0.5*phi_t^2 - 0.5*phi_x^2 - 0.5*phi^2*(1 - phi^2)^2") ==
        Lines{"phi_tt - phi_xx + phi*(1 - phi^2)*(1 - 3*phi^2) = 0"});
  CHECK(continuous("0.5*phi_t^2 - sqrt(1 + phi_x^2)") == Lines{"phi_tt - phi_xx/(phi_x^2 + 1)^(3/2) = 0"});
  CHECK(continuous("0.5*(u_t^2 + v_t^2) + 1/sqrt(u^2 + v^2)", {{"u", "v"}, {}}) ==
        Lines{"u_tt + u/(u^2 + v^2)^(3/2) = 0", "v_tt + v/(u^2 + v^2)^(3/2) = 0"});
  // of second order, and with a mixed term
  CHECK(continuous("0.5*phi_t^2 + phi_xx^2/2 - phi_t*phi_x + phi_x^3/6") ==
        Lines{"-phi_xxxx + phi_tt - 2*phi_tx + phi_xx*phi_x = 0"});
  // that depends on t: friction
  CHECK(continuous("exp(g*t)*(0.5*phi_t^2 + cos(phi))", {.parameters = {{"g", 1}}}).front().find("phi_tt") !=
        std::string::npos);
  CHECK(continuous("0.5*u_1_t^2 - 0.5*lambda*u_1_x^2", {{"u_1"}, {{"lambda", 1}}}, Notation::latex) ==
        Lines{"u_{1,tt} - \\lambda\\,u_{1,xx} = 0"});
  CHECK(continuous("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi)/3", {}, Notation::latex) ==
        Lines{"\\varphi_{tt} - \\varphi_{xx} + \\frac{\\sin\\left(\\varphi\\right)}{3} = 0"});
  CHECK(density_formula(*expression("0.5*phi_t^2 - sqrt(1 + phi_x^2)"), Notation::latex) ==
        "\\frac{\\varphi_{t}^{2}}{2} - \\sqrt{\\varphi_{x}^{2} + 1}");
}

TEST_CASE("equations in MathML are balanced elements, with a line for each term of a sum") {
  const std::string phi_tt = "<msub><mi>φ</mi><mrow><mi>t</mi><mi>t</mi></mrow></msub>",
                    phi_xx = "<msub><mi>φ</mi><mrow><mi>x</mi><mi>x</mi></mrow></msub>";
  CHECK(continuous("0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi)/3", {}, Notation::mathml) ==
        Lines{phi_tt + "\n<mo>−</mo>" + phi_xx +
              "\n<mo>+</mo><mfrac><mrow><mi>sin</mi><mo>\u2061</mo><mrow><mo>(</mo><mi>φ</mi><mo>)</mo></mrow></mrow>"
              "<mrow><mn>3</mn></mrow></mfrac><mo>=</mo><mn>0</mn>"});
  CHECK(
      density_formula(*expression("0.5*phi_t^2 - sqrt(1 + phi_x^2)"), Notation::mathml) ==
      "<mfrac><mrow><msup><msub><mi>φ</mi><mrow><mi>t</mi></mrow></msub><mn>2</mn></msup></mrow><mrow><mn>2</mn></mrow>"
      "</mfrac>\n<mo>−</mo><msqrt><msup><msub><mi>φ</mi><mrow><mi>x</mi></mrow></msub><mn>2</mn></msup><mo>+</mo>"
      "<mn>1</mn></msqrt>");
  // a site has its row above and its place below, and brackets where it is squared
  CHECK(mathml_name("u_1", "<mi>i</mi>", "<mi>j</mi>") ==
        "<msubsup><mi>u</mi><mrow><mn>1</mn><mo>,</mo><mi>i</mi></mrow><mrow><mi>j</mi></mrow></msubsup>");
  for (const auto& named : named_tables())
    for (const char* density : {"0.5*phi_t^2 - 0.5*phi_x^2 - 0.25*phi^4", "0.5*phi_t^2 - exp(phi_x)*x + t*atan(phi)"})
      for (const std::string& equation :
           discrete_field_equations(*expression(density), named.table, Notation::mathml)) {
        std::vector<std::string> open;
        for (std::size_t at = 0; (at = equation.find('<', at)) != std::string::npos; ++at) {
          const std::string tag = equation.substr(at + 1, equation.find('>', at) - at - 1);
          if (tag.front() != '/') open.push_back(tag);
          else {
            REQUIRE_FALSE(open.empty());
            CHECK(open.back() == tag.substr(1));
            open.pop_back();
          }
        }
        CHECK(open.empty());
      }
}

TEST_CASE("printed expressions, read again, have the same values, and so have their Euler-Lagrange equations") {
  const ExpressionNames given{.parameters = {{"c", 0.3}}};
  const JetVariables jets(given);
  Random random(8);
  constexpr int samples = 300;
  int printed_ones = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const std::string text = random_expression(random, 3);
    Graph graph;
    const int l = parse(graph, text, jets.names, "test");
    std::vector<int> sum{l};
    if (sample % 2) sum = euler_lagrange(graph, l, 0, jets);
    Sums sums(graph, [](int) { return false; });
    std::map<int, std::string> name_of;
    for (const auto& [name, variable] : jets.names.variables) name_of[variable] = name;
    for (int v = 0; v < 15; ++v)
      if (!name_of.contains(v)) name_of[v] = "q" + std::to_string(v);
    Names names;
    for (const auto& [variable, name] : name_of) names.variables.emplace_back(name, variable);
    std::string again;
    try {
      again = printed(sums, sums.of(sum), {[&](int v) { return name_of[v]; }}, Notation::plain);
    } catch (const TooLarge&) {
      continue;
    }
    ++printed_ones;
    Graph other;
    const int root = parse(other, again, names, "test");
    std::vector<double> at(20);
    for (double& x : at) x = random(-1, 1);
    const auto variable = [&](int v) { return at[v]; };
    double expected = 0, size = 1;
    for (const int node : sum) {
      const double term = Evaluation(graph, node).operator()<double>(variable);
      expected += term, size += std::abs(term);
    }
    INFO(text << "\n" << again);
    const double found = Evaluation(other, root).operator()<double>(variable);
    if (!(std::abs(found - expected) < 1e-9 * size)) CHECK(found == expected);
  }
  CHECK(printed_ones > samples / 2);
}

TEST_CASE("printed discrete equations are the sums of residuals on every stencil") {
  const auto density = expression("0.5*phi_t^2*(1 + 0.1*phi^2) - 0.5*phi_x^2 + m^2*(cos(phi) - 1) - 0.1*phi_x^4",
                                  {.parameters = {{"m", 1.3}}});
  const double h = 0.4, k = 0.7;
  Random random(12);
  for (const NamedTable& named : named_tables()) {
    INFO(named.name);
    const JetFamily family(named.table, density);
    const bool brick = named.table.pattern.placement == Placement::brick_wall;
    const std::vector<std::string> equations = discrete_field_equations(*density, named.table, Notation::plain);
    REQUIRE(equations.size() == (brick ? 2 : 1));
    for (std::size_t parity = 0; parity < equations.size(); ++parity) {
      const Discrete printed(equations[parity]);
      std::vector<double> y(printed.names.variables.size());
      for (double& value : y) value = random(-1, 1);
      // −(1/hk) Σ_{l: Δˡ = (j, i)} rˡ
      double expected = 0;
      const auto& vertices = named.table.pattern.vertices;
      for (std::size_t l = 0; l < vertices.size(); ++l) {
        if (brick && (vertices[l].time + vertices[l].space - static_cast<int>(parity)) % 2 != 0) continue;
        std::vector<double> on_stencil, r(vertices.size());
        for (const Site& v : vertices)
          on_stencil.push_back(
              y[delf::at(printed.variable_of.at({v.time - vertices[l].time, v.space - vertices[l].space}))]);
        family.residual(Cell{h, k, 0, 0}, on_stencil, r);
        expected -= r[l] / (h * k);
      }
      INFO(equations[parity]);
      CHECK(printed(y) == Approx(expected).epsilon(1e-12));
      y[printed.variable_of.at({0, 0})] += 1e-3;
      CHECK(printed(y) != Approx(expected).epsilon(1e-8));
    }
  }
}

TEST_CASE("the equation of a stencil is written with its differences") {
  const auto l = expression("0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)", {.parameters = {{"m", 1}}});
  CHECK(discrete_field_equations(*l, table("triangle-vertex"), Notation::plain) ==
        Lines{"(phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 - (phi(j,i-1) - 2*phi(j,i) + phi(j,i+1))/k^2 + "
              "m^2*sin(phi(j,i)) = 0"});
  CHECK(discrete_field_equations(*l, table("triangle-vertex"), Notation::latex) ==
        Lines{"\\frac{1}{h^{2}}\\left(\\varphi_{i}^{j+1} - 2\\,\\varphi_{i}^{j} + \\varphi_{i}^{j-1}\\right) - "
              "\\frac{1}{k^{2}}\\left(\\varphi_{i-1}^{j} - 2\\,\\varphi_{i}^{j} + \\varphi_{i+1}^{j}\\right) + "
              "m^{2}\\,\\sin\\left(\\varphi_{i}^{j}\\right) = 0"});
}

TEST_CASE("a constraint is in the equations, with its multiplier") {
  const auto l = expression("0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2)", {{"u", "v"}, {}}, "theory.density",
                            {.constraint = "u^2 + v^2 - 1"});
  CHECK(field_equations(*l, Notation::plain) ==
        Lines{"u_tt - u_xx - 2*u*lambda = 0", "v_tt - v_xx - 2*v*lambda = 0", "u^2 + v^2 - 1 = 0"});
  CHECK(discrete_field_equations(*l, table("triangle-vertex"), Notation::plain)
            .front()
            .ends_with(" - 2*lambda(j,i)*u(j,i) = 0"));
  CHECK(l->symmetries().empty());  // shifts lead off it
}

TEST_CASE("what would be pages long is said to be") {
  std::string doubling = "let a0 = phi + phi_x\n";
  for (int i = 1; i < 40; ++i)
    doubling += "let a" + std::to_string(i) + " = sin(a" + std::to_string(i - 1) + ")*a" + std::to_string(i - 1) + "\n";
  CHECK(continuous(doubling + "0.5*phi_t^2 + a39") == Lines{"too large to be written here"});
}

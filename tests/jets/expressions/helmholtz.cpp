// SPDX-License-Identifier: MIT
#include "jets/expressions/helmholtz.hpp"

#include <string>

#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

std::string refusal(const auto& what) {
  try {
    what();
  } catch (const BadInput& bad) {
    CHECK(bad.key() == "theory.equation");
    return bad.what();
  }
  return "accepted";
}
std::string has_lagrangian(const std::string& equations, const ExpressionNames& names = {}) {
  return refusal([&] { require_lagrangian(equations, names, "theory.equation"); });
}
std::string compared(const std::string& equations, const std::string& density, const ExpressionNames& names = {}) {
  return refusal([&] { require_field_equations(equations, density, names, "theory.equation"); });
}
void check_says(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find(part) != std::string::npos);
}
const ExpressionNames uv{{"u", "v"}, {{"c", 0.5}}};

}  // namespace

TEST_CASE("Helmholtz's conditions tell equations that a density has from others") {
  // ½φ_t² − ½φ_x² + cos φ; a force by t; ½(1 + φ²)φ_t²; friction and a slope in x with their factors
  for (const char* equation :
       {"phi_tt - phi_xx + sin(phi) = 0", "phi_tt + sin(phi) = 1.15*cos(0.66*t)", "(1 + phi^2)*phi_tt + phi*phi_t^2",
        "exp(0.1*t)*(phi_tt + 0.1*phi_t + sin(phi))", "exp(x)*(phi_xx + phi_x) = exp(x)*phi_tt"})
    CHECK(has_lagrangian(equation) == "accepted");
  // √(5 + φ_x² − φ_t²) gives the second of these, the first lacks its factor, and in the third a 5 is a 1
  CHECK(has_lagrangian("(5 + phi_x^2)*phi_tt - 2*phi_t*phi_x*phi_tx - (5 - phi_t^2)*phi_xx") != "accepted");
  CHECK(has_lagrangian("((5 + phi_x^2)*phi_tt - 2*phi_t*phi_x*phi_tx - (5 - phi_t^2)*phi_xx)*"
                       "pow(5 + phi_x^2 - phi_t^2, -1.5)") == "accepted");
  CHECK(has_lagrangian("((1 + phi_x^2)*phi_tt - 2*phi_t*phi_x*phi_tx - (5 - phi_t^2)*phi_xx)*"
                       "pow(5 + phi_x^2 - phi_t^2, -1.5)") != "accepted");
}

TEST_CASE("a damped and driven pendulum is refused with the reason, several fields by the pair") {
  const std::string damped = has_lagrangian("phi_tt + 0.1*phi_t + sin(phi) = 1.15*cos(0.66*t)");
  check_says(damped, "no Lagrangian density has this equation: its coefficient of phi_t is 1/10");
  check_says(damped, "would have to be 0 (friction)");
  check_says(has_lagrangian("phi_tt - phi_xx + 0.3*phi_x"), "its coefficient of phi_x is 3/10");
  CHECK(has_lagrangian("u_tt + u - c*v; v_tt + v - c*u", uv) == "accepted");
  CHECK(has_lagrangian("u_tt - c*v_t; v_tt + c*u_t", uv) == "accepted");  // a magnetic field
  check_says(has_lagrangian("u_tt - c*v_t; v_tt - c*u_t", uv), "that of u changes with v_t");
  check_says(has_lagrangian("u_tt + u - c*v; v_tt + v + c*u", uv), "that of u changes with v (-c)");
  check_says(has_lagrangian("u_tt", uv), "has 1 equation for 2 fields");
  check_says(has_lagrangian("log(-1 - phi^2)*phi_tt"), "has no value at any jet");
  check_says(has_lagrangian("phi_tt + phi = 0 = 1"), "at \"= 1\"");
}

TEST_CASE("equations are compared with those of a density, up to a factor") {
  const std::string density = "0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi)";
  CHECK(compared("phi_tt - phi_xx + sin(phi) = 0", density) == "accepted");
  CHECK(compared("-2*phi_tt = 2*sin(phi) - 2*phi_xx", density) == "accepted");
  check_says(compared("phi_tt - phi_xx - sin(phi) = 0", density), "which is phi_tt - phi_xx + sin(phi) = 0");
  check_says(compared("phi_tt - phi_xx + phi = 0", density), "correct one of them");
  check_says(compared("0*phi", density), "correct one of them");
}

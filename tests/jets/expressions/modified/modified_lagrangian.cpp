// SPDX-License-Identifier: MIT
#include "jets/expressions/modified/modified_lagrangian.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "jets/tables/named_tables.hpp"
#include "jets/tables/pair_element.hpp"
#include "jets/tables/spacetime_element.hpp"
#include "jets/tables/splitting.hpp"
#include "lattice/error.hpp"
#include "tests/catch.hpp"

using namespace delf;
using expressions::Notation;

namespace {

const StencilTable& table(const std::string& name) {
  return std::ranges::find(named_tables(), name, &NamedTable::name)->table;
}

using Terms = std::map<std::pair<int, int>, std::string>;  ///< of h^a k^b

Terms terms_of(const std::vector<ModifiedLagrangian::Part>& parts) {
  Terms terms;
  for (const auto& part : parts) {
    std::string text = part.numerator;
    if (part.denominator != 1) text = "(" + text + ")/" + std::to_string(static_cast<int>(part.denominator));
    terms[{part.in_h, part.in_k}] = text;
  }
  return terms;
}
Terms modified(const StencilTable& stencil, const std::string& density, int order, ExpressionNames names = {}) {
  if (names.parameters.empty()) names.parameters = {{"m", 1.3}};
  return terms_of(ModifiedLagrangian(*expression(density, names), stencil, order).parts(Notation::plain));
}
/// The key that a refusal names, and what it says.
std::string refusal(const StencilTable& stencil, const std::string& density, int order,
                    const ExpressionNames& names = {}) {
  try {
    modified(stencil, density, order, names);
  } catch (const BadInput& bad) {
    return bad.key() + ": " + bad.what();
  }
  return "none";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

constexpr auto wave = "0.5*phi_t^2 - 0.5*phi_x^2";
constexpr auto sine_gordon = "0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)";
constexpr auto oscillator = "0.5*phi_t^2 - 0.5*m^2*phi^2";

}  // namespace

// The rows of leapfrog on the oscillator are samples of cos ωt with sin(ωh/2) = mh/2, and its action has −q₀q₁/h, which that of
// K(q̇² − ω²q²)/2 has as −Kω q₀q₁/sin ωh:
//
//     ω² = m² (1 + u/12 + u²/90 + u³/560 + …)      K = sin(ωh)/(ωh) = 1 − u/6 − u²/180 − u³/1512 − …       u = m²h²
//
TEST_CASE("the modified Lagrangian of leapfrog on the harmonic oscillator is that of its exact solution") {
  const Terms expected{{{0, 0}, "phi_t^2/2 - m^2*phi^2/2"},
                       {{2, 0}, "(-2*m^2*phi_t^2 + m^4*phi^2)/24"},
                       {{4, 0}, "(-2*m^4*phi_t^2 + 3*m^6*phi^2)/720"}};
  CHECK(modified(table("trapezoidal"), oscillator, 4) == expected);
  // half a step off is a divergence, and one sub-step is leapfrog; (q₁² − q₀²)/h is one too
  CHECK(modified(table("vertex"), oscillator, 4) == expected);
  CHECK(modified(splitting_element(splitting_of_order(2)), oscillator, 4) == expected);
  CHECK(modified(table("midpoint"), oscillator, 4) != expected);
}

// A mode cos qx of (5.12) on the wave equation has T = cos²(qk/2) and U = 4 sin²(qk/2)/k² in T ẏ²/2 − U y²/2 by the midpoint rule:
//
//     tan(ωh/2)/h = tan(qk/2)/k      K = (T + Uh²/4) sin(ωh)/(ωh)       K/2 the coefficient of φ_t², Kω²/2 that of −φ²
//
//     K/2 = 1/2 + q²(h² − 3k²)/24 + q⁴(−8h⁴ − 10h²k² + 30k⁴)/2880 + …
//     Kω²/2 = q²/2 − q⁴(h² + k²)/24 + q⁶(18h⁴ − 10h²k² + 4k⁴)/2880 + …
//
TEST_CASE("the modified Lagrangian of (5.12) on the wave equation is that of its dispersion relation") {
  CHECK(modified(table("rectangle-symmetric"), wave, 4) == Terms{{{0, 0}, "phi_t^2/2 - phi_x^2/2"},
                                                                 {{2, 0}, "(phi_tx^2 + phi_xx^2)/24"},
                                                                 {{0, 2}, "(-3*phi_tx^2 + phi_xx^2)/24"},
                                                                 {{4, 0}, "(-4*phi_txx^2 - 9*phi_xxx^2)/1440"},
                                                                 {{2, 2}, "(-phi_txx^2 + phi_xxx^2)/288"},
                                                                 {{0, 4}, "(15*phi_txx^2 - 2*phi_xxx^2)/1440"}});
}

// By hand, for ℓ = φ_t²/2 − φ_x²/2 + N(φ) on the triangle. Up to divergences its differences and the centroid give
//
//     −h² φ_tt²/24 + k² φ_xx²/24 − N″ (h² φ_t² + hk φ_t φ_x + k² φ_x²)/9
//
// for the vertices have the second moments 2h²/9, hk/9, 2k²/9 about the centroid. E = φ_tt − φ_xx − N′ is zero on solutions, E²
// twice so, which changes no equation to this order:
//
//     φ_tt² = E² + 2(φ_xx + N′) φ_tt − (φ_xx + N′)²  →  2φ_tx² − 2N″φ_t² − φ_xx² + 2N″φ_x² − N′²
//
// With N = m²(cos φ − 1), N′ = −m² sin φ, N″ = −m² cos φ:
TEST_CASE("the modified Lagrangian of the triangle is the one derived by hand") {
  CHECK(modified(table("triangle"), sine_gordon, 2) ==
        Terms{{{0, 0}, "phi_t^2/2 - phi_x^2/2 + m^2*cos(phi) - m^2"},
              {{2, 0},
               "(-6*phi_tx^2 + 3*phi_xx^2 + 2*m^2*phi_t^2*cos(phi) + 6*m^2*phi_x^2*cos(phi) + 3*m^4*sin(phi)^2)/72"},
              {{1, 1}, "(m^2*phi_t*phi_x*cos(phi))/9"},
              {{0, 2}, "(3*phi_xx^2 + 8*m^2*phi_x^2*cos(phi))/72"}});
}

// Bricks read φ ± ψ. Their φ_t make 2ψ²/h² of it, and the mean of six values N′(φ)(ψ_j − ψ_{j+1})/6 = −(h/6) N′(φ) ψ_t:
//
//     4ψ/h² + (h/6) D_t N′ = 0,    ψ = −(h³/24) N″ φ_t
//
TEST_CASE("the two kinds of sites of a brick wall differ by what their equations say") {
  const ModifiedLagrangian bricks(*expression(sine_gordon, {.parameters = {{"m", 1.3}}}), table("hexagon"), 4);
  CHECK(terms_of(bricks.between_kinds(0, Notation::plain)) == Terms{{{3, 0}, "(m^2*phi_t*cos(phi))/24"}});
  const ModifiedLagrangian other(*expression(sine_gordon, {.parameters = {{"m", 1.3}}}), table("rectangle"), 4);
  CHECK(other.between_kinds(0, Notation::plain).empty());
}

TEST_CASE("methods of order four have no terms of order two") {
  const std::string pendulum = "0.5*phi_t^2 + m^2*cos(phi)";
  const LineRule nodes = lobatto_rule(3);
  for (const StencilTable& four : {splitting_element(splitting_of_order(4)),
                                   time_element(lagrange_basis(nodes.points), nodes, Continuity::shared)}) {
    CHECK(modified(four, pendulum, 2).size() == 1);
    const Terms terms = modified(four, pendulum, 4);
    CHECK(terms.size() == 2);
    CHECK(terms.contains({4, 0}));
  }
  const Terms pairs = modified(pair_element(splitting_of_order(2), 2), wave, 4);
  CHECK_FALSE(pairs.contains({0, 2}));
  CHECK(pairs.at({0, 4}) == "(phi_xxx^2)/180");  // 4/3 and −1/3 of neighbours: −2q⁶k⁴/180 in ω²
  const Terms element = modified(spacetime_element(1, 2, TimeQuadrature::lobatto), wave, 4);
  CHECK_FALSE(element.contains({0, 2}));
}

// h²/24 (|V′|² − 2 q̇ᵀ V″ q̇) with V = g|q|⁴/4, V′ = g|q|²q, V″ = g(|q|² + 2qqᵀ)
TEST_CASE("the modified Lagrangian of leapfrog in the plane is that of force and Hessian") {
  const ExpressionNames plane{.fields = {"u", "v"}, .parameters = {{"g", 2}}};
  CHECK(modified(table("trapezoidal"), "0.5*(u_t^2 + v_t^2) - g*(u^2 + v^2)^2/4", 2, plane).at({2, 0}) ==
        "(-8*g*u_t*v_t*u*v - 6*g*u_t^2*u^2 - 2*g*u_t^2*v^2 - 2*g*v_t^2*u^2 - 6*g*v_t^2*v^2 + 3*g^2*u^2*v^4 + "
        "3*g^2*u^4*v^2 + g^2*u^6 + g^2*v^6)/24");
}

TEST_CASE("what has no modified Lagrangian of first order in time is refused in one line") {
  CHECK(
      says(refusal(table("nine-tuple"), wave, 2), "lattice.stencil: no modified Lagrangian: the stencil reads 3 rows"));
  CHECK(says(refusal(spacetime_element(2, 2, TimeQuadrature::lobatto), wave, 2),
             "nodes inside a cell in time and in space both"));
  CHECK(says(refusal(table("hexagon"), sine_gordon, 6), "ask for order 2"));
  const ExpressionNames two{.fields = {"u", "v"}};
  CHECK(says(refusal(table("rectangle"), "0.5*(u*v_t - v*u_t) - 0.5*(u_x^2 + v_x^2)", 2, two),
             "theory.density: no modified Lagrangian: the density is not of second order in the time derivatives"));
  CHECK(says(refusal(table("six-tuple"), "0.5*phi_t^2 - 0.5*phi_x^2 + 0.1*phi_tx^2", 2), "phi_tx"));
}

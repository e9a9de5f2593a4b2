// SPDX-License-Identifier: MIT
#include "schemes/families/lagrangian_family.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "tests/catch.hpp"
#include "tests/schemes/families/random_stencil.hpp"

using namespace delf;
using delf::testing::Random;
using delf::testing::RandomStencil;

namespace {

constexpr Cell cell{0.7, 1.3, 0.4, -0.2};

struct Defects {
  double residual = 0, jacobian = 0;
};
/// The largest differences of residual and Jacobian to central differences of fourth order of L and of the residual.
/// Those are exact for polynomials of degree 4, so that the increment may be large and only rounding is left.
template <class L>
Defects against_differences(const LagrangianFamily<L>& family, Random& random) {
  constexpr double e = 0.25;
  const std::size_t n = family.size();
  std::vector<double> y(n), r(n), J(n * n), moved(n);
  for (double& v : y) v = random(-1, 1);
  family.residual(cell, y, r);
  family.jacobian(cell, y, J);
  Defects worst;
  for (std::size_t j = 0; j < n; ++j) {
    std::vector<double> by_y(n, 0.0);
    double slope = 0;
    for (const auto& [step, weight] : {std::pair{1, 8.0}, {-1, -8.0}, {2, -1.0}, {-2, 1.0}}) {
      std::vector<double> to = y;
      to[j] += step * e;
      slope += weight / (12 * e) * *family.lagrangian(cell, to);
      family.residual(cell, to, moved);
      for (std::size_t i = 0; i < n; ++i) by_y[i] += weight / (12 * e) * moved[i];
    }
    worst.residual = std::max(worst.residual, std::abs(r[j] - slope));
    for (std::size_t i = 0; i < n; ++i) worst.jacobian = std::max(worst.jacobian, std::abs(J[i * n + j] - by_y[i]));
  }
  return worst;
}

/// A sum of squares of whatever values it is told to read, on two vertices.
struct Squares {
  std::vector<VertexValue> read;
  StencilPattern pattern() const { return StencilPattern({{0, 0}, {1, 0}}); }
  std::vector<VertexValue> values() const { return read; }
  template <class T>
  T operator()(std::span<const T> y, const Cell&) const {
    T sum(0.0);
    for (const T& v : y) sum += v * v;
    return sum;
  }
};

/// A Lagrangian whose derivatives are those of something else.
struct Wrong : RandomStencil {
  using RandomStencil::RandomStencil;
  template <class T>
  T operator()(std::span<const T> y, const Cell& at) const {
    const T value = RandomStencil::operator()(y, at);
    if constexpr (requires { value.d; }) return value + 1e-6 * y[0];
    else return value;
  }
};

/// What a refusal says, or "" if there was none.
std::string refusal(std::vector<VertexValue> values) {
  try {
    LagrangianFamily<Squares> family(Squares{std::move(values)});
  } catch (const BadInput& error) {
    CHECK(error.key() == "lattice.stencil");
    return error.what();
  }
  return "";
}
bool says(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

}  // namespace

TEST_CASE("residual and Jacobian of random stencils are the derivatives of their Lagrangians") {
  Random random(41);
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    const LagrangianFamily family{RandomStencil(seed)};
    const Defects worst = against_differences(family, random);
    CHECK(worst.residual < 1e-12);
    CHECK(worst.jacobian < 1e-12);
  }
}

TEST_CASE("the comparison can fail: a Lagrangian that differentiates to something else is found") {
  Random random(42);
  CHECK(against_differences(LagrangianFamily{Wrong(1)}, random).residual > 1e-7);
}

TEST_CASE("random stencils are what they say: distinct offsets on two rows or three, the same for the same seed") {
  std::set<int> sizes;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    const RandomStencil stencil(seed);
    const auto& vertices = stencil.shape.vertices;
    sizes.insert(stencil.shape.size());
    CHECK(std::set<Site>(vertices.begin(), vertices.end()).size() == vertices.size());
    const auto [first, last] = std::ranges::minmax(vertices, {}, &Site::time);
    CHECK((first.time >= 0 && first.time < last.time && last.time <= 2));
    CHECK(std::ranges::all_of(vertices, [](Site s) { return -1 <= s.space && s.space <= 1; }));
    const RandomStencil again(seed);
    CHECK((again.shape.vertices == vertices && again.quadratic == stencil.quadratic));
  }
  CHECK(sizes == std::set<int>{3, 4, 5, 6, 7, 8, 9});
}

TEST_CASE("a family of a stencil Lagrangian has its pattern and its values") {
  const RandomStencil stencil(5);
  const LagrangianFamily family{stencil};
  CHECK(family.pattern().vertices == stencil.shape.vertices);
  CHECK(family.values() == stencil.values());
  CHECK(family.is_variational());
  CHECK(family.sources() == nullptr);
  std::vector<double> y(family.size(), 0.5);
  CHECK(family.lagrangian(cell, y) == stencil(std::span<const double>(y), cell));
}

TEST_CASE("values that the pattern does not have, or that are named twice, are refused") {
  CHECK(refusal({{0, 0}, {1, 0}, {1, 3}}) == "");
  CHECK(says(refusal({}), "reads no values"));
  CHECK(says(refusal({{0, 0}, {2, 1}}), "component 1 at vertex 2, but its pattern has 2 vertices"));
  CHECK(says(refusal({{-1, 0}}), "vertex -1, but its pattern has 2 vertices"));
  CHECK(says(refusal({{0, 0}, {1, -2}}), "component -2 at vertex 1; count components from 0"));
  CHECK(says(refusal({{0, 0}, {1, 0}, {0, 0}}), "component 0 at vertex 0 twice"));
}

// SPDX-License-Identifier: MIT
#include "schemes/system/lattice_system.hpp"

#include <map>
#include <numbers>
#include <set>

#include "schemes/theories/sine_gordon.hpp"
#include "schemes/theories/wave.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr int N = 12;
constexpr double h = 0.3, k = 0.5, m = 1.2;
const Lattice ring = Lattice::circle(N, N* k);

// ---- the paper's equations, (5.15) with the divisions it lacks, of y(j, i) relative to a site;
// N = m²(cos φ − 1), or 0

using Field = std::function<double(int j, int i)>;
using Equation = std::function<double(const Field&)>;

double d2k(const Field& y, int j) { return (y(j, 1) - 2 * y(j, 0) + y(j, -1)) / (k * k); }
double d2h(const Field& y, int i) { return (y(1, i) - 2 * y(0, i) + y(-1, i)) / (h * h); }
double d2k_averaged(const Field& y) { return d2k(y, 1) / 4 + d2k(y, 0) / 2 + d2k(y, -1) / 4; }
double potential(double y, double mass) { return mass * mass * (std::cos(y) - 1); }
double slope(double y, double mass) { return -mass * mass * std::sin(y); }
/// (N(a) − N(b))/(a − b)
double quotient(double a, double b, double mass) { return (potential(a, mass) - potential(b, mass)) / (a - b); }

/// The triangle's centroid mean with lower left vertex (j, i), and the rectangle's.
double centroid(const Field& y, int j, int i) { return (y(j, i) + y(j + 1, i) + y(j + 1, i + 1)) / 3; }
double middle(const Field& y, int j, int i) { return (y(j, i) + y(j + 1, i) + y(j + 1, i + 1) + y(j, i + 1)) / 4; }
double mean_slope(const Field& y, double mass) {
  return (slope(middle(y, 0, 0), mass) + slope(middle(y, -1, 0), mass) + slope(middle(y, -1, -1), mass) +
          slope(middle(y, 0, -1), mass)) /
         4;
}

std::map<std::string, Equation> printed(double mass) {
  return {
      {"triangle",  // (5.8)
       [mass](const Field& y) {
         return d2k(y, 0) - d2h(y, 0) +
                (slope(centroid(y, 0, 0), mass) + slope(centroid(y, -1, 0), mass) + slope(centroid(y, -1, -1), mass)) /
                    3;
       }},
      {"triangle-vertex", [mass](const Field& y) { return d2k(y, 0) - d2h(y, 0) + slope(y(0, 0), mass); }},
      {"rectangle", [mass](const Field& y) { return d2k_averaged(y) - d2h(y, 0) + mean_slope(y, mass); }},  // (5.10)
      {"rectangle-symmetric",                                                                               // (5.12)
       [mass](const Field& y) {
         return d2k_averaged(y) - (d2h(y, 1) / 4 + d2h(y, 0) / 2 + d2h(y, -1) / 4) + mean_slope(y, mass);
       }},
      {"nine-tuple",
       [mass](const Field& y) {
         return d2k_averaged(y) - (d2h(y, 1) / 4 + d2h(y, 0) / 2 + d2h(y, -1) / 4) + mean_slope(y, mass);
       }},
      {"six-tuple",  // (5.10), with the potential on the vertical edges
       [mass](const Field& y) {
         return d2k_averaged(y) - d2h(y, 0) +
                (slope((y(1, 0) + y(0, 0)) / 2, mass) + slope((y(0, 0) + y(-1, 0)) / 2, mass)) / 2;
       }},
      {"vu-quoc-li",  // (5.14)
       [mass](const Field& y) {
         return d2k_averaged(y) - d2h(y, 0) +
                (quotient(y(1, 0), y(0, 0), mass) + quotient(y(0, 0), y(-1, 0), mass)) / 2;
       }},
      {"guo",  // (5.15)
       [mass](const Field& y) { return d2k(y, 0) - d2h(y, 0) + quotient(y(1, 0), y(-1, 0), mass); }}};
}

/// Hexagons: (5.10) and the mean of N′ over the three bricks that meet in the site; which three depends on its parity.
double brick(const Field& y, int j, int i) {
  double sum = 0;
  for (int c = 0; c < 3; ++c) sum += y(j, i + c) + y(j + 1, i + c);
  return sum / 6;
}
double printed_hexagon(const Field& y, bool even, double mass) {
  const double bricks =
      even ? slope(brick(y, 0, 0), mass) + slope(brick(y, 0, -2), mass) + slope(brick(y, -1, -1), mass)
           : slope(brick(y, 0, -1), mass) + slope(brick(y, -1, 0), mass) + slope(brick(y, -1, -2), mass);
  return d2k_averaged(y) - d2h(y, 0) + bricks / 3;
}

/// The largest |E/hk − printed| over the sites of random rows, relative to the largest term 2|y|/h².
double against_print(const LatticeSystem& system,
                     const std::function<double(const Field&, int site, int row)>& equation) {
  Random random(31);
  double worst = 0;
  for (int n = 0; n < 5; ++n) {
    Window window{&ring, 1, 0, -2, {}};
    for (int j = 0; j < 5; ++j) window.rows.push_back(random_row(random, N, 3));
    for (int row : {0, 1})
      for (int i = 0; i < N; ++i) {
        const Field y = [&](int j, int s) { return window(row + j, i + s, 0); };
        const double E = equation_at(system, window, row, i).sum / (h * k);
        worst = std::max(worst, std::abs(E - equation(y, i, row)) / (6 / (h * h)));
      }
  }
  return worst;
}
double against_print(const std::string& scheme, const Problem& p, const Equation& equation) {
  return against_print(LatticeSystem(ring, {family_of(p, scheme)}, h),
                       [&](const Field& y, int, int) { return equation(y); });
}

/// ∂E/∂y(j, i) of a printed equation, at a field of zeros: all of the linear equations' coefficients.
std::map<Site, double> coefficients(const Equation& equation) {
  std::map<Site, double> result;
  for (int j = -2; j <= 2; ++j)
    for (int i = -2; i <= 2; ++i) {
      const double c = equation([&](int a, int b) { return a == j && b == i ? 1.0 : 0.0; });
      if (std::abs(c) > 1e-12) result[{j, i}] = c;
    }
  return result;
}

/// Whether the linearised equation at the site has these coefficients and no others, relative to 2/h².
bool has_coefficients(const LatticeSystem& system, Site site, const std::map<Site, double>& expected) {
  const auto found = system.linearised(site, 0);
  bool same = found.size() == expected.size();
  for (const Coefficient& c : found)
    same = same && expected.contains(c.offset) && c.dependence == Dependence::linear &&
           std::abs(c.value / (h * k) - expected.at(c.offset)) < 1e-13 * 2 / (h * h);
  return same;
}

Problem sine_gordon() {
  Problem p;
  p.theory = "sine-gordon", p.parameters["theory.mass"] = m;
  return p;
}
Problem wave() {
  Problem p;
  p.theory = "wave";
  return p;
}

/// Sine-Gordon with the sign of the gradient term wrong.
struct Planted {
  auto operator()(const auto& j) const {
    return 0.5 * (j.phi_t * j.phi_t + j.phi_x * j.phi_x) + (m * m) * (cos(j.phi) - 1.0);
  }
};

/// Two components that turn each other.
struct Two {
  static constexpr int components = 2;
  auto operator()(const auto& j) const {
    return j.phi_t[0] * j.phi_t[1] - j.phi_x[0] * j.phi_x[1] + cos(j.phi[0] - j.phi[1]);
  }
};

}  // namespace

TEST_CASE("for N = 0 the generated equations are (5.8), (5.10), (5.12), (5.14), (5.15), coefficient by coefficient") {
  Equation without_potential = [](const Field& y) { return d2k(y, 0) - d2h(y, 0); };
  for (const auto& [scheme, equation] : printed(0)) {
    CAPTURE(scheme);
    const LatticeSystem system(ring, {family_of(wave(), scheme)}, h);
    // the quotients are 0/0 at a field of zeros: without N the comparators are (5.10) and (5.8)
    const Equation linear = scheme == "guo"          ? without_potential
                            : scheme == "vu-quoc-li" ? printed(0)["rectangle"]
                                                     : equation;
    CHECK(has_coefficients(system, {0, 5}, coefficients(linear)));
  }
}

TEST_CASE("the hexagon for N = 0 is (5.10) at every site, coefficient by coefficient, and the six-tuple is too") {
  const auto expected = coefficients(printed(0)["rectangle"]);
  CHECK(expected.size() == 9);
  const LatticeSystem hexagons(ring, {family_of(wave(), "hexagon")}, h);
  for (int j : {0, 1})
    for (int i = 0; i < 4; ++i) CHECK(has_coefficients(hexagons, {j, i}, expected));
  CHECK(has_coefficients(LatticeSystem(ring, {family_of(wave(), "six-tuple")}, h), {0, 5}, expected));
}

TEST_CASE("the coefficients can be seen to differ: the rectangle's are not the symmetric rectangle's") {
  const LatticeSystem system(ring, {family_of(wave(), "rectangle")}, h);
  CHECK(has_coefficients(system, {0, 5}, coefficients(printed(0)["rectangle"])));
  CHECK_FALSE(has_coefficients(system, {0, 5}, coefficients(printed(0)["rectangle-symmetric"])));
  CHECK_FALSE(has_coefficients(system, {0, 5}, coefficients(printed(0)["triangle"])));
}

TEST_CASE("for sine-Gordon the generated equations are the printed ones on random fields") {
  for (const auto& [scheme, equation] : printed(m)) {
    CAPTURE(scheme);
    CHECK(against_print(scheme, sine_gordon(), equation) < 1e-13);
  }
  const LatticeSystem hexagons(ring, {family_of(sine_gordon(), "hexagon")}, h);
  CHECK(against_print(hexagons, [](const Field& y, int site, int row) {
          return printed_hexagon(y, (site + row) % 2 == 0, m);
        }) < 1e-13);
}

TEST_CASE("the nine-tuple's equation is (5.12), and neither is the rectangle's") {
  CHECK(against_print("nine-tuple", sine_gordon(), printed(m)["rectangle-symmetric"]) < 1e-13);
  CHECK(against_print("rectangle", sine_gordon(), printed(m)["rectangle-symmetric"]) > 1e-3);
}

TEST_CASE("the comparison can fail: a sign planted in one term of the Lagrangian is found on every stencil") {
  for (const auto& [scheme, equation] : printed(m))
    if (const auto family = TheoryOf<Planted>(Planted{}).variational(scheme)) {
      CAPTURE(scheme);
      CHECK(against_print(LatticeSystem(ring, {family}, h), [&](const Field& y, int, int) { return equation(y); }) >
            1e-2);
    }
}

TEST_CASE("a difference quotient of equal values is N′, where the quotient itself loses everything") {
  // rows j−1, j and j+1 alike: (5.14) and (5.15) have N′(y) exactly
  Window window{&ring, 1, 0, -1, {}};
  Random random(32);
  window.rows.assign(3, random_row(random, N, 3));
  for (const char* scheme : {"vu-quoc-li", "guo"}) {
    const LatticeSystem system(ring, {family_of(sine_gordon(), scheme)}, h);
    for (int i = 0; i < N; ++i) {
      const Field y = [&](int j, int s) { return window(j, i + s, 0); };
      CHECK(std::abs(equation_at(system, window, 0, i).sum / (h * k) - (d2k(y, 0) + slope(y(0, 0), m))) <
            1e-13 * 6 / (h * h));
    }
  }
}

TEST_CASE("coefficients that the potential touches are nonlinear, those that cancel are absent") {
  const auto dependence = [](const char* scheme) {
    std::map<Site, Dependence> result;
    for (const Coefficient& c : LatticeSystem(ring, {family_of(sine_gordon(), scheme)}, h).linearised({0, 5}, 0))
      result[c.offset] = c.dependence;
    return result;
  };
  const auto vertex = dependence("triangle-vertex");
  CHECK(vertex.size() == 5);
  for (const auto& [offset, what] : vertex) CHECK((what == Dependence::nonlinear) == (offset == Site{0, 0}));
  const auto triangle = dependence("triangle");
  CHECK(triangle.size() == 7);  // the corners (1, 1) and (−1, −1) through the centroids
  CHECK(triangle.contains({1, 1}));
  CHECK_FALSE(triangle.contains({1, -1}));
  CHECK(dependence("rectangle").size() == 9);
  CHECK(dependence("nine-tuple").size() == 9);  // of 25: the rest cancels
  // at h = k the unknown row of (5.12) has no linear part beside its own site
  const LatticeSystem square(ring, {family_of(sine_gordon(), "rectangle-symmetric")}, k);
  for (const Coefficient& c : square.linearised({0, 5}, 0))
    if (c.offset.time == 1 && c.offset.space != 0) CHECK(c.value == 0);
}

TEST_CASE("what is nonlinear is found on the finest lattices too, and nothing else is") {
  const auto nonlinear = [](const Problem& problem, const std::string& scheme, double sites) {
    const double fine = 40 / sites, step = fine / 8;
    const LatticeSystem system(Lattice::circle(N, N * fine), {family_of(problem, scheme)}, step);
    std::set<Site> found;
    for (const Coefficient& c : system.linearised({0, 5}, 0))
      if (c.dependence == Dependence::nonlinear) found.insert(c.offset);
    return found;
  };
  for (const std::string scheme :
       {"triangle", "rectangle", "rectangle-symmetric", "triangle-vertex", "guo", "vu-quoc-li"}) {
    CAPTURE(scheme);
    const auto expected = nonlinear(sine_gordon(), scheme, 255);
    CHECK_FALSE(expected.empty());
    for (double sites : {1e6, 1e7, 3e7}) {
      CAPTURE(sites);
      CHECK(nonlinear(sine_gordon(), scheme, sites) == expected);
      CHECK(nonlinear(problem_of("klein-gordon"), scheme, sites).empty());
    }
  }
}

TEST_CASE("the Jacobian of the equations is that of finite differences, across the seam too") {
  Random random(33);
  for (const std::string& scheme :
       {std::string("triangle"), std::string("rectangle"), std::string("hexagon"), std::string("vu-quoc-li")}) {
    CAPTURE(scheme);
    const LatticeSystem system(ring, {family_of(sine_gordon(), scheme)}, h);
    Window window{&ring, 1, 2 * std::numbers::pi, -2, {}};
    for (int j = 0; j < 5; ++j) window.rows.push_back(random_row(random, N, 3));
    for (int i : {0, 5, N - 1}) {
      std::vector<MatrixEntry> entries;
      system.jacobian(window, 0, i, 0, 1, h, entries);
      Row by_entries(N), by_difference(N);
      for (const auto& e : entries) {
        CHECK(e.row == i);
        by_entries[e.column] += e.value;
      }
      for (std::size_t s = 0; s < N; ++s) {
        constexpr double e = 1e-4;
        Window above = window, below = window;
        above.rows[3][s] += e, below.rows[3][s] -= e;
        by_difference[s] = (equation_at(system, above, 0, i).sum - equation_at(system, below, 0, i).sum) / (2 * e);
      }
      CHECK(distance(by_entries, by_difference) < 1e-7);
    }
  }
}

TEST_CASE("a window goes round a circle with a turn, and stops at its first and last row") {
  const Window window{&ring, 1, 7, 3, {Row(N, 1), Row(N, 2)}};
  CHECK(window(3, 4, 0) == 1);
  CHECK(window(4, 4 + N, 0) == 2 + 7);
  CHECK(window(4, -1, 0) == 2 - 7);
  CHECK(window(4, -1 - N, 0) == 2 - 14);
  CHECK(window(9, 0, 0) == 2);
  CHECK(window(-9, 0, 0) == 1);
  CHECK(window.last_row() == 4);
}

TEST_CASE("at a natural wall the equation is what the stencils inside give, at a fixed wall there is none") {
  const Lattice walls = Lattice::interval(N, (N - 1) * k, Wall::natural, Wall::fixed);
  const LatticeSystem system(walls, {family_of(wave(), "rectangle")}, h);
  // Σ over the two rectangles right of the wall: −½(∂²_h y₀)/h² + half the slopes in space, averaged as in (5.10)
  std::map<Site, double> expected;
  const double weights[]{.25, .5, .25}, second[]{1, -2, 1};
  for (int j = -1; j <= 1; ++j) {
    expected[{j, 1}] = weights[j + 1] / (k * k);
    expected[{j, 0}] = -weights[j + 1] / (k * k) - second[j + 1] / (2 * h * h);
  }
  CHECK(has_coefficients(system, {0, 0}, expected));
  CHECK(system.linearised({0, N - 1}, 0).empty());
  CHECK(has_coefficients(system, {0, 5}, coefficients(printed(0)["rectangle"])));
}

TEST_CASE("bricks on an odd circle, components without a name, and stencils that find no place are refused") {
  const auto with = [](int sites, const Families& families) {
    return refused_key([&] { LatticeSystem(Lattice::circle(sites, 5), families, h); });
  };
  const auto hexagons = family_of(wave(), "hexagon");
  CHECK(with(11, {hexagons}) == "lattice.sites");
  CHECK(with(12, {hexagons}) == "accepted");
  const auto two = TheoryOf<Two>(Two{}).variational("rectangle");
  CHECK(with(12, {hexagons, two}) == "accepted");  // a second field beside one that has more
  CHECK(refused_key([&] { LatticeSystem(Lattice::circle(12, 5), {two}, h, fields(1)); }) == "lattice.stencil");
  CHECK(refused_key([&] { LatticeSystem(Lattice::point(), {two}, h); }) == "lattice.stencil");
}

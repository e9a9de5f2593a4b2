// SPDX-License-Identifier: MIT
#include "schemes/stability/symbol.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/verify/wrong_sign.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Complex = std::complex<double>;
using Values = std::vector<Complex>;

LatticeSystem system_of(Problem p) { return Simulation(p).evolution().system(); }

/// Klein-Gordon on every scheme that is made for a circle; not those with too many nodes for a quick test.
std::vector<NamedScheme> schemes_of(int sites, double mass) {
  Problem base;
  base.theory = "klein-gordon", base.parameters["theory.mass"] = mass;
  base.lattice = Lattice::circle(sites, 0.9 * sites), base.time_step = 0.31;
  base.parameters["scheme.order"] = base.parameters["lattice.space_order"] = 4;
  std::vector<NamedScheme> result;
  for (NamedScheme& scheme : named_schemes(base)) {
    try {
      if (Simulation(scheme.problem).components().size() <= 6) result.push_back(std::move(scheme));
    } catch (const BadInput&) {  // for mechanics, or for other theories
    }
  }
  return result;
}

/// A value that has an equation: comparators have it at the centre alone.
int read_value(const StencilFamily& family) {
  const std::size_t n = at(family.size());
  std::vector<double> y(n, 0.1), r(n);
  family.residual({0.31, 0.9, 0, 0}, y, r);
  return static_cast<int>(std::ranges::max_element(r, {}, [](double x) { return std::abs(x); }) - r.begin());
}

/// The largest difference between P v and what the equations of the lattice say of the wave zʲ e^{iθi} v, relative.
double plane_wave_defect(const Symbol& symbol, const LatticeSystem& system, Complex z, double theta, const Values& v) {
  const int C = system.components(), N = system.lattice().sites();
  std::vector<std::vector<double>> rows;
  for (int row = -3; row <= 3; ++row) {
    rows.emplace_back();
    for (int i = 0; i < N; ++i)
      for (int c = 0; c < C; ++c) {
        const int sort = symbol.brick() ? (row + i) & 1 : 0;
        rows.back().push_back(std::real(std::pow(z, row) * std::polar(1.0, theta * i) * v[sort * C + c]));
      }
  }
  const Window window = system.window(-3, rows, 0);
  const Values P = symbol.matrix(z, theta);
  double worst = 0, scale = 0;
  for (int a = 0; a < symbol.size(); ++a) {
    const int site = N / 2 / 2 * 2 + a / C;
    Complex sum = 0;
    for (int b = 0; b < symbol.size(); ++b) sum += P[a * symbol.size() + b] * v[b];
    const auto E = equation_at(system, window, 0, site, a % C);
    worst = std::max(worst, std::abs(E.sum - std::real(sum * std::polar(1.0, theta * site))));
    scale = std::max(scale, E.absolute);
  }
  return worst / scale;
}

/// The largest distance from a number of one list to the nearest of the other, each taken once.
double mismatch(Values a, Values b) {
  if (a.size() != b.size()) return 1e300;
  double worst = 0;
  for (const Complex& x : a) {
    const auto nearest = std::ranges::min_element(b, {}, [&](const Complex& y) { return std::abs(x - y); });
    worst = std::max(worst, std::abs(x - *nearest));
    b.erase(nearest);
  }
  return worst;
}

/// The eigenvalues of `strides` steps that the program makes of a pair of rows.
Values eigenvalues_of_steps(const Problem& p, int strides) {
  const int N = p.lattice.sites();
  Eigen::MatrixXd step(2 * N, 2 * N);
  for (int unit = 0; unit < 2 * N; ++unit) {
    Simulation simulation(p);
    REQUIRE(simulation.starting_rows() == 2);
    std::vector<Row> rows(2, Row(at(N), 0.0));
    rows[unit / N][unit % N] = 1;
    simulation.start(rows);
    for (int n = 0; n < strides; ++n) simulation.step();
    for (int back = 0; back < 2; ++back) {
      Row row(at(N));
      simulation.copy_row(back, row);
      for (int i = 0; i < N; ++i) step((1 - back) * N + i, unit) = row[i];
    }
  }
  const auto values = step.eigenvalues().eval();
  return {values.begin(), values.end()};
}

double step_mismatch(const Problem& p, const Symbol& symbol) {
  const int N = p.lattice.sites(), strides = symbol.brick() ? 2 : 1;
  Values roots;
  for (int j = 0; j < N / strides; ++j)
    for (const Complex& z : symbol.roots(2 * std::numbers::pi * j / N)) roots.push_back(strides == 2 ? z * z : z);
  return mismatch(roots, eigenvalues_of_steps(p, strides));
}

}  // namespace

TEST_CASE("the symbol is what the equations of the lattice make of a plane wave, for every scheme") {
  Random random(11);
  int tried = 0;
  for (const NamedScheme& scheme : schemes_of(12, 1.3)) {
    CAPTURE(scheme.name);
    const LatticeSystem system = system_of(scheme.problem);
    const Symbol symbol(system);
    for (const int j : {0, 2, 5}) {
      Values v;
      for (int a = 0; a < symbol.size(); ++a) v.emplace_back(random(-1, 1), random(-1, 1));
      const Complex z(random(-1.2, 1.2), random(0.2, 1));
      CHECK(plane_wave_defect(symbol, system, z, 2 * std::numbers::pi * j / 12, v) < 1e-13);
    }
    ++tried;
  }
  CHECK(tried > 15);
}

TEST_CASE("the check can fail: the symbol of equations with a wrong sign is not that of the lattice") {
  for (const NamedScheme& scheme : schemes_of(12, 1.3)) {
    CAPTURE(scheme.name);
    const LatticeSystem system = system_of(scheme.problem);
    Families families(system.families().begin(), system.families().end());
    families[0] = std::make_shared<WrongSign>(families[0], read_value(*families[0]));
    const LatticeSystem wrong(system.lattice(), families, system.time_step(), system.all_components());
    const Symbol symbol(wrong);
    const Values v(at(symbol.size()), Complex(0.7, 0.2));
    CHECK(plane_wave_defect(symbol, system, {0.9, 0.4}, std::numbers::pi / 3, v) > 1e-3);
  }
}

TEST_CASE("roots are roots, and the number beside them is none") {
  for (const NamedScheme& scheme : schemes_of(12, 1.3)) {
    CAPTURE(scheme.name);
    const Symbol symbol(system_of(scheme.problem));
    for (const double theta : {0.3, 1.1, 2.9}) {
      const Values roots = symbol.roots(theta);
      REQUIRE(roots.size() >= 2);
      for (const Complex& z : roots) {
        if (std::abs(std::abs(z) - 1) > 0.5) continue;  // where rounding is not what is_root knows
        CHECK(symbol.is_root(z, theta));
        CHECK_FALSE(symbol.is_root(z * std::polar(1.0, 1e-4), theta));
      }
    }
  }
}

TEST_CASE("the roots at a circle's wave numbers are the eigenvalues of the step that the program makes") {
  Problem p;
  p.theory = "klein-gordon", p.parameters["theory.mass"] = 1.3, p.time_step = 0.5;
  for (const char* stencil :
       {"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "six-tuple", "nine-tuple"}) {
    CAPTURE(stencil);
    p.stencil = stencil;
    p.lattice = Lattice::circle(7, 6.3);
    CHECK(step_mismatch(p, Symbol(system_of(p))) < 1e-10);
  }
  p.stencil = "hexagon";
  for (const double mass : {1.3, 5.0}) {  // of these steps the second grows
    p.parameters["theory.mass"] = mass, p.lattice = Lattice::circle(8, 7.2);
    CHECK(step_mismatch(p, Symbol(system_of(p))) < 1e-10);
  }
  p.parameters["theory.mass"] = 1.3, p.lattice = Lattice::circle(7, 6.3);
  for (const char* method : {"guo", "vu-quoc-li", "damped"}) {
    CAPTURE(method);
    p.method = method;
    CHECK(step_mismatch(p, Symbol(system_of(p))) < 1e-10);
  }
}

TEST_CASE("the check can fail: another scheme's roots are not the eigenvalues of the step") {
  Problem p;
  p.theory = "klein-gordon", p.parameters["theory.mass"] = 1.3, p.time_step = 0.5, p.lattice = Lattice::circle(7, 6.3),
  p.stencil = "rectangle";
  Problem other = p;
  other.stencil = "triangle";
  CHECK(step_mismatch(p, Symbol(system_of(other))) > 1e-3);
}

TEST_CASE("bricks: the root z at theta is the root -z at theta + pi") {
  Problem p;
  p.theory = "klein-gordon", p.stencil = "hexagon", p.lattice = Lattice::circle(8, 8), p.time_step = 0.6;
  const Symbol symbol(system_of(p));
  CHECK(symbol.brick());
  CHECK(symbol.size() == 2);
  for (const double theta : {0.0, 0.4, 1.3}) {
    Values mirrored = symbol.roots(theta + std::numbers::pi);
    for (Complex& z : mirrored) z = -z;
    CHECK(mismatch(symbol.roots(theta), mirrored) < 1e-7);
  }
}

TEST_CASE("about a constant state: sine-Gordon at 0 is Klein-Gordon, and at pi the same with mass squared -1") {
  Problem p;
  p.theory = "sine-gordon", p.lattice = Lattice::circle(8, 8), p.time_step = 0.5, p.stencil = "rectangle";
  const Symbol at_zero(system_of(p)), at_pi(system_of(p), std::numbers::pi);
  p.theory = "klein-gordon";
  const Symbol linear(system_of(p));
  for (const double theta : {0.0, 0.5, 2.0}) {
    CHECK(mismatch(at_zero.roots(theta), linear.roots(theta)) < 1e-13);
    CHECK(at_zero.amplification(theta) == 1);
  }
  // tan²(ωh/2) = −h²/4 at θ = 0: z = (1 + h/2)/(1 − h/2)
  CHECK(at_pi.amplification(0) == Approx(1.25 / 0.75).epsilon(1e-13));
}

TEST_CASE("two coupled fields have the roots of their normal modes") {
  Problem p;
  p.theory = "coupled-sine-gordon", p.parameters["theory.mass"] = 0.8, p.parameters["theory.lambda"] = 0.35;
  p.lattice = Lattice::circle(8, 8), p.time_step = 0.5, p.stencil = "rectangle-symmetric";
  const Symbol both(system_of(p));
  CHECK(both.size() == 2);
  p.theory = "klein-gordon";
  const Symbol slow(system_of(p));
  p.parameters["theory.mass"] = std::sqrt(0.8 * 0.8 + 2 * 0.35);
  const Symbol fast(system_of(p));
  for (const double theta : {0.0, 0.7, 2.2}) {
    Values apart = slow.roots(theta);
    for (const Complex& z : fast.roots(theta)) apart.push_back(z);
    CHECK(mismatch(both.roots(theta), apart) < 1e-12);
  }
}

TEST_CASE("what has no symbol is refused with the key that asks for it") {
  Problem p;
  p.lattice = Lattice::circle(8, 8), p.time_step = 0.5, p.stencil = "rectangle";
  const auto refused = [&] { return refused_key([&] { Symbol symbol(system_of(p)); }); };
  p.theory = "sine-gordon";
  CHECK(refused() == "accepted");
  p.theory = "wave-map";
  CHECK(refused() == "scheme.method");
  p.theory = "sine-gordon-impurity";
  CHECK(refused() == "theory.name");
  p.theory = "kepler", p.lattice = Lattice::point(), p.stencil = "midpoint";
  CHECK(refused() == "theory.name");
  const auto nowhere = [&] {
    p.theory = "klein-gordon", p.stencil = "vertex";
    const LatticeSystem system = system_of(p);
    // Of two components the stencil reads one.
    Symbol symbol(
        LatticeSystem(system.lattice(), {system.families().begin(), system.families().end()}, 0.5, fields(2)));
  };
  CHECK(refused_key(nowhere) == "lattice.stencil");
}

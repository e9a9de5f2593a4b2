// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "jets/tables/point_jets.hpp"
#include "tests/catch.hpp"
#include "tests/verification/by_name.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr const char* time_stencils[] = {"midpoint", "trapezoidal", "vertex"};

struct Body {
  const char *theory, *state;
  double step;
};
constexpr Body pendulum{"pendulum", "pendulum-swing", 0.05}, kepler{"kepler", "kepler-orbit", 0.01};

ByName body(const Body& b, const std::string& stencil, double h) {
  Problem p;
  p.theory = b.theory, p.stencil = stencil, p.lattice = Lattice::point(), p.time_step = h;
  StateRequest request;
  request.name = b.state;
  return {p, request};
}

// ---- by hand: q_tt = −V'(q); the pendulum is the plane's first coordinate alone

using Vector = std::array<double, 2>;
struct Matrix {
  double xx, xy, yy;
};

bool is_kepler(const Body& b) { return b.theory == std::string("kepler"); }
int dimension(const Body& b) { return is_kepler(b) ? 2 : 1; }

Vector gradient(const Body& b, Vector q) {
  if (!is_kepler(b)) return {std::sin(q[0]), 0};
  const double r = std::hypot(q[0], q[1]);
  return {q[0] / (r * r * r), q[1] / (r * r * r)};
}
Matrix hessian(const Body& b, Vector q) {
  if (!is_kepler(b)) return {std::cos(q[0]), 0, 0};
  const double r = std::hypot(q[0], q[1]), r3 = r * r * r, r5 = r3 * r * r;
  return {1 / r3 - 3 * q[0] * q[0] / r5, -3 * q[0] * q[1] / r5, 1 / r3 - 3 * q[1] * q[1] / r5};
}
double energy(const Body& b, Vector q, Vector p) {
  return 0.5 * (p[0] * p[0] + p[1] * p[1]) + (is_kepler(b) ? -1 / std::hypot(q[0], q[1]) : 1 - std::cos(q[0]));
}

struct Phase {
  Vector q, p;
};

/// Störmer–Verlet: a half kick, a drift, a half kick. It is p = −∂₁L_d, p' = ∂₂L_d of
/// L_d = h(½((q'−q)/h)² − ½V(q) − ½V(q')).
Phase verlet(const Body& b, Phase s, double h) {
  for (int half = 0; half < 2; ++half) {
    const Vector g = gradient(b, s.q);
    for (std::size_t a = 0; a < 2; ++a) {
      s.p[a] -= 0.5 * h * g[a];
      if (half == 0) s.q[a] += h * s.p[a];
    }
  }
  return s;
}

/// L_d = h(½((q'−q)/h)² − V(q)): p = (q'−q)/h + hV'(q), p' = (q'−q)/h.
Phase symplectic_euler(const Body& b, Phase s, double h) {
  const Vector g = gradient(b, s.q);
  for (std::size_t a = 0; a < 2; ++a) s.p[a] -= h * g[a], s.q[a] += h * s.p[a];
  return s;
}

/// L_d = h(½((q'−q)/h)² − V(½(q+q'))): p = (q'−q)/h + ½hV'(½(q+q')) by Newton, p' = (q'−q)/h − ½hV'(½(q+q')).
Phase midpoint_map(const Body& b, Phase s, double h) {
  Vector v = s.p;  // (q'−q)/h
  const auto middle = [&] { return Vector{s.q[0] + 0.5 * h * v[0], s.q[1] + 0.5 * h * v[1]}; };
  for (int i = 0; i < 20; ++i) {
    const Vector g = gradient(b, middle());
    const Matrix H = hessian(b, middle());
    const double f0 = v[0] + 0.5 * h * g[0] - s.p[0], f1 = v[1] + 0.5 * h * g[1] - s.p[1], c = h * h / 4;
    const double xx = 1 + c * H.xx, xy = c * H.xy, yy = 1 + c * H.yy, det = xx * yy - xy * xy;
    const double d0 = (yy * f0 - xy * f1) / det, d1 = (xx * f1 - xy * f0) / det;
    v[0] -= d0, v[1] -= d1;
    if (std::abs(d0) + std::abs(d1) < 1e-15) break;
  }
  const Vector g = gradient(b, middle());
  for (std::size_t a = 0; a < 2; ++a) s.q[a] += h * v[a], s.p[a] = v[a] - 0.5 * h * g[a];
  return s;
}

/// Not variational: q' = q + hp, p' = p − hV'(q).
Phase explicit_euler(const Body& b, Phase s, double h) {
  const Vector g = gradient(b, s.q), p = s.p;
  for (std::size_t a = 0; a < 2; ++a) s.p[a] -= h * g[a], s.q[a] += h * p[a];
  return s;
}

/// Not variational, of second order: Heun's.
Phase heun(const Body& b, Phase s, double h) {
  const Phase e = explicit_euler(b, s, h);
  const Vector g0 = gradient(b, s.q), g1 = gradient(b, e.q);
  for (std::size_t a = 0; a < 2; ++a) s.q[a] += 0.5 * h * (s.p[a] + e.p[a]), s.p[a] -= 0.5 * h * (g0[a] + g1[a]);
  return s;
}

using Map = Phase (*)(const Body&, Phase, double);

/// Of row 0, from rows 0 and 1: the momentum that the map of `stencil` starts with, p = −∂₁L_d(q, q').
Phase legendre(const Body& b, const std::string& stencil, Vector q, Vector next, double h) {
  const Vector at = stencil == "midpoint" ? Vector{0.5 * (q[0] + next[0]), 0.5 * (q[1] + next[1])} : q;
  const double weight = stencil == "vertex" ? h : 0.5 * h;
  const Vector g = gradient(b, at);
  return {q, {(next[0] - q[0]) / h + weight * g[0], (next[1] - q[1]) / h + weight * g[1]}};
}

Vector plane(const std::vector<double>& y) { return {y[0], y.size() > 1 ? y[1] : 0.0}; }

/// max |q − by hand| over 1000 steps
double distance(const Body& b, const std::string& stencil, Map map) {
  ByName run = body(b, stencil, b.step);
  Phase s = legendre(b, stencil, plane(run.exact_row(0)), plane(run.exact_row(1)), b.step);
  double most = 0;
  for (int n = 1; n <= 1000; ++n) {
    s = map(b, s, b.step);
    run.to(n);
    const std::vector<double> y = run.newest();
    for (int a = 0; a < dimension(b); ++a) most = std::max(most, std::abs(y[a] - s.q[a]));
  }
  return most;
}

/// max |E − E₀| over the first and the last tenth of a run, and the largest relative change of angular momentum.
struct LongRun {
  double first = 0, last = 0, spin = 0;
  bool keeps_band() const { return last < 1.5 * first && first < 1.5 * last; }
};
constexpr long a_million = 1'000'000;

LongRun long_run(const Body& b, const std::string& stencil) {
  ByName run = body(b, stencil, b.step);
  const auto start = run.simulation().monitors();
  LongRun result;
  for (long n = 97; n <= a_million; n += 97) {
    const auto now = run.to(n).simulation().monitors();
    double* tenth = n <= a_million / 10 ? &result.first : n > a_million - a_million / 10 ? &result.last : nullptr;
    if (tenth) *tenth = std::max(*tenth, std::abs(now.energy - start.energy));
    if (is_kepler(b)) result.spin = std::max(result.spin, std::abs(now.conserved.at(0) / start.conserved.at(0) - 1));
  }
  return result;
}

LongRun long_run_by_hand(const Body& b, Map map, long steps) {
  const ByName run = body(b, "midpoint", b.step);
  std::vector<double> velocity(dimension(b));
  run.state().velocities(0, Lattice::point(), velocity);
  Phase s{plane(run.exact_row(0)), plane(velocity)};
  const auto spin = [&] { return s.q[0] * s.p[1] - s.q[1] * s.p[0]; };
  const double E = energy(b, s.q, s.p), J = spin();
  LongRun result;
  for (long n = 1; n <= steps; ++n) {
    s = map(b, s, b.step);
    if (n % 97 != 0) continue;
    double* tenth = n <= steps / 10 ? &result.first : n > steps - steps / 10 ? &result.last : nullptr;
    if (tenth) *tenth = std::max(*tenth, std::abs(energy(b, s.q, s.p) - E));
    if (is_kepler(b)) result.spin = std::max(result.spin, std::abs(spin() / J - 1));
  }
  return result;
}

/// Kepler's with an attraction that is stronger along one axis.
struct Anisotropic {
  static constexpr int components = 2;
  double squeeze = 1;
  auto operator()(const auto& j) const {
    const auto &q = j.phi, &v = j.phi_t;
    return 0.5 * (v[0] * v[0] + v[1] * v[1]) + 1.0 / sqrt(q[0] * q[0] + squeeze * (q[1] * q[1]));
  }
};

}  // namespace

TEST_CASE("a pendulum and a planet are followed to second order by each stencil of time") {
  for (const Body& b : {pendulum, kepler})
    for (const char* stencil : time_stencils) {
      const auto error = [&](int steps) { return body(b, stencil, 3.0 / steps).to(steps).error(); };
      const double e1 = error(600), e2 = error(1200), e3 = error(2400);
      const double coarse = std::log2(e1 / e2), fine = std::log2(e2 / e3);
      CAPTURE(b.theory, stencil, e1, e2, e3, coarse, fine);
      CHECK(std::abs(coarse - 2) < 0.1);
      CHECK(std::abs(fine - 2) < 0.1);
    }
}

TEST_CASE("the check can fail: explicit Euler follows them to first order only") {
  for (const Body& b : {pendulum, kepler}) {
    const auto error = [&](int steps) {
      const ByName run = body(b, "vertex", 3.0 / steps);
      std::vector<double> velocity(dimension(b));
      run.state().velocities(0, Lattice::point(), velocity);
      Phase s{plane(run.exact_row(0)), plane(velocity)};
      for (int n = 0; n < steps; ++n) s = explicit_euler(b, s, 3.0 / steps);
      const Vector exact = plane(run.exact_row(steps));
      return std::max(std::abs(s.q[0] - exact[0]), std::abs(s.q[1] - exact[1]));
    };
    const double order = std::log2(error(1200) / error(2400));
    CAPTURE(b.theory, order);
    CHECK(std::abs(order - 1) < 0.2);
  }
}

TEST_CASE("the discrete field equations are Veselov's map: written by hand it makes the same trajectory") {
  for (const Body& b : {pendulum, kepler}) {
    const double midpoint = distance(b, "midpoint", midpoint_map), trapezoidal = distance(b, "trapezoidal", verlet),
                 vertex = distance(b, "vertex", symplectic_euler);
    CAPTURE(b.theory, midpoint, trapezoidal, vertex);
    CHECK(midpoint < 1e-12);
    CHECK(trapezoidal < 1e-12);
    CHECK(vertex < 1e-12);
  }
}

TEST_CASE("the check can fail: the map of another Lagrangian, or of none, makes another trajectory") {
  for (const Body& b : {pendulum, kepler}) {
    CAPTURE(b.theory);
    CHECK(distance(b, "midpoint", verlet) > 1e-4);
    CHECK(distance(b, "trapezoidal", midpoint_map) > 1e-4);
    CHECK(distance(b, "trapezoidal", heun) > 1e-4);
  }
}

TEST_CASE("a million steps: the energy stays in its band, angular momentum stays") {
  for (const Body& b : {pendulum, kepler})
    for (const char* stencil : time_stencils) {
      const LongRun run = long_run(b, stencil);
      CAPTURE(b.theory, stencil, run.first, run.last, run.spin);
      CHECK(run.keeps_band());
      CHECK(run.spin < 1e-11);
    }
}

TEST_CASE("the check can fail: maps without a Lagrangian lose the energy's band and angular momentum") {
  for (const Body& b : {pendulum, kepler})
    for (const Map map : {explicit_euler, heun}) {
      const LongRun run = long_run_by_hand(b, map, a_million);
      CAPTURE(b.theory, map == heun, run.first, run.last, run.spin);
      // Euler's planet has left for good within the first tenth: its energy is wrong by as much in the last
      if (is_kepler(b) && map == explicit_euler) CHECK(run.last > 0.1);
      else CHECK_FALSE(run.keeps_band());
      if (is_kepler(b)) CHECK(run.spin > 1e-3);
    }
}

TEST_CASE("angular momentum stays because the attraction is isotropic: an anisotropic one does not keep it") {
  const ByName orbit = body(kepler, "midpoint", kepler.step);
  const LinearSymmetry rotation{"rotation", {0, -1, 1, 0}, {0, 0}};
  const auto drift = [&](double squeeze) {
    auto evolution = Scheme{midpoint, Anisotropic{squeeze}}.on(Lattice::point(), kepler.step);
    return relative_drift(evolution, {orbit.exact_row(0), orbit.exact_row(1)}, rotation, 2000);
  };
  CHECK(drift(1) < 1e-12);
  CHECK(drift(1.1) > 1e-3);
}

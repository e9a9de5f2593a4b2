// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/plan/solve_plan.hpp"
#include "schemes/verify/equation_check.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"
#include "tools/diagnosis/diagnosis.hpp"
#include "tools/diagnosis/fields_system.hpp"

using namespace delf;
using delf::testing::Row;

namespace {

using Rows = std::vector<Row>;
constexpr int N = 64, frames = 60;
constexpr double L = 40, k = L / N, h = k / 2, circle = 2 * std::numbers::pi;

// What a program wrote, and what a scene states of it.
struct Written {
  Rows rows;
  Problem problem;
  double monodromy = 0;
  Rows momenta = {};
};

Problem scene(const std::string& theory = "sine-gordon", Lattice lattice = Lattice::circle(N, L), double step = h) {
  Problem p;
  p.theory = theory, p.stencil = "triangle-vertex", p.lattice = lattice, p.time_step = step;
  return p;
}
Problem on_point(double step = 0.1) {
  Problem p = scene("pendulum", Lattice::point(), step);
  p.stencil = "vertex";
  return p;
}

std::vector<Finding> findings(const Written& w, double tolerance = 1e-13) {
  const auto system = fields_system(w.problem);
  REQUIRE(system);
  const SolvePlan plan = make_plan(system->lattice(), system->pattern());
  EquationCheck check(*system, plan, tolerance);
  const auto last = static_cast<std::int64_t>(w.rows.size()) - 1;
  FailedEquations failed;
  for (std::int64_t j = check.reach(); j <= last - check.reach(); ++j) {
    const auto first = w.rows.begin() + (j - check.reach());
    check.at(system->window(j - check.reach(), {first, first + 2 * check.reach() + 1}, w.monodromy), j);
    failed.add(j, check.newest(), system->components(), tolerance);
  }
  return diagnose(
             {w.problem, *system, w.monodromy, tolerance, last + 1, [&](std::int64_t j) { return w.rows[j]; }, failed,
              w.momenta.empty() ? std::function<Row(std::int64_t)>{} : [&](std::int64_t j) { return w.momenta[j]; }})
      .findings;
}

// All of them, one after the other: "KIND: words"
std::string diagnosis(const Written& w, double tolerance = 1e-13) {
  std::string text;
  for (const Finding& f : findings(w, tolerance)) text += f.kind + ": " + f.words + "\n";
  return text;
}

double breather(double t, double x) {
  const double omega = 0.6, eta = 0.8;
  return 4 * std::atan(eta / omega * std::cos(omega * t) / std::cosh(eta * (x - 21.3)));
}
double kink(double t, double x) { return 4 * std::atan(std::exp((x - 20 - 0.3 * t) / std::sqrt(1 - 0.09))); }

using Field = std::function<double(double, double)>;
Row row_of(const Field& field, double t, int sites = N, double step = k) {
  Row row;
  for (int i = 0; i < sites; ++i) row.push_back(field(t, i * step));
  return row;
}

// D²y where y gains `monodromy` around the circle.
Row second_difference(const Row& y, double monodromy = 0) {
  const auto n = static_cast<int>(y.size());
  Row D(y.size());
  const auto at = [&](int i) { return i < 0 ? y[n - 1] - monodromy : i == n ? y[0] + monodromy : y[i]; };
  for (int i = 0; i < n; ++i) D[i] = (at(i - 1) - 2 * y[i] + at(i + 1)) / (k * k);
  return D;
}

// y_{j+1} = 2 y_j − y_{j−1} + h² force(y_j, y_{j−1})
using Force = std::function<Row(const Row& now, const Row& before)>;
Rows stepped(Rows rows, const Force& force, double step = h, int count = frames) {
  while (static_cast<int>(rows.size()) < count) {
    const Row& now = rows[rows.size() - 1];
    const Row& before = rows[rows.size() - 2];
    const Row F = force(now, before);
    Row next(now.size());
    for (std::size_t i = 0; i < now.size(); ++i) next[i] = 2 * now[i] - before[i] + step * step * F[i];
    rows.push_back(std::move(next));
  }
  return rows;
}
Force sine_gordon(double of_space = 1, double of_sine = 1, double monodromy = 0) {
  return [=](const Row& y, const Row&) {
    Row F = second_difference(y, monodromy);
    for (std::size_t i = 0; i < y.size(); ++i) F[i] = of_space * F[i] - of_sine * std::sin(y[i]);
    return F;
  };
}
Rows start(const Field& field = breather, double step = h) { return {row_of(field, 0), row_of(field, step)}; }
Rows leapfrog() { return stepped(start(), sine_gordon()); }

// Of a scheme of the engine.
Rows engine_rows(Problem p, const Rows& first, int count = frames) {
  Simulation s(p);
  s.start(first);
  Rows rows = first;
  while (static_cast<int>(rows.size()) < count) {
    s.step();
    rows.emplace_back(first[0].size());
    s.copy_row(0, rows.back());
  }
  return rows;
}

Written with(Rows rows, Problem p = scene(), double monodromy = 0) {
  return {std::move(rows), std::move(p), monodromy};
}

Rows changed(Rows rows, const std::function<void(Rows&)>& change) {
  change(rows);
  return rows;
}

// Of φ¨ = −sin φ from φ = 2, with the (q, p) map of a step.
Rows pendulum(const std::function<void(double& q, double& p)>& step, int count = 200) {
  double q = 2, p = 0;
  Rows rows;
  while (static_cast<int>(rows.size()) < count) rows.push_back({q}), step(q, p);
  return rows;
}

struct Case {
  const char* name;
  Written written;
  std::string says, never;  ///< a part of the diagnosis, and one that would be a false accusation
};

void check(const Case& c) {
  const std::string text = diagnosis(c.written);
  INFO(c.name << "\n" << text);
  if (c.says.empty()) CHECK(text.empty());
  else CHECK(text.find(c.says) != std::string::npos);
  if (!c.never.empty()) CHECK(text.find(c.never) == std::string::npos);
}

}  // namespace

TEST_CASE("a diagnosis says which coefficient, step or length is wrong") {
  Problem halved = scene();
  halved.lattice = Lattice::circle(N, 2 * L);
  Problem interval = scene("sine-gordon", Lattice::interval(N, 1.0005 * k * (N - 1)));
  Rows huge = start();
  for (Row& row : huge)
    for (double& y : row) y *= 1e200;
  huge = stepped(huge, sine_gordon(1, 0));
  const Problem huge_scene = scene("wave", halved.lattice);
  const auto friction = [](double c) {
    // (1 + ch/2) y₊ = 2y − (1 − ch/2) y₋ + h² F
    return [c](const Row& y, const Row& before) {
      Row F = sine_gordon()(y, before);
      for (std::size_t i = 0; i < y.size(); ++i) {
        const double next = (2 * y[i] - (1 - c * h / 2) * before[i] + h * h * F[i]) / (1 + c * h / 2);
        F[i] = (next - 2 * y[i] + before[i]) / (h * h);
      }
      return F;
    };
  };
  for (const Case& c : std::vector<Case>{
           {"right", with(leapfrog()), "the equations of triangle-vertex", "scheme.method"},
           {"half the length", with(leapfrog(), halved), "lattice.length = 40", "time step"},
           {"k off by 0.05 %",
            with(changed(leapfrog(),
                         [](Rows& r) {
                           for (Row& y : r) y.back() = r[0].back(), y[0] = r[0][0];
                         }),
                 interval),
            "k is off by 0.05 %", "time step"},
           {"a step of 0.9", with(leapfrog(), scene("sine-gordon", Lattice::circle(N, L), h / 0.9)),
            "try lattice.time_step = 0.3125", "wave speed"},
           {"the wrong sign", with(stepped(start(), sine_gordon(1, -1), h, 30)), "The force N′(φ) has the wrong sign",
            "time step"},
           {"no force", with(stepped(start(), sine_gordon(1, 0))), "No force N′(φ) acts", "wrong sign"},
           {"a mass of 1.2", with(stepped(start(), sine_gordon(1, 1.44))), "The force N′(φ) is 1.44 times",
            "time step"},
           {"friction", with(stepped(start(), friction(0.2))), "There is friction 0.2 φ_t, φ_t by central",
            "wave speed"},
           {"half the length, values of 1e200", with(huge, huge_scene), "lattice.length = 40", "time step"},
           {"another theory", with(leapfrog(), scene("phi4")), "No time step, length or coefficient", "friction 0"},
           {"a linear theory", with(leapfrog(), scene("klein-gordon")), "No time step, length or coefficient",
            "average"},
           {"no force in the scene", with(leapfrog(), scene("wave")), "No time step, length or coefficient",
            "friction"},
       })
    check(c);
}

TEST_CASE("a diagnosis names the scheme that the rows are of") {
  Problem other = scene();
  other.method = "vu-quoc-li";
  const Rows first = start();
  const Rows avf = engine_rows(other, first);
  // Two lattices of step 2k, one in the gaps of the other.
  Problem coarse = scene("sine-gordon", Lattice::circle(N / 2, L));
  coarse.method = "vu-quoc-li";
  Rows twice(frames, Row(N));
  for (int s : {0, 1}) {
    const auto shifted = [&](double t, double x) { return breather(t, x + s * k); };
    const Rows half = engine_rows(coarse, {row_of(shifted, 0, N / 2, 2 * k), row_of(shifted, h, N / 2, 2 * k)});
    for (int j = 0; j < frames; ++j)
      for (int i = 0; i < N / 2; ++i) twice[j][2 * i + s] = half[j][i];
  }
  Rows between;  // rows at whole and at half steps
  const Rows even = leapfrog(), odd = stepped({row_of(breather, h / 2), row_of(breather, 1.5 * h)}, sine_gordon());
  for (int j = 0; j < frames; ++j) between.push_back(even[j]), between.push_back(odd[j]);
  Problem hexagon = scene();
  hexagon.stencil = "hexagon";
  const Rows bricks = engine_rows(hexagon, first);
  Problem long_wall = hexagon;
  long_wall.lattice = Lattice::circle(132, 132 * k);
  const auto bricks_at = [&](int site) {
    const auto pulse = [&](double t, double x) { return breather(t, x - site * k + 21.3); };
    return engine_rows(long_wall, {row_of(pulse, 0, 132), row_of(pulse, h, 132)}, 30);
  };

  for (const Case& c : std::vector<Case>{
           {"Vu-Quoc and Li", with(avf), "the equations of vu-quoc-li (scheme.method = vu-quoc-li)", "every second"},
           {"on every second site", with(twice), "of vu-quoc-li (scheme.method = vu-quoc-li) on every second site",
            "second row"},
           {"at half steps", with(between, scene("sine-gordon", Lattice::circle(N, L), h / 2)),
            "of triangle-vertex of every second row", "site"},
           {"bricks", with(bricks, hexagon), "the equations of hexagon.", "one site further"},
           {"bricks on a long lattice", with(bricks_at(66), long_wall), "the equations of hexagon.",
            "one site further"},
           {"bricks a site on", with(bricks_at(67), long_wall), "the equations of hexagon.", "one site further"},
           {"bricks from an odd frame", with({bricks.begin() + 1, bricks.end()}, hexagon),
            "Its bricks begin one site further", "every second"},
       })
    check(c);
}

TEST_CASE("a diagnosis knows what a row takes from its neighbours in time") {
  constexpr double step = 0.1;
  const auto force = [](double q) { return -std::sin(q); };
  // y₊ − 2y + y₋ = h² (½D²(y₊ + y) − sin y), by fixed points
  Rows averaged = start();
  while (averaged.size() < 40) {
    const Row y = averaged.back(), before = averaged[averaged.size() - 2], D = second_difference(y);
    Row next = y;
    for (int n = 0; n < 80; ++n) {
      const Row above = second_difference(next);
      for (int i = 0; i < N; ++i) next[i] = 2 * y[i] - before[i] + h * h * (0.5 * (above[i] + D[i]) - std::sin(y[i]));
    }
    averaged.push_back(next);
  }
  const auto runge_kutta = [&](double by) {
    return [=](double& q, double& p) {
      const auto slope = [&](double a, double b) { return std::pair{b, force(a)}; };
      const auto [q1, p1] = slope(q, p);
      const auto [q2, p2] = slope(q + by / 2 * q1, p + by / 2 * p1);
      const auto [q3, p3] = slope(q + by / 2 * q2, p + by / 2 * p2);
      const auto [q4, p4] = slope(q + by * q3, p + by * p3);
      q += by / 6 * (q1 + 2 * q2 + 2 * q3 + q4), p += by / 6 * (p1 + 2 * p2 + 2 * p3 + p4);
    };
  };
  const auto twice = [&](double& q, double& p) {
    for (int n = 0; n < 2; ++n) runge_kutta(0.4)(q, p);
  };
  for (const Case& c : std::vector<Case>{
           {"averaged leapfrog", with(averaged), "D²φ of the rows j − 1, j, j + 1 with the weights 0, 0.5, 0.5",
            "Euler"},
           {"symplectic Euler",
            with(pendulum([&](double&q, double&p) { p += step * force(q), q += step * p; }), on_point()),
            "the equations of vertex", "Euler"},
           {"explicit Euler",
            with(pendulum([&](double&q, double&p) {
                   const double f = force(q);
                   q += step * p, p += step * f;
                 }),
                 on_point()),
            "those of explicit Euler", "No time step"},
           {"velocity Verlet",
            with(pendulum(
                     [&](double&q, double&p) { p += step / 2 * force(q), q += step * p, p += step / 2 * force(q); }),
                 on_point()),
            "the equations of vertex", "right to"},
           {"a wrong sign in the second kick",
            with(
                pendulum([&](double&q, double&p) { p += step / 2 * force(q), q += step * p, p -= step / 2 * force(q); },
                         100),
                on_point()),
            "No force N′(φ) acts", "Euler"},
           {"Runge-Kutta, steps of 0.4", with(pendulum(runge_kutta(0.4)), on_point(0.4)),
            "a step of the classical Runge-Kutta method of order 4", "is a symplectic"},
           {"Runge-Kutta", with(pendulum(runge_kutta(step)), on_point()),
            "a step of the classical Runge-Kutta method of order 4", "friction"},
           {"two steps of Runge-Kutta a frame", with(pendulum(twice), on_point(0.8)),
            "The theory, the time step and the length are right to", "Each frame is a step"},
       })
    check(c);
}

TEST_CASE("a diagnosis names the one-step map of rows, with their momenta and without them") {
  constexpr double step = 0.25;
  using Map = std::function<void(double& q, double& p)>;
  const auto kick = [](double q, double& p, double by) { p -= by * std::sin(q); };
  const Map kick_first = [&](double& q, double& p) { kick(q, p, step / 2), q += step * p, kick(q, p, step / 2); };
  const Map drift_first = [&](double& q, double& p) { q += step / 2 * p, kick(q, p, step), q += step / 2 * p; };
  const Map euler = [&](double& q, double& p) { kick(q, p, step), q += step * p; };
  const auto yoshida = [&](double& q, double& p) {
    const double outer = 1 / (2 - std::cbrt(2.0));
    for (const double w : {outer, 1 - 2 * outer, outer})
      q += w * step / 2 * p, kick(q, p, w * step), q += w * step / 2 * p;
  };
  // Gauss's method of s = 1, 2 by fixed points, from its collocation matrix
  const auto gauss = [&](std::vector<std::vector<double>> a, std::vector<double> b) {
    return [=](double& q, double& p) {
      std::vector<double> Q(b.size(), q), P(b.size(), p);
      for (int n = 0; n < 60; ++n)
        for (std::size_t i = 0; i < b.size(); ++i) {
          double Qi = q, Pi = p;
          for (std::size_t j = 0; j < b.size(); ++j) Qi += step * a[i][j] * P[j], Pi -= step * a[i][j] * std::sin(Q[j]);
          Q[i] = Qi, P[i] = Pi;
        }
      for (std::size_t i = 0; i < b.size(); ++i) p -= step * b[i] * std::sin(Q[i]), q += step * b[i] * P[i];
    };
  };
  const double r = std::sqrt(3.0) / 6;
  const Map midpoint = gauss({{0.5}}, {1}), gauss2 = gauss({{0.25, 0.25 - r}, {0.25 + r, 0.25}}, {0.5, 0.5});
  const Map heun = [&](double& q, double& p) {
    const double q1 = q + step * p, p1 = p - step * std::sin(q), q0 = q;
    q += step / 2 * (p + p1), p -= step / 2 * (std::sin(q0) + std::sin(q1));
  };
  const Map wrong = [&](double& q, double& p) { kick(q, p, step / 2), q += step * p, kick(q, p, 0.6 * step); };

  struct Named {
    const char* name;
    Map map;
    std::string with, without, never;  ///< said with momenta, of the rows alone, and of neither
    double unit = 1;                   ///< of the momenta that are written
  };
  for (const Named& c : std::vector<Named>{
           {"kick-drift-kick", kick_first, "kick-drift-kick Störmer-Verlet", "equations of vertex", "drift-kick-drift"},
           {"drift-kick-drift", drift_first, "drift-kick-drift Störmer-Verlet", "drift-kick-drift", "kick-drift-kick"},
           {"symplectic Euler", euler, "symplectic Euler, the kick first", "equations of vertex", "Verlet"},
           {"Yoshida", yoshida, "method of order 4, drifts first", "method of order 4, drifts first", "kicks first"},
           {"midpoint", midpoint, "cgvi, scheme.tableau = midpoint", "lattice.stencil = midpoint", "not symplectic"},
           {"Gauss 2", gauss2, "scheme.tableau = gauss2", "scheme.tableau = gauss2", "not symplectic"},
           {"Heun", heun, "Heun's method of order 2", "Heun's method of order 2", "is a symplectic"},
           {"a wrong second kick", wrong, "1.1 times", "1.1 times", "Each frame is a step"},
           {"another unit", drift_first, "neither φ_t", "drift-kick-drift", "in its momenta", 3},
       }) {
    Written w{{}, on_point(step), 0, {}};
    double q = 2, p = 0;
    while (w.rows.size() < 40) w.rows.push_back({q}), w.momenta.push_back({p * c.unit}), c.map(q, p);
    check({c.name, w, c.with, c.never});
    w.momenta.clear();
    check({c.name, w, c.without, c.never});
  }

  // Fields on a line: drifts first, with π = φ_t.
  Written w{{}, scene(), 0, {}};
  Row phi = row_of(breather, 0), pi(N, 0.0);
  while (w.rows.size() < 20) {
    w.rows.push_back(phi), w.momenta.push_back(pi);
    for (int i = 0; i < N; ++i) phi[i] += h / 2 * pi[i];
    const Row F = sine_gordon()(phi, phi);
    for (int i = 0; i < N; ++i) pi[i] += h * F[i], phi[i] += h / 2 * pi[i];
  }
  check({"fields", w, "drift-kick-drift Störmer-Verlet", "not symplectic"});
  for (Row& row : w.momenta)
    for (double& p : row) p *= k;
  check({"fields, momenta of sites", w, "p is ∂L/∂φ_t of a site", "not symplectic"});
  w.momenta.clear();
  check({"fields without momenta", w, "drift-kick-drift Störmer-Verlet", "No time step"});
}

TEST_CASE("a diagnosis finds what is wrong with a seam") {
  const Rows wound = stepped({row_of(kink, 0), row_of(kink, h)}, sine_gordon(1, 1, circle));
  const auto ends = [](bool fixed) {  // of an interval: fixed, or mirrors
    return [fixed](const Row& y, const Row& before) {
      Row F = sine_gordon()(y, before);
      for (const int i : {0, N - 1}) {
        const double beside = y[i == 0 ? 1 : N - 2];
        F[i] = fixed ? (before[i] - y[i]) / (h * h) : 2 * (beside - y[i]) / (k * k) - std::sin(y[i]);
      }
      return F;
    };
  };
  const auto pulse = [](double t, double x) { return 3 / std::cosh(0.2 * (x - 18) - 0.1 * t); };
  Rows fixed = start(pulse);
  fixed[1].front() = fixed[0].front(), fixed[1].back() = fixed[0].back();
  // φ_x = α φ + β φ_t at the left, −α φ − β φ_t at the right, by a site beyond each end and central differences:
  // (1 + βh/k) y₊ = 2y − (1 − βh/k) y₋ + h² (2(y₁ − y − kα y)/k² − sin y)
  const auto robin = [](double alpha, double beta) {
    return [=](const Row& y, const Row& before) {
      Row F = sine_gordon()(y, before);
      for (const int i : {0, N - 1}) {
        const double force = 2 * (y[i == 0 ? 1 : N - 2] - y[i] - k * alpha * y[i]) / (k * k) - std::sin(y[i]);
        const double next = (2 * y[i] - (1 - beta * h / k) * before[i] + h * h * force) / (1 + beta * h / k);
        F[i] = (next - 2 * y[i] + before[i]) / (h * h);
      }
      return F;
    };
  };
  Rows pegged = start(pulse);
  for (const int i : {10, 40}) pegged[1][i] = pegged[0][i];
  pegged = stepped(pegged, [](const Row& y, const Row& before) {
    Row F = sine_gordon()(y, before);
    for (const int i : {10, 40}) F[i] = (before[i] - y[i]) / (h * h);
    return F;
  });
  // layers of eight sites at both ends with the friction γ(x) φ_t, φ_t by the rows around or by the last step
  const auto sponge = [](bool central) {
    return [central](const Row& y, const Row& before) {
      Row F = sine_gordon()(y, before);
      for (int i = 0; i < N; ++i) {
        const double depth = std::max(0, std::max(8 - i, i - (N - 9))) / 8.0, g = 0.9 * depth * depth;
        if (!central) F[i] -= g * (y[i] - before[i]) / h;
        else
          F[i] = ((2 * y[i] - (1 - g * h / 2) * before[i] + h * h * F[i]) / (1 + g * h / 2) - 2 * y[i] + before[i]) /
                 (h * h);
      }
      return F;
    };
  };
  Rows repeated = stepped(start(pulse), sine_gordon());
  for (Row& y : repeated) y.push_back(y[0]);
  for (const Case& c : std::vector<Case>{
           {"a kink", with(wound), "Use boundary.winding = 1.", "wall"},
           {"a kink that is stated", with(wound, scene(), circle), "the equations of triangle-vertex", "winding"},
           {"fixed ends", with(stepped(fixed, ends(true))), "between fixed walls", "mirrors"},
           {"mirrors", with(stepped(start(pulse), ends(false))), "The ends are mirrors, φ₋₁ = φ₁", "fixed"},
           {"Robin ends", with(stepped(start(pulse), robin(0.3, 0))), "φ_x = 0.3 φ, a Robin condition", "absorbs"},
           {"absorbing ends", with(stepped(start(pulse), robin(0, 1))), "φ_x = 1 φ_t, which absorbs waves", "Robin"},
           {"a sponge", with(stepped(start(pulse), sponge(true))),
            "An absorbing layer: at the sites 0 to 7, 56 to 63 there is a friction γ(x) φ_t, φ_t = (y₊ − y₋)/2h, of "
            "0.9 "
            "at most (site 0)",
            "wall"},
           {"a sponge by the last step", with(stepped(start(pulse), sponge(false))), "φ_t = (y − y₋)/h, of 0.9 at most",
            "wall"},
           {"pegs", with(pegged), "Sites 10, 40 keep the same value", "wall"},
           {"a site twice", with(repeated, scene("sine-gordon", Lattice::circle(N + 1, k * (N + 1)))),
            "The last site repeats the first", "wall"},
       })
    check(c);
}

TEST_CASE("a diagnosis finds frames and values that were changed") {
  const Rows rows = leapfrog();
  Rows kicked{rows.begin(), rows.begin() + 30};  // the fields jump in velocity: no frame is missing
  for (double& y : kicked.back()) y += 0.1 * std::sin(y);
  kicked = stepped(kicked, sine_gordon());
  const Rows wound = pendulum([](double& q, double& p) { p -= 0.1 * std::sin(q), q += 0.1 * p; });
  Rows fast = wound;
  double q = 0, p = 3;
  for (Row& y : fast) p -= 0.1 * std::sin(q), q += 0.1 * p, y[0] = q;
  const auto modulo = [](Rows r) {
    for (Row& y : r)
      for (double& x : y) x -= circle * std::floor(x / circle);
    return r;
  };
  for (const Case& c : std::vector<Case>{
           {"a frame dropped", with(changed(rows, [](Rows& r) { r.erase(r.begin() + 30); })),
            "A frame is missing between frames 29 and 30", "No time step"},
           {"none dropped", with(kicked), "", "is missing"},
           {"every second row",
            with(changed(rows,
                         [](Rows& r) {
                           Rows kept;
                           for (std::size_t j = 0; j < r.size(); j += 2) kept.push_back(r[j]);
                           r = kept;
                         })),
            "a step of 2 steps of 0.3125 by kick", "is missing"},
           {"a frame doubled", with(changed(rows, [](Rows& r) { r.insert(r.begin() + 20, r[20]); })),
            "Frames 20 and 21 are the same", "missing"},
           {"two frames exchanged", with(changed(rows, [](Rows& r) { std::swap(r[12], r[41]); })),
            "Frames 12 and 41 were exchanged", "missing"},
           {"neighbours exchanged", with(changed(rows, [](Rows& r) { std::swap(r[30], r[31]); })),
            "Frames 30 and 31 were exchanged", "missing"},
           {"the first exchanged", with(changed(rows, [](Rows& r) { std::swap(r[0], r[59]); })),
            "Frames 0 and 59 were exchanged", "missing"},
           {"a value edited", with(changed(rows, [](Rows& r) { r[25][33] += 1e-7; })),
            "One value was changed: row 25, site 33", "frame"},
           {"two values edited", with(changed(rows, [](Rows& r) { r[25][33] += 1e-7, r[25][34] -= 1e-7; })),
            "The equations hold but for 8 of", "One value was"},
           {"another first row", with(changed(rows, [](Rows& r) { r[0] = row_of(breather, 0.1); })),
            "Only the equations of the first rows fail", "frame is"},
           {"modulo 2π", with(modulo(fast), on_point()), "reduced modulo 2π", "missing"},
           {"modulo 2π in space", with(modulo(rows)), "reduced modulo 2π", "missing"},
       }) {
    if (!c.says.empty()) check(c);
    else CHECK(diagnosis(c.written).find(c.never) == std::string::npos);
  }
}

TEST_CASE("a diagnosis tells rounding from errors") {
  const auto rounded = [](Rows rows, const std::function<double(double)>& to) {
    for (Row& y : rows)
      for (double& x : y) x = to(x);
    return rows;
  };
  const auto six = [](double x) { return std::round(x * 1e6) / 1e6; };
  const auto single = [](double x) { return static_cast<double>(static_cast<float>(x)); };
  const auto digits = [](double x) { return std::stod(fmt::format("{:.6g}", x)); };
  for (const Case& c : std::vector<Case>{
           {"6 digits", with(rounded(leapfrog(), digits)), "The values have 6 significant digits, and that explains",
            "decimals"},
           {"6 decimals", with(rounded(leapfrog(), six)), "The values have 6 decimals, and that explains", "is wrong."},
           {"single", with(rounded(leapfrog(), single)), "The values have single precision (float32), and that",
            "wrong"},
           {"both", with(rounded(stepped(start(), sine_gordon(1, 1.3)), six)), "more than rounding is wrong",
            "explains the failure"},
       })
    check(c);
  // The tolerance that it names is enough.
  const std::string words = findings(with(rounded(leapfrog(), six)))[0].words;
  const double tolerance = std::stod(words.substr(words.find("verify.tolerance = ") + 19));
  CHECK(tolerance < 1e-5);
  CHECK(diagnosis(with(rounded(leapfrog(), six)), tolerance).find("rounding") == std::string::npos);
}

TEST_CASE("a diagnosis knows the usual programs for fields") {
  // φ⁴, by leapfrog
  const auto bump = [](double t, double x) { return 1 - 1.4 / std::cosh(0.5 * (x - 18) - 0.2 * t); };
  const Rows quartic = stepped(start(bump), [](const Row& y, const Row&) {
    Row F = second_difference(y);
    for (std::size_t i = 0; i < y.size(); ++i) F[i] += y[i] - y[i] * y[i] * y[i];
    return F;
  });
  // ½D²(y₊ + y₋) with D² of order 4, by fixed points
  const auto wide = [](const Row& y, int i) {
    const auto at = [&](int n) { return y[(n + N) % N]; };
    return (-at(i - 2) + 16 * at(i - 1) - 30 * at(i) + 16 * at(i + 1) - at(i + 2)) / (12 * k * k);
  };
  Rows implicit = start();
  while (implicit.size() < 24) {
    const Row y = implicit.back(), before = implicit[implicit.size() - 2];
    Row next = y;
    for (int n = 0; n < 120; ++n) {
      const Row last = next;
      for (int i = 0; i < N; ++i)
        next[i] = 2 * y[i] - before[i] + h * h * (0.5 * (wide(last, i) + wide(before, i)) - std::sin(y[i]));
    }
    implicit.push_back(next);
  }
  // Symplectic Euler in (φ, π): the ends fixed; mirrors at the last sites, or half a cell beyond them.
  enum class Ends { fixed, mirror, half_a_cell };
  const auto euler = [](Ends ends) {
    Rows rows;
    Row phi, pi(N, 0.0);
    for (int i = 0; i < N; ++i) phi.push_back(3 / std::cosh(0.2 * (i * k - 18)));
    for (int j = 0; j < frames; ++j) {
      rows.push_back(phi);
      const auto at = [&](int i) {
        const int inside = ends == Ends::half_a_cell ? (i < 0    ? 0
                                                        : i == N ? N - 1
                                                                 : i)
                                                     : (i < 0    ? 1
                                                        : i == N ? N - 2
                                                                 : i);
        return phi[inside];
      };
      Row F;
      for (int i = 0; i < N; ++i) F.push_back((at(i - 1) - 2 * at(i) + at(i + 1)) / (k * k) - std::sin(at(i)));
      for (int i = 0; i < N; ++i) {
        if (ends == Ends::fixed && (i == 0 || i == N - 1)) continue;
        const std::size_t n = i;
        pi[n] += h * F[n], phi[n] += h * pi[n];
      }
    }
    return rows;
  };
  const auto between = [](Wall wall) { return scene("sine-gordon", Lattice::interval(N, k * (N - 1), wall, wall)); };
  // Fourth order, drifts first: frames are those of whole steps.
  Rows yoshida;
  Row phi = row_of(breather, 0), pi(N, 0.0);
  const double outer = 1 / (2 - std::cbrt(2.0));
  while (yoshida.size() < 30) {
    yoshida.push_back(phi);
    for (const double w : {outer, 1 - 2 * outer, outer}) {
      for (std::size_t i = 0; i < phi.size(); ++i) phi[i] += w * h / 2 * pi[i];
      const Row F = sine_gordon()(phi, phi);
      for (std::size_t i = 0; i < phi.size(); ++i) pi[i] += w * h * F[i], phi[i] += w * h / 2 * pi[i];
    }
  }
  for (const Case& c : std::vector<Case>{
           {"quartic", with(quartic, scene("phi4")), "the equations of triangle-vertex", "coefficient"},
           {"quartic, k too large", with(quartic, scene("phi4", Lattice::circle(N, 1.1 * L))), "lattice.length = 40",
            "time step"},
           {"quartic, h too small", with(quartic, scene("phi4", Lattice::circle(N, L), h / 1.1)),
            "try lattice.time_step = 0.3125", "wave speed"},
           {"semi-implicit, order 4", with(implicit),
            "D²φ of the rows j − 1, j, j + 1 with the weights 0.5, 0, 0.5, and N′(φ) with the weights 0, 1, 0 (D² and "
            "N′ of "
            "composition (2,4))",
            "time step"},
           {"Euler, fixed ends", with(euler(Ends::fixed), between(Wall::fixed)), "the equations of triangle-vertex",
            "seam"},
           {"Euler, fixed ends on a circle", with(euler(Ends::fixed)), "between fixed walls", "mirrors"},
           {"Euler, mirrors", with(euler(Ends::mirror), between(Wall::natural)), "the equations of triangle-vertex",
            "seam"},
           {"Euler, mirrors on a circle", with(euler(Ends::mirror)), "The ends are mirrors, φ₋₁ = φ₁", "fixed"},
           {"Euler, mirrors half a cell on", with(euler(Ends::half_a_cell)), "φ₋₁ = φ₀", "fixed"},
           {"Yoshida on fields", with(yoshida), "method of order 4, drifts first", "not symplectic"},
           {"an aliased first row", with(changed(leapfrog(), [](Rows& r) { r[0] = r[1]; })),
            "Frames 0 and 1 are the same", "time step"},
       })
    check(c);
}

TEST_CASE("a diagnosis names elements whose rows hold neither masses of sites nor traces") {
  // Row 0, the same in all nodes and traces, and what follows; from rest where the scheme takes momenta.
  const auto elements = [](const Problem& p, const Row& first, int count) {
    Simulation s(p);
    const std::size_t C = s.components().size(), d = delf::at(s.count(Role::field));
    Row all(first.size() / d * C), written(first.size());
    for (std::size_t at = 0; at < all.size(); ++at)
      if (const Component& c = s.components()[at % C]; c.role != Role::multiplier)
        all[at] = first[at / C * d + delf::at(c.field)];
    if (p.method == "dgvi") s.start({all});
    else s.start_legendre(all, Row(all.size(), 0.0));
    Rows rows{first};
    while (static_cast<int>(rows.size()) < count) {
      while (s.newest() < static_cast<std::int64_t>(rows.size())) s.step();
      s.copy_row(0, written);
      rows.push_back(written);
    }
    return rows;
  };
  constexpr int few = 24;
  const Problem small = scene("sine-gordon", Lattice::circle(few, few * k));
  const auto pulse = [](double t, double x) { return breather(t, x + 14); };
  Problem linear = small;
  linear.method = "cgvi";
  linear.parameters["scheme.space"] = std::string("linear"), linear.parameters["scheme.functions"] = 2;
  linear.parameters["scheme.basis"] = std::string("lagrange-lobatto");
  linear.parameters["scheme.quadrature"] = std::string("gauss"), linear.parameters["scheme.points"] = 1;
  linear.parameters["scheme.continuity"] = std::string("shared");
  Problem populations = scene("lotka-volterra", Lattice::point(), 0.1), broken = populations;
  populations.stencil = "midpoint";
  broken.method = "dgvi", broken.parameters["scheme.functions"] = 2, broken.parameters["scheme.points"] = 2;
  const Rows traced = elements(broken, {1, 1.2}, 40);
  for (const Case& c : std::vector<Case>{
           {"linear elements", with(elements(linear, row_of(pulse, 0, few), 12), small), "scheme.space = linear",
            "not symplectic"},
           {"broken elements", with(traced, populations), "A run of dgvi S=2 gauss2", "equations of"},
           {"broken elements, a frame on", with({traced.begin() + 1, traced.end()}, populations), "", "A run of"},
       }) {
    if (!c.says.empty()) check(c);
    else CHECK(diagnosis(c.written).find(c.never) == std::string::npos);
  }
}

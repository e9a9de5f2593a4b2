// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "tests/schemes/states/central_differences.hpp"
#include "tests/schemes/states/state_requests.hpp"

using namespace delf;
using namespace delf::testing;

constexpr double pi = std::numbers::pi;

TEST_CASE("a point in phase space has the numbers that are given, and velocities by its momenta", "[states]") {
  const Lattice point = Lattice::point();
  const auto state = make_state(body("0.25, 0.125", " -1e-2,0.5 "), point);
  CHECK(values(*state, 0, point) == std::vector<double>{0.25, 0.125});
  CHECK(velocities(*state, 0, point) == std::vector<double>{-1e-2, 0.5});
  CHECK(velocities(*make_state(request("point", "pendulum"), point), 0, point) == std::vector<double>{0});

  // p = 2v
  StateRequest r = request("point", "pendulum");
  r.values["initial.q"] = std::string("0.7"), r.values["initial.p"] = std::string("0.3");
  CHECK(key_of(r, point) == "initial.p");  // nobody tells the velocity
  r.velocity_of = [](auto, auto p) { return std::optional(std::vector<double>{p[0] / 2}); };
  CHECK(velocities(*make_state(r, point), 0, point) == std::vector<double>{0.15});
  r.values["initial.v"] = std::string("0");
  CHECK(key_of(r, point) == "initial.p");
  for (const char* bad : {"1", "1, 2, 3", "1, x", "1,", "1, inf", "1 2"}) {
    CAPTURE(bad);
    CHECK(key_of(body(bad, "0, 0"), point) == "initial.q");
    CHECK(key_of(body("0, 0", bad), point) == "initial.v");
  }
  CHECK(key_of(body("0, 0", "0, 0"), point) == "none");
}

TEST_CASE("an orbit keeps its energy and its angular momentum, and starts at the pericentre", "[states]") {
  const Lattice point = Lattice::point();
  for (const double e : {0.0, 0.6, 0.9, 0.999}) {
    const auto orbit = make_state(
        with(request("kepler-orbit", "kepler"), [&](StateRequest& r) { r.values["initial.eccentricity"] = e; }), point);
    CAPTURE(e);
    CHECK(orbit->components() == 2);
    CHECK(std::abs(values(*orbit, 0, point)[0] - (1 - e)) < 1e-15);
    CHECK(values(*orbit, 0, point)[1] == 0);
    for (const double t : {1e-9, 1e-3, 0.3, 3.0, -2.0, pi, 100.0}) {
      const auto q = values(*orbit, t, point), v = velocities(*orbit, t, point);
      const double radius = std::hypot(q[0], q[1]);
      CHECK(std::abs(((v[0] * v[0] + v[1] * v[1]) / 2 - 1 / radius + 0.5) * radius) < 1e-13);
      CHECK(std::abs(q[0] * v[1] - q[1] * v[0] - std::sqrt((1 - e) * (1 + e))) < 1e-12);
      // Kepler's equation from where the body is
      const double E = std::atan2(q[1] / std::sqrt((1 - e) * (1 + e)), q[0] + e);
      CHECK(std::abs(std::remainder(E - e * std::sin(E) - t, 2 * pi)) < 1e-13);
    }
  }
}

TEST_CASE("a pendulum starts at rest at its amplitude and is back after a period", "[states]") {
  const Lattice point = Lattice::point();
  for (const double A : {2.0, -2.0, 1e-8, 0.0, 3.14159}) {
    const auto swing = make_state(
        with(request("pendulum-swing", "pendulum"), [&](StateRequest& r) { r.values["initial.amplitude"] = A; }),
        point);
    CAPTURE(A);
    CHECK(std::abs(values(*swing, 0, point)[0] - A) < 1e-15);
    CHECK(velocities(*swing, 0, point)[0] == 0);
    for (const double t : {0.2, 3.0, 50.0, -7.0}) {
      const double q = values(*swing, t, point)[0], v = velocities(*swing, t, point)[0];
      CHECK(std::abs(v * v / 4 + std::pow(std::sin(q / 2), 2) - std::pow(std::sin(A / 2), 2)) < 1e-14);
    }
  }
  // 4 K(sin 1) = 8.3497427600678..., by the arithmetic–geometric mean of 1 and cos 1
  double a = 1, b = std::cos(1.0);
  for (int i = 0; i < 6; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b), a = mean;
  }
  const auto swing = make_state(request("pendulum-swing", "pendulum"), point);
  CHECK(std::abs(values(*swing, 2 * pi / a, point)[0] - 2) < 1e-14);
  CHECK(std::abs(values(*swing, pi / a, point)[0] + 2) < 1e-14);
}

TEST_CASE("coupled pulses move together, or apart if the scene says so", "[states]") {
  const Lattice circle = Lattice::circle(240, 60);
  auto r = request("coupled-kinks", "coupled-sine-gordon");
  auto state = make_state(r, circle);
  CHECK(state->components() == 2);
  CHECK(state->winding() == 1);
  const auto alone = values(*make_state(request("kink"), circle), 2, circle), pair = values(*state, 2, circle);
  for (std::size_t i = 0; i < alone.size(); ++i) {
    CHECK(pair[2 * i] == alone[i]);
    CHECK(pair[2 * i + 1] == alone[i]);
  }
  r.values["initial.separation"] = 10.0;
  state = make_state(r, circle);
  CHECK_FALSE(state->exact());
  CHECK(state->exact_until() == 0);
  CHECK(state->winding() == 1);
  const auto apart = values(*state, 0, circle);  // at 25 and 35
  CHECK(std::abs(apart[2 * 100] - pi) < 1e-13);
  CHECK(std::abs(apart[2 * 140 + 1] - pi) < 1e-13);
  CHECK(make_state(r, Lattice::interval(241, 60))->winding() == 0);
  r.name = "coupled-breathers";
  CHECK(make_state(r, circle)->winding() == 0);
  CHECK_FALSE(make_state(r, circle)->exact());
  r.values["initial.separation"] = 0.0;
  CHECK(make_state(r, circle)->exact());
}

TEST_CASE("a charged packet turns at its frequency and closes around the circle", "[states]") {
  const double L = 20, m = 1.3;
  const Lattice circle = Lattice::circle(400, L);
  auto r = request("charged-packet", "complex-klein-gordon");
  r.values["theory.mass"] = m, r.values["initial.wavenumber"] = 3, r.values["initial.width"] = 6.0,
  r.values["initial.position"] = 4.0;
  const auto state = make_state(r, circle);
  CHECK_FALSE(state->exact());
  CHECK_FALSE(state->knows_second_row());
  const auto y = values(*state, 0, circle), v = velocities(*state, 0, circle);
  const double q = 6 * pi / L, omega = std::sqrt(q * q + m * m);
  double steepest = 0;
  for (std::size_t i = 0; i < 400; ++i) {
    CHECK(std::abs(v[2 * i] - omega * y[2 * i + 1]) < 1e-14);
    CHECK(std::abs(v[2 * i + 1] + omega * y[2 * i]) < 1e-14);
    if (i > 0) steepest = std::max(steepest, std::abs(y[2 * i] - y[2 * i - 2]));
  }
  CHECK(std::abs(y[0] - y[798]) <= steepest);
  CHECK(y[2 * 80] > 0.1);  // with images, a little above A
  CHECK(y[2 * 80 + 1] == 0);
  CHECK(velocity_defect(*state, circle, 0.4, 0.01) < 1e-11);
}

TEST_CASE("a great circle stays on the sphere and moves in all three components", "[states]") {
  const Lattice circle = Lattice::circle(50, 7);
  const auto state = make_state(request("great-circle", "wave-map"), circle);
  CHECK(state->components() == 3);
  const auto u = values(*state, 0.9, circle), v = velocities(*state, 0.9, circle);
  double least[3]{1, 1, 1}, most[3]{-1, -1, -1};
  for (std::size_t i = 0; i < u.size(); i += 3) {
    CHECK(std::abs(u[i] * u[i] + u[i + 1] * u[i + 1] + u[i + 2] * u[i + 2] - 1) < 1e-14);
    CHECK(std::abs(u[i] * v[i] + u[i + 1] * v[i + 1] + u[i + 2] * v[i + 2]) < 1e-14);
    for (std::size_t a = 0; a < 3; ++a) least[a] = std::min(least[a], u[i + a]), most[a] = std::max(most[a], u[i + a]);
  }
  for (std::size_t a = 0; a < 3; ++a) CHECK(most[a] - least[a] > 0.1);
}

TEST_CASE("noise has draws of its own in each component", "[states]") {
  const Lattice circle = Lattice::circle(100, 20);
  auto r = request("noise");
  const auto one = values(*make_state(r, circle), 0, circle);
  r.theory = "coupled-sine-gordon", r.components = 2;
  const auto state = make_state(r, circle);
  CHECK(state->components() == 2);
  const auto two = values(*state, 0, circle);
  double difference = 0, highest = 0;
  for (std::size_t i = 0; i < one.size(); ++i) {
    CHECK(two[2 * i] == one[i]);  // the first is what a single one would be
    difference = std::max(difference, std::abs(two[2 * i + 1] - two[2 * i]));
    highest = std::max(highest, std::abs(two[2 * i + 1]));
  }
  CHECK(difference > 0.01);
  CHECK(std::abs(highest - 0.1) < 5e-3);
}

TEST_CASE("a kink goes round the circle and keeps counting", "[states]") {
  const double v = 0.5, L = 40;
  const Lattice lattice = Lattice::circle(250, L);
  const std::pair<const char*, double> turns[]{{"kink", -2 * pi}, {"antikink", 2 * pi}};
  for (const auto& [name, turn] : turns) {
    const auto state =
        make_state(with(request(name), [&](StateRequest& r) { r.values["initial.speed"] = v; }), lattice);
    const auto start = values(*state, 0, lattice), once = values(*state, L / v, lattice);
    const auto twice = values(*state, 2 * L / v, lattice);
    for (std::size_t i = 0; i < start.size(); ++i) {
      CHECK(std::abs(once[i] - (start[i] + turn)) < 1e-12);
      CHECK(std::abs(twice[i] - (start[i] + 2 * turn)) < 1e-12);
    }
  }
  // and so does a train: n = 3 kinks pass each site in the time L/v
  const auto train = make_state(
      with(request("kink-train"), [&](StateRequest& r) { r.values["initial.speed"] = v, r.winding = 3; }), lattice);
  const auto start = values(*train, 0, lattice), once = values(*train, L / v, lattice);
  for (std::size_t i = 0; i < start.size(); ++i) CHECK(std::abs(once[i] - (start[i] - 6 * pi)) < 1e-12);
}

TEST_CASE("around a circle a state gains 2 pi times its winding", "[states]") {
  const double L = 60;
  const Lattice lattice = Lattice::circle(300, L);
  const std::pair<const char*, int> windings[]{{"kink", 1},       {"antikink", -1},   {"kink-antikink", 0},
                                               {"kink-kink", 2},  {"breather", 0},    {"noise", 0},
                                               {"plane-wave", 0}, {"wave-packet", 0}, {"kink-train", 1}};
  for (const auto& [name, n] : windings) {
    auto r = request(name);
    if (r.name == "kink-train") r.values["initial.speed"] = 0.3;
    r.winding = n;
    const auto state = make_state(r, lattice);
    CAPTURE(name);
    CHECK(state->winding() == n);
    // the last step, across the seam, closes what the others leave open
    for (const double t : {0.0, 3.0}) {
      const auto y = values(*state, t, lattice);
      double steepest = 0;
      for (std::size_t i = 1; i < y.size(); ++i) steepest = std::max(steepest, std::abs(y[i] - y[i - 1]));
      CHECK(std::abs(y.front() + 2 * pi * n - y.back()) <= 1.01 * steepest);
    }
  }
}

TEST_CASE("a kink that goes round is at its position at t = 0, in the middle unless told otherwise", "[states]") {
  const Lattice lattice = Lattice::circle(200, 40);
  for (const char* name : {"kink", "antikink", "kink-train"}) {
    auto r = request(name);
    r.values["initial.speed"] = 0.2;
    CHECK(std::abs(values(*make_state(r, lattice), 0, lattice)[100] - pi) < 5e-14);
    r.values["initial.position"] = 7;
    CHECK(std::abs(values(*make_state(r, lattice), 0, lattice)[35] - pi) < 5e-14);
    CHECK(std::abs(values(*make_state(r, lattice), 5, lattice)[40] - pi) < 5e-14);
  }
}

TEST_CASE("two pulses come together from about the separation asked for", "[states]") {
  const Lattice lattice = Lattice::circle(4000, 60);
  auto r = request("kink-kink");
  r.values["initial.speed"] = 0.9,
  r.values["initial.separation"] = 9.0;  // v(t − 5), as in Tyranowski–Desbrun's two solitons
  const auto y = values(*make_state(r, lattice), 0, lattice);
  const double gamma = 1 / std::sqrt(1 - 0.81);
  for (const int i : {0, 1700, 2000, 2100, 2290, 3999}) {
    const double x = i * 60.0 / 4000 - 30;
    CHECK(std::abs(y[i] - 4 * std::atan(0.9 * std::sinh(gamma * x) / std::cosh(gamma * 0.9 * -5))) < 1e-13);
  }
  // φ = ±π near x = ±4.5: two rising pulses
  CHECK(std::abs(y[1700] - (-pi)) < 0.5);
  CHECK(std::abs(y[2300] - pi) < 0.5);
  r.name = "kink-antikink";
  const auto before = values(*make_state(r, lattice), 0, lattice), after = values(*make_state(r, lattice), 10, lattice);
  CHECK(std::abs(before[2000] - (-2 * pi)) < 1e-3);
  CHECK(std::abs(after[2000] - 2 * pi) < 1e-3);
  CHECK(std::abs(values(*make_state(r, lattice), 5, lattice)[2000]) < 1e-14);
}

TEST_CASE("far away and long after, pulses are finite", "[states]") {
  const std::pair<const char*, const char*> pulses[]{
      {"kink", "sine-gordon"},      {"kink", "double-sine-gordon"}, {"kink", "phi4"},
      {"antikink", "sine-gordon"},  {"antikink", "phi4"},           {"kink-antikink", "sine-gordon"},
      {"kink-kink", "sine-gordon"}, {"breather", "sine-gordon"}};
  const Lattice lattice = Lattice::interval(801, 2e4);
  for (const auto& [name, theory] : pulses)
    for (const double v : {1e-300, 0.5, 1 - 1e-15}) {
      auto r = request(name, theory);
      r.values["initial.speed"] = v;
      const auto state = make_state(r, lattice);
      for (const double t : {0.0, 1e4, -1e4}) {
        const auto y = values(*state, t, lattice), dy = velocities(*state, t, lattice);
        CAPTURE(state->description(), t);
        CHECK(std::all_of(y.begin(), y.end(), [](double a) { return std::abs(a) <= 2 * pi; }));
        CHECK(std::all_of(dy.begin(), dy.end(), [](double a) { return std::isfinite(a); }));
      }
    }
}

TEST_CASE("the paper's collision: K, c and the profile to all digits", "[states]") {
  // independent solution in quadruple precision: K = 7.94747977356234476503, c = 0.777299380496225785738
  const double h = 40.0 / 255 / 8, c = 0.777299380496225785738;
  const auto at = [](int sites) { return Lattice::circle(sites, 40); };
  const auto state = make_state(request("mps-collision"), at(255));
  CHECK_FALSE(state->exact());
  CHECK(state->knows_second_row());
  CHECK(state->winding() == 0);
  CHECK(state->description().find("c = 0.7772993805") != std::string::npos);
  CHECK(state->description().find("P = 15.89495955") != std::string::npos);

  const auto y0 = values(*state, 0, at(255));
  CHECK(std::abs(y0[1] - 0.0007125487924485414963025274) < 1e-15);
  const std::pair<double, double> profile[]{{1, 0.006642903643027975120436766}, {2.5, 0.07517662722198357809248349},
                                            {4, 0.8050623861232871719372417},   {4.9, 2.825023685633072934146822},
                                            {5.5, 4.586135019064001477060776},  {9, 6.27654240353655850180485}};
  const auto y = values(*state, 0, at(400));
  for (const auto& [x, phi] : profile) {
    const std::size_t i = std::lround(10 * x);
    CHECK(std::abs(y[i] - phi) < 2e-14);
    CHECK(std::abs(y[400 - i] - phi) < 2e-14);  // its mirror image
  }

  // branches by integers: 4i < N, 4i < 3N
  CHECK(y0[63] < 2 * pi);
  CHECK(y0[64] == 2 * pi);
  CHECK(y0[191] == 2 * pi);
  CHECK(y0[192] < 2 * pi);
  CHECK(values(*state, 0, at(256))[64] == 2 * pi);
  CHECK(values(*state, h, at(256))[192] < 2 * pi);

  // the second row: each soliton translated exactly; φ̃ at x − hc is at the site of a lattice that is moved by hc
  const auto y1 = values(*state, h, at(255));
  for (std::size_t i = 1; i < y1.size(); ++i) CHECK(y1[i] == y1[y1.size() - i]);
  const auto later = values(*state, 1 / c, at(400));
  CHECK(std::abs(later[35] - y[25]) < 2e-14);
  CHECK(std::abs(later[365] - y[375]) < 2e-14);
  CHECK(velocity_defect(*state, at(255), 0.3, 0.02) < 1e-9);
  const auto v = velocities(*state, 0, at(400));
  CHECK(std::abs(v[50] + c * 3.178991909424937906013731) < 2e-14);   // φ̃′(5)
  CHECK(std::abs(v[0] + c * 0.00449577234903958021055118) < 1e-14);  // φ̃′(0)
  CHECK(v[200] == 0);

  // both rows at once: the energy of footnote 4 between them, in quadruple precision 161.9006790572685849
  const double k = 40.0 / 255;
  double energy = 0;
  for (std::size_t i = 0; i < 255; ++i) {
    const std::size_t e = (i + 1) % 255;
    const double phi_t = (y1[i] - y0[i] + y1[e] - y0[e]) / (2 * h), phi_x = (y0[e] - y0[i] + y1[e] - y1[i]) / (2 * k);
    const double mean = (y0[i] + y0[e] + y1[i] + y1[e]) / 4;
    energy += (phi_t * phi_t + phi_x * phi_x) / 2 + 1 - std::cos(mean);
  }
  CHECK(std::abs(energy - 161.9006790572685849) < 1e-11);

  // lengths and masses scale together
  auto heavy = request("mps-collision");
  heavy.values["theory.mass"] = 2;
  const auto scaled = values(*make_state(heavy, Lattice::circle(255, 20)), 0, Lattice::circle(255, 20));
  for (std::size_t i = 0; i < scaled.size(); ++i) CHECK(std::abs(scaled[i] - y0[i]) < 2e-14);
}

TEST_CASE("a kink train of a given speed or a given epsilon is the same train", "[states]") {
  const Lattice ring = Lattice::circle(100, 10);
  auto r = request("kink-train");
  const auto of_epsilon = make_state(r, ring);
  r.values["initial.speed"] = 0.777299380496225785738;
  const auto of_speed = make_state(r, ring);
  const auto a = values(*of_epsilon, 2, ring), b = values(*of_speed, 2, ring);
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 1e-13);
  // long periods, far beyond the ε that 1 − κ can hold: a train is then a row of kinks
  const Lattice longer = Lattice::circle(500, 200);
  r.values["initial.speed"] = 0.5;
  const auto train = values(*make_state(r, longer), 3, longer);
  r.name = "kink";
  const auto kink = values(*make_state(r, longer), 3, longer);
  for (std::size_t i = 0; i < kink.size(); ++i) CHECK(std::abs(train[i] - kink[i]) < 1e-12);
}

TEST_CASE("noise is smooth, of the given height, and the same for the same seed", "[states]") {
  const Lattice coarse = Lattice::circle(100, 20), fine = Lattice::circle(1000, 20);
  auto r = request("noise");
  r.seed = 7;
  const auto state = make_state(r, coarse);
  const auto y = values(*state, 0, coarse), z = values(*make_state(r, fine), 0, fine);
  for (std::size_t i = 0; i < y.size(); ++i) CHECK(std::abs(y[i] - z[10 * i]) < 1e-14);
  double highest = 0;
  for (const double a : z) highest = std::max(highest, std::abs(a));
  CHECK(std::abs(highest - 0.1) < 1e-4);
  CHECK_FALSE(state->exact());
  CHECK_FALSE(state->knows_second_row());
  // the 64-bit Mersenne twister with our own map to [0, 1): these are the numbers of any library
  CHECK(std::abs(y[0] - 0.030005797222279262) < 1e-14);
  CHECK(std::abs(velocities(*state, 0, coarse)[0] + 0.047635439523753147) < 1e-14);
  r.seed = 8;
  CHECK(std::abs(values(*make_state(r, coarse), 0, coarse)[0] - y[0]) > 1e-3 * std::abs(y[0]));
  // between walls that are fixed nothing moves at the walls
  const Lattice walls = Lattice::interval(101, 20);
  const auto fixed = make_state(r, walls);
  CHECK(values(*fixed, 0, walls).front() == 0);
  CHECK(values(*fixed, 0, walls).back() == 0);
  CHECK(velocities(*fixed, 0, walls).back() == 0);
}

TEST_CASE("a state says until when it can be compared with", "[states]") {
  const double forever = std::numeric_limits<double>::infinity();
  const auto until = [](const StateRequest& r, const Lattice& lattice) {
    return make_state(r, lattice)->exact_until();
  };
  auto moving = request("kink");
  moving.values["initial.speed"] = 0.5;
  CHECK(until(moving, Lattice::circle(100, 40)) == forever);
  CHECK(until(request("kink"), Lattice::interval(100, 4)) == forever);  // at rest between fixed walls
  const double end = until(moving, Lattice::interval(100, 40));
  CHECK(end > 25);
  CHECK(end < 40);
  auto pair = request("kink-antikink");
  pair.values["initial.speed"] = 0.5, pair.values["initial.separation"] = 10.0;
  CHECK(until(pair, Lattice::circle(100, 60)) > 40);
  CHECK(until(pair, Lattice::circle(100, 60)) < 70);
  CHECK(until(request("kink"), Lattice::circle(100, 4)) == 0);  // as wide as the circle
  CHECK_FALSE(make_state(request("kink"), Lattice::circle(100, 4))->exact());
  CHECK_FALSE(make_state(request("kink", "sine-gordon-impurity"), Lattice::circle(100, 40))->exact());
}

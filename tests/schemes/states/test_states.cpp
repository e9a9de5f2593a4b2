// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <limits>
#include <numbers>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/nearest_name.hpp"
#include "schemes/states/state_registry.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

constexpr double pi = std::numbers::pi;

StateRequest request(const std::string& name, const std::string& theory = "sine-gordon") {
  StateRequest r;
  r.name = name;
  r.theory = theory;
  if (name == "formula") r.values["initial.phi"] = std::string("0.1");
  return r;
}

std::vector<double> values(const State& state, double t, const Lattice& lattice) {
  std::vector<double> y(static_cast<std::size_t>(lattice.sites() * state.components()));
  state.values(t, lattice, y);
  return y;
}
std::vector<double> velocities(const State& state, double t, const Lattice& lattice) {
  std::vector<double> y(static_cast<std::size_t>(lattice.sites() * state.components()));
  state.velocities(t, lattice, y);
  return y;
}

double mass_of(const StateRequest& r) { return r.values.maybe<double>("theory.mass").value_or(1); }
double lambda_of(const StateRequest& r) { return r.values.maybe<double>("theory.lambda").value_or(1); }

// −N′(φ)
double force(const StateRequest& r, double phi) {
  const double m2 = mass_of(r) * mass_of(r);
  if (r.theory == "wave") return 0;
  if (r.theory == "klein-gordon") return m2 * phi;
  if (r.theory == "phi4") return lambda_of(r) * phi * (phi * phi - 1);
  if (r.theory == "double-sine-gordon") return m2 * std::sin(phi) + lambda_of(r) * std::sin(2 * phi);
  return m2 * std::sin(phi);
}

// Central differences of order 8 at the distances 0 … 4.
constexpr double second[]{-205.0 / 72, 8.0 / 5, -1.0 / 5, 8.0 / 315, -1.0 / 560};
constexpr double first[]{0, 4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};

// The larger magnitude; NaN if either is.
double larger(double worst, double error) {
  return std::abs(error) > worst || std::isnan(error) ? std::abs(error) : worst;
}

// max |φ_tt − φ_xx − N′(φ)| over the lattice at time t, by differences of values() with one step in t and x.
double defect(const State& state, const StateRequest& r, const Lattice& lattice, double t) {
  const double k = lattice.space_step();
  std::vector<std::vector<double>> rows;
  for (int j = -4; j <= 4; ++j) rows.push_back(values(state, t + j * k, lattice));
  const auto& now = rows[4];
  const auto at = [&](int i) {
    const int around = i < 0 ? -1 : i >= lattice.sites() ? 1 : 0;
    return now[static_cast<std::size_t>(i - around * lattice.sites())] + 2 * pi * state.winding() * around;
  };
  double worst = 0;
  const int margin = lattice.is_circle() ? 0 : 4;
  for (int i = margin; i < lattice.sites() - margin; ++i) {
    const auto s = static_cast<std::size_t>(i);
    double tt = second[0] * now[s], xx = second[0] * now[s];
    for (int m = 1; m <= 4; ++m) {
      const auto d = static_cast<std::size_t>(m);
      tt += second[d] * (rows[4 + d][s] + rows[4 - d][s]);
      xx += second[d] * (at(i + m) + at(i - m));
    }
    worst = larger(worst, (tt - xx) / (k * k) + force(r, now[s]));
  }
  return worst;
}

// max |velocities() − φ_t by differences of values()| over the lattice; sign = −1 plants an error.
double velocity_defect(const State& state, const Lattice& lattice, double t, double dt, double sign = 1) {
  std::vector<double> difference(static_cast<std::size_t>(lattice.sites() * state.components()));
  for (int m = 1; m <= 4; ++m) {
    const auto later = values(state, t + m * dt, lattice), earlier = values(state, t - m * dt, lattice);
    for (std::size_t i = 0; i < difference.size(); ++i) difference[i] += first[m] * (later[i] - earlier[i]) / dt;
  }
  const auto v = velocities(state, t, lattice);
  double worst = 0;
  for (std::size_t i = 0; i < v.size(); ++i) worst = larger(worst, sign * v[i] - difference[i]);
  return worst;
}

struct Case {
  std::string title;
  StateRequest request;
  Lattice lattice;
};

StateRequest with(StateRequest r, const std::function<void(StateRequest&)>& change) {
  change(r);
  return r;
}

// Every exact state, in every theory that has it, at rest and moving, on circles and between walls.
std::vector<Case> exact_cases() {
  const Lattice circle = Lattice::circle(2000, 60), ring = Lattice::circle(400, 12);
  const Lattice interval = Lattice::interval(1501, 45), free = Lattice::interval(401, 12, Wall::natural, Wall::natural);
  const Lattice mixed = Lattice::interval(401, 12, Wall::fixed, Wall::natural);
  const auto set = [](double speed, double mass, double lambda = 1) {
    return [=](StateRequest& r) {
      r.values["initial.speed"] = speed, r.values["theory.mass"] = mass, r.values["theory.lambda"] = lambda;
    };
  };
  std::vector<Case> cases;
  for (const std::string name : {"kink", "antikink"}) {
    cases.push_back({name, with(request(name), set(0.5, 1)), circle});
    cases.push_back({name + " to the left", with(request(name), set(-0.7, 1.3)), circle});
    cases.push_back({name + " between walls", with(request(name), set(0.3, 0.9)), interval});
    cases.push_back({name + " of phi4", with(request(name, "phi4"), set(0.4, 7, 1.5)), interval});
    cases.push_back(
        {name + " of double sine-Gordon", with(request(name, "double-sine-gordon"), set(0.4, 1, 0.7)), circle});
    cases.push_back({name + " of double sine-Gordon, lambda < 0",
                     with(request(name, "double-sine-gordon"), set(-0.4, 1.5, -0.5)), circle});
  }
  for (const std::string name : {"kink-antikink", "kink-kink"}) {
    cases.push_back({name, with(request(name), set(0.6, 1.2)), circle});
    cases.push_back({name + " between walls", with(request(name), set(0.3, 1)), interval});
  }
  cases.push_back(
      {"breather", with(request("breather"), [](StateRequest& r) { r.values["theory.mass"] = 1.4; }), circle});
  cases.push_back({"boosted breather", with(request("breather"), set(0.5, 1.4)), circle});
  cases.push_back({"kink train of epsilon", request("kink-train"), ring});
  cases.push_back({"kink train of speed", with(request("kink-train"), set(-0.4, 0.8)), ring});
  cases.push_back(
      {"three antikinks",
       with(request("kink-train"), [](StateRequest& r) { r.winding = -3, r.values["initial.speed"] = 0.2; }), ring});
  for (const std::string theory : {"wave", "klein-gordon"}) {
    const auto waves = [](int n) {
      return [=](StateRequest& r) {
        r.values["theory.mass"] = 1.7, r.values["initial.wavenumber"] = n, r.values["initial.position"] = 1;
      };
    };
    for (const Lattice& lattice : {ring, Lattice::interval(401, 12), free, mixed})
      cases.push_back({"plane wave of " + theory, with(request("plane-wave", theory), waves(3)), lattice});
    cases.push_back({"plane wave to the left of " + theory, with(request("plane-wave", theory), waves(-2)), ring});
    cases.push_back({"wave packet of " + theory, with(request("wave-packet", theory), waves(5)), ring});
    cases.push_back({"wave packet to the left of " + theory, with(request("wave-packet", theory), waves(-5)), ring});
  }
  cases.push_back({"a formula",
                   with(request("formula", "wave"),
                        [](StateRequest& r) {
                          r.values = {};
                          r.values["exact.phi"] = std::string("0.4*sin(2*pi*(x - t)/L) + 0.1*cos(4*pi*(x + t)/L)");
                        }),
                   ring});
  return cases;
}

// −∂N/∂φ_a for a field of several components, which may depend on u_t and u_x: what is added to u_tt − u_xx.
using Row = std::vector<double>;
Row forces(const StateRequest& r, const Row& u, const Row& u_t, const Row& u_x) {
  const auto squared = [](const Row& v) {
    double sum = 0;
    for (const double a : v) sum += a * a;
    return sum;
  };
  const double m2 = mass_of(r) * mass_of(r);
  Row f = u;  // klein-gordon of mass 1
  if (r.theory == "kepler") {
    for (double& a : f) a *= std::pow(squared(u), -1.5);
  } else if (r.theory == "pendulum") {
    f[0] = m2 * std::sin(u[0]);
  } else if (r.theory == "coupled-sine-gordon") {
    const double pull = lambda_of(r) * std::sin(u[0] - u[1]);
    f = {m2 * std::sin(u[0]) + pull, m2 * std::sin(u[1]) - pull};
  } else if (r.theory == "complex-klein-gordon") {
    for (double& a : f) a *= m2 + lambda_of(r) * squared(u);
  } else if (r.theory == "wave-map") {
    for (double& a : f) a *= squared(u_t) - squared(u_x);
  }
  return f;
}

// max |u_tt − u_xx + forces| at time t, by differences of values() with the steps dt and k; no u_x at a point.
double defect_of_several(const State& state, const StateRequest& r, const Lattice& lattice, double t, double dt) {
  const int d = state.components(), N = lattice.sites();
  const double k = lattice.space_step();
  const bool point = lattice.space() == Space::point;
  std::vector<Row> rows;
  for (int j = -4; j <= 4; ++j) rows.push_back(values(state, t + j * dt, lattice));
  const auto at = [&](int i, int a) {
    const int around = i < 0 ? -1 : i >= N ? 1 : 0;
    return rows[4][static_cast<std::size_t>((i - around * N) * d + a)] + 2 * pi * state.winding() * around;
  };
  double worst = 0;
  const int margin = lattice.space() == Space::interval ? 4 : 0;
  for (int i = margin; i < N - margin; ++i) {
    Row u, u_t, u_x, box;
    for (int a = 0; a < d; ++a) {
      const auto s = static_cast<std::size_t>(i * d + a);
      double t1 = 0, x1 = 0, t2 = second[0] * rows[4][s], x2 = t2;
      for (int m = 1; m <= 4; ++m) {
        const auto e = static_cast<std::size_t>(m);
        t1 += first[e] * (rows[4 + e][s] - rows[4 - e][s]), t2 += second[e] * (rows[4 + e][s] + rows[4 - e][s]);
        if (!point) x1 += first[e] * (at(i + m, a) - at(i - m, a)), x2 += second[e] * (at(i + m, a) + at(i - m, a));
      }
      u.push_back(rows[4][s]), u_t.push_back(t1 / dt), u_x.push_back(x1 / k);
      box.push_back(t2 / (dt * dt) - (point ? 0 : x2 / (k * k)));
    }
    const Row f = forces(r, u, u_t, u_x);
    for (std::size_t a = 0; a < f.size(); ++a) worst = larger(worst, box[a] + f[a]);
  }
  return worst;
}

// Every exact state of mechanics and of fields of several components.
std::vector<Case> cases_of_several() {
  const Lattice point = Lattice::point(), circle = Lattice::circle(2000, 60), ring = Lattice::circle(400, 12);
  const Lattice interval = Lattice::interval(1501, 45);
  const auto make = [](const char* name, const char* theory, const std::function<void(StateRequest&)>& change) {
    return with(request(name, theory), change);
  };
  const auto pulse = [](double speed) {
    return [=](StateRequest& r) {
      r.values["initial.speed"] = speed, r.values["theory.mass"] = 1.2, r.values["theory.lambda"] = 0.7;
    };
  };
  std::vector<Case> cases;
  for (const double e : {0.0, 0.3, 0.6})
    cases.push_back({"orbit",
                     make("kepler-orbit", "kepler", [&](StateRequest& r) { r.values["initial.eccentricity"] = e; }),
                     point});
  for (const double A : {2.0, -1.0, 3.1})
    cases.push_back({"swing",
                     make("pendulum-swing", "pendulum",
                          [&](StateRequest& r) { r.values["initial.amplitude"] = A, r.values["theory.mass"] = 1.3; }),
                     point});
  for (const char* name : {"coupled-kinks", "coupled-breathers"})
    for (const Lattice& lattice : {circle, interval})
      cases.push_back({name, make(name, "coupled-sine-gordon", pulse(0.4)), lattice});
  cases.push_back({"uncoupled kinks",
                   make("coupled-kinks", "coupled-sine-gordon",
                        [](StateRequest& r) {
                          r.values["initial.separation"] = 5.0, r.values["initial.speed"] = 0.2,
                          r.values["theory.lambda"] = 0;
                        }),
                   circle});
  for (const double n : {2.0, -3.0})
    cases.push_back({"charged wave",
                     make("charged-wave", "complex-klein-gordon",
                          [&](StateRequest& r) {
                            r.values["initial.wavenumber"] = n, r.values["theory.mass"] = 1.1,
                            r.values["theory.lambda"] = 1.5, r.values["initial.amplitude"] = 0.8;
                          }),
                     ring});
  cases.push_back({"great circle", request("great-circle", "wave-map"), ring});
  cases.push_back(
      {"great circle the other way",
       make("great-circle", "wave-map",
            [](StateRequest& r) { r.values["initial.wavenumber"] = -2, r.values["initial.amplitude"] = 0.6; }),
       ring});
  return cases;
}

std::string key_of(const StateRequest& r, const Lattice& lattice = Lattice::circle(255, 40)) {
  try {
    make_state(r, lattice);
  } catch (const BadInput& error) {
    const std::string what = error.what();
    CHECK(what.find('\n') == std::string::npos);
    CHECK(what.find("; ") != std::string::npos);  // a remedy
    return error.key();
  }
  return "none";
}

}  // namespace

TEST_CASE("every exact state solves its field equation, and its velocities are the time derivatives", "[states]") {
  for (const Case& c : exact_cases()) {
    const auto state = make_state(c.request, c.lattice);
    CAPTURE(c.title, state->description());
    CHECK(state->exact());
    CHECK(state->knows_second_row());
    for (const double t : {0.0, 1.37, 6.1}) {
      REQUIRE(t < state->exact_until());
      CHECK(defect(*state, c.request, c.lattice, t) < 2e-6);
      CHECK(velocity_defect(*state, c.lattice, t, 0.01) < 1e-9);
    }
  }
}

TEST_CASE("the check can fail: another theory, another mass, a velocity of the other sign", "[states]") {
  for (const Case& c : exact_cases()) {
    const auto state = make_state(c.request, c.lattice);
    CAPTURE(c.title);
    CHECK(defect(*state,
                 with(c.request, [](StateRequest& r) { r.theory = "klein-gordon", r.values["theory.mass"] = 2.1; }),
                 c.lattice, 1.37) > 1e-2);
    CHECK(velocity_defect(*state, c.lattice, 1.37, 0.01, -1) > 1e-2);
  }
  const Lattice circle = Lattice::circle(2000, 60);
  const auto small =
      make_state(with(request("plane-wave"), [](StateRequest& r) { r.values["initial.amplitude"] = 0.1; }), circle);
  CHECK_FALSE(small->exact());
  CHECK(defect(*small, request("plane-wave"), circle, 0) > 1e-5);
}

TEST_CASE("exact states of mechanics and of several components solve their equations", "[states]") {
  for (const Case& c : cases_of_several()) {
    const auto state = make_state(c.request, c.lattice);
    CAPTURE(c.title, state->description());
    CHECK(state->exact());
    CHECK(state->knows_second_row());
    const bool point = c.lattice.space() == Space::point;
    const double dt = point ? 0.02 : c.lattice.space_step();
    for (const double t : {0.0, 1.37, 6.1}) {
      REQUIRE(t < state->exact_until());
      CHECK(defect_of_several(*state, c.request, c.lattice, t, dt) < 2e-6);
      CHECK(velocity_defect(*state, c.lattice, t, 0.01) < 1e-9);
    }
    // another theory; a velocity of the other sign
    StateRequest other = c.request;
    other.theory = other.theory == "kepler" ? "coupled-sine-gordon" : "klein-gordon", other.values["theory.mass"] = 1;
    CHECK(defect_of_several(*state, other, c.lattice, 1.37, dt) > 1e-2);
    CHECK(velocity_defect(*state, c.lattice, 1.37, 0.01, -1) > 1e-2);
  }
}

namespace {

// States that solve no equation, and give derivatives all the same.
StateRequest body(const std::string& q, const std::string& v, const char* theory = "henon-heiles") {
  StateRequest r = request("point", theory);
  r.components = 2;
  r.values["initial.q"] = q, r.values["initial.v"] = v;
  return r;
}

std::vector<Case> inexact_cases() {
  const Lattice ring = Lattice::circle(400, 12), interval = Lattice::interval(401, 12);
  const Lattice mixed = Lattice::interval(401, 12, Wall::natural, Wall::fixed);
  auto two = request("noise", "coupled-sine-gordon");
  two.components = 2;
  return {{"collision", request("mps-collision"), Lattice::circle(255, 40)},
          {"a gas of kinks", request("kink-gas"), Lattice::interval(400, 160)},
          {"a soliton between walls", request("soliton-bounce"), Lattice::interval(401, 25)},
          {"two solitons between walls", request("two-soliton-bounce"), Lattice::interval(401, 25)},
          {"noise", request("noise"), ring},
          {"noise between walls", request("noise"), interval},
          {"noise between other walls", request("noise"), mixed},
          {"noise of two components", two, ring},
          {"charged packet", request("charged-packet", "complex-klein-gordon"), ring},
          {"small plane wave", request("plane-wave", "double-sine-gordon"), ring},
          {"small wave packet", request("wave-packet"), ring},
          {"a pendulum on a sphere", request("spherical-swing", "spherical-pendulum"), Lattice::point()},
          {"the planets", request("solar-system", "solar-system"), Lattice::point()},
          {"a point in phase space", body("0.25, 0.125", "-1e-2,0.5"), Lattice::point()}};
}

// max |φ_t or φ_x − differences of φ| over points between the sites; sign = −1 plants an error.
double point_defect(const State& state, double FieldPoint::*derivative, const Lattice& lattice, double t,
                    double sign = 1) {
  const bool in_time = derivative == &FieldPoint::phi_t;
  const double d = 0.004, L = lattice.length();
  double worst = 0;
  std::vector<FieldPoint> here(static_cast<std::size_t>(state.components())), later(here), earlier(here);
  for (int n = 0; n < 23; ++n) {
    const double x = L * (0.0211 + 0.0417 * n);
    state.at(t, x, here);
    std::vector<double> difference(here.size());
    for (int m = 1; m <= 4; ++m) {
      state.at(in_time ? t + m * d : t, in_time ? x : x + m * d, later);
      state.at(in_time ? t - m * d : t, in_time ? x : x - m * d, earlier);
      for (std::size_t a = 0; a < here.size(); ++a) difference[a] += first[m] * (later[a].phi - earlier[a].phi) / d;
    }
    for (std::size_t a = 0; a < here.size(); ++a) worst = larger(worst, sign * here[a].*derivative - difference[a]);
  }
  return worst;
}

}  // namespace

TEST_CASE("every state gives phi, phi_t and phi_x at any point, and the same at the sites", "[states]") {
  std::vector<Case> cases = exact_cases();
  for (const auto& more : {cases_of_several(), inexact_cases()}) cases.insert(cases.end(), more.begin(), more.end());
  std::set<std::string> seen;
  for (const Case& c : cases) {
    const auto state = make_state(c.request, c.lattice);
    seen.insert(c.request.name);
    CAPTURE(c.title, state->description());
    const bool space = c.lattice.space() != Space::point, still = c.request.name == "noise";
    for (const double t : {0.0, 1.37}) {
      if (!still) CHECK(point_defect(*state, &FieldPoint::phi_t, c.lattice, t) < 1e-9);
      CHECK(point_defect(*state, &FieldPoint::phi_x, c.lattice, t) < 1e-9);
      if (space) CHECK(point_defect(*state, &FieldPoint::phi_x, c.lattice, t, -1) > 1e-3);

      std::vector<FieldPoint> here(static_cast<std::size_t>(state->components())), around(here);
      const auto y = values(*state, t, c.lattice), v = velocities(*state, t, c.lattice);
      for (int i = 0; i < c.lattice.sites(); i += 7) {
        state->at(t, c.lattice.position(i), here);
        state->at(t, c.lattice.position(i) + c.lattice.length(), around);
        for (std::size_t a = 0; a < here.size(); ++a) {
          const std::size_t s = static_cast<std::size_t>(i) * here.size() + a;
          CHECK(std::abs(here[a].phi - y[s]) < 1e-14);
          CHECK(std::abs(here[a].phi_t - v[s]) < 1e-14);
          if (c.lattice.is_circle()) CHECK(std::abs(around[a].phi - here[a].phi - 2 * pi * state->winding()) < 1e-11);
        }
      }
    }
  }
  for (const StateEntry* entry : state_entries())
    if (entry->build) CHECK(seen.contains(entry->name));
}

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

TEST_CASE("states of several components and of a point refuse what they cannot be", "[states]") {
  const Lattice point = Lattice::point(), circle = Lattice::circle(64, 40), interval = Lattice::interval(64, 40);
  for (const Lattice& lattice : {circle, interval}) {
    CHECK(key_of(request("kepler-orbit", "kepler"), lattice) == "initial.state");
    CHECK(key_of(request("pendulum-swing", "pendulum"), lattice) == "initial.state");
  }
  for (const char* name : {"charged-wave", "charged-packet"})
    for (const Lattice& lattice : {interval, point})
      CHECK(key_of(request(name, "complex-klein-gordon"), lattice) == "initial.state");
  CHECK(key_of(request("great-circle", "wave-map"), interval) == "initial.state");
  for (const StateEntry* entry : state_entries()) {
    const StateEntry& info = *entry;
    if (!info.build || info.name == "formula") continue;  // of any theory and space
    const auto words = theories_in_words(info), theory = words.substr(0, words.find_first_of(",;"));
    const bool at_a_point = info.place == Place::point, any = info.any_theory;
    CAPTURE(info.name);
    CHECK(key_of(request(info.name, any ? "pendulum" : theory), point) == (at_a_point ? "none" : "initial.state"));
    for (const char* several : {"kepler", "coupled-sine-gordon", "complex-klein-gordon", "wave-map"}) {
      const bool refused = any ? std::ranges::find(info.but, several) != info.but.end() : several != theory;
      if (refused) CHECK(key_of(request(info.name, several), at_a_point ? point : circle) == "initial.state");
    }
  }
  const auto key = [&](const char* name, const char* theory, const std::function<void(StateRequest&)>& change) {
    const bool at_a_point = theory == std::string("kepler") || theory == std::string("pendulum");
    return key_of(with(request(name, theory), change), at_a_point ? point : circle);
  };
  const double nan = std::nan("");
  for (const double e : {-0.1, 1.0, 2.0, nan})
    CHECK(key("kepler-orbit", "kepler", [&](StateRequest& r) { r.values["initial.eccentricity"] = e; }) ==
          "initial.eccentricity");
  for (const double A : {3.2, -3.2, nan})
    CHECK(key("pendulum-swing", "pendulum", [&](StateRequest& r) { r.values["initial.amplitude"] = A; }) ==
          "initial.amplitude");
  CHECK(key("pendulum-swing", "pendulum", [](StateRequest& r) { r.values["theory.mass"] = 0; }) == "theory.mass");
  for (const char* name : {"coupled-kinks", "coupled-breathers"}) {
    CHECK(key(name, "coupled-sine-gordon", [](StateRequest& r) { r.values["initial.speed"] = 1.0; }) ==
          "initial.speed");
    CHECK(key(name, "coupled-sine-gordon", [&](StateRequest& r) { r.values["initial.separation"] = nan; }) ==
          "initial.separation");
    CHECK(key(name, "coupled-sine-gordon", [](StateRequest& r) { r.winding = 5; }) == "boundary.winding");
  }
  CHECK(key("coupled-breathers", "coupled-sine-gordon", [](StateRequest& r) { r.values["initial.frequency"] = 2; }) ==
        "initial.frequency");
  CHECK(key("charged-wave", "complex-klein-gordon", [](StateRequest& r) { r.values["theory.lambda"] = -5; }) ==
        "theory.lambda");
  CHECK(key("charged-wave", "complex-klein-gordon", [](StateRequest& r) { r.values["initial.wavenumber"] = 40; }) ==
        "initial.wavenumber");
  for (const double w : {0.0, 0.1, 41.0})
    CHECK(key("charged-packet", "complex-klein-gordon", [&](StateRequest& r) { r.values["initial.width"] = w; }) ==
          "initial.width");
  CHECK(key("great-circle", "wave-map", [](StateRequest& r) { r.values["initial.wavenumber"] = 17; }) ==
        "initial.wavenumber");
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
    CHECK(std::abs(y[static_cast<std::size_t>(i)] -
                   4 * std::atan(0.9 * std::sinh(gamma * x) / std::cosh(gamma * 0.9 * -5))) < 1e-13);
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
    const auto i = static_cast<std::size_t>(std::lround(10 * x));
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

TEST_CASE("a report is told what does not quite fit", "[states]") {
  const auto says = [](const StateRequest& r, const Lattice& lattice, const std::string& what) {
    return make_state(r, lattice)->description().find(what) != std::string::npos;
  };
  CHECK(says(request("kink"), Lattice::circle(100, 30), "at the seam"));
  CHECK_FALSE(says(request("kink"), Lattice::circle(100, 50), "at the seam"));
  CHECK(says(request("kink", "sine-gordon-impurity"), Lattice::circle(100, 40), "not an exact solution"));
}

TEST_CASE("bad input names its key", "[states]") {
  const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
  const Lattice circle = Lattice::circle(255, 40), interval = Lattice::interval(255, 40);
  const auto change = [](const char* name, const std::function<void(StateRequest&)>& f) {
    return with(request(name), f);
  };

  CHECK(key_of(request("kikn")) == "initial.state");
  CHECK(key_of(request("kink", "wave")) == "initial.state");
  CHECK(key_of(request("breather", "phi4")) == "initial.state");
  CHECK(key_of(request("plane-wave", "phi4")) == "initial.state");
  CHECK(key_of(request("kink", "phi4"), circle) == "initial.state");
  for (const char* name : {"mps-collision", "kink-train", "wave-packet"})
    CHECK(key_of(request(name), interval) == "initial.state");

  for (const char* name : {"kink", "antikink", "kink-antikink", "kink-kink", "breather", "kink-train"})
    for (const double v : {1.0, -1.0, 1.2, nan, inf})
      CHECK(key_of(change(name, [&](StateRequest& r) { r.values["initial.speed"] = v; })) == "initial.speed");
  for (const char* name : {"kink-antikink", "kink-kink"})
    for (const double v : {0.0, -0.5})
      CHECK(key_of(change(name, [&](StateRequest& r) { r.values["initial.speed"] = v; })) == "initial.speed");
  for (const double omega : {0.0, -0.1, 1.0, 2.0, nan})
    CHECK(key_of(change("breather", [&](StateRequest& r) { r.values["initial.frequency"] = omega; })) ==
          "initial.frequency");
  for (const double d : {-1.0, 40.0, nan})
    CHECK(key_of(change("kink-kink", [&](StateRequest& r) { r.values["initial.separation"] = d; })) ==
          "initial.separation");
  for (const double epsilon : {0.0, 1.0, -1e-6, nan, 0.9})
    CHECK(key_of(change("mps-collision", [&](StateRequest& r) { r.values["initial.epsilon"] = epsilon; })) ==
          "initial.epsilon");
  CHECK(key_of(request("kink-train")) == "initial.epsilon");  // 1e-6 is too wide for one kink around 40
  for (const double n : {1.5, 128.0, nan, 1e300})
    CHECK(key_of(change("plane-wave", [&](StateRequest& r) { r.values["initial.wavenumber"] = n; })) ==
          "initial.wavenumber");
  CHECK(key_of(change("plane-wave", [](StateRequest& r) { r.values["initial.wavenumber"] = 0; }), interval) ==
        "initial.wavenumber");
  for (const double n : {0.0, -3.0, 2.5})
    CHECK(key_of(change("noise", [&](StateRequest& r) { r.values["initial.wavenumber"] = n; })) ==
          "initial.wavenumber");
  for (const double w : {0.0, -1.0, 1e-3, nan})
    CHECK(key_of(change("wave-packet", [&](StateRequest& r) { r.values["initial.width"] = w; })) == "initial.width");
  CHECK(key_of(change("noise", [&](StateRequest& r) { r.values["initial.amplitude"] = inf; })) == "initial.amplitude");
  CHECK(key_of(change("kink", [&](StateRequest& r) { r.values["initial.position"] = nan; })) == "initial.position");
  CHECK(key_of(change("kink", [](StateRequest& r) { r.values["theory.mass"] = 0; })) == "theory.mass");
  CHECK(key_of(with(request("kink", "phi4"), [](StateRequest& r) { r.values["theory.lambda"] = -1; }), interval) ==
        "theory.lambda");
  CHECK(key_of(with(request("kink", "double-sine-gordon"),
                    [](StateRequest& r) { r.values["theory.lambda"] = -0.5; })) == "theory.lambda");
  CHECK(key_of(with(request("plane-wave", "double-sine-gordon"),
                    [](StateRequest& r) { r.values["theory.lambda"] = -1; })) == "theory.lambda");
  for (const char* name : {"mps-collision", "kink", "antikink", "kink-antikink", "kink-kink", "breather", "noise"})
    CHECK(key_of(change(name, [](StateRequest& r) { r.winding = 5; })) == "boundary.winding");
  CHECK(key_of(change("kink-train", [](StateRequest& r) { r.winding = 0; })) == "boundary.winding");
  CHECK(key_of(change("kink-train", [](StateRequest& r) { r.winding = 128; })) == "boundary.winding");

  CHECK_THROWS_AS(make_state(request("file"), circle), std::logic_error);
}

TEST_CASE("errors read as one line with a remedy", "[states]") {
  const auto message = [](const StateRequest& r) -> std::string {
    try {
      make_state(r, Lattice::circle(255, 40));
    } catch (const BadInput& error) {
      return error.what();
    }
    return "";
  };
  CHECK(message(with(request("kink"), [](StateRequest& r) { r.values["initial.speed"] = 1.2; })) ==
        "initial.speed = 1.2: a kink must be slower than light; choose |speed| < 1");
  CHECK(message(request("kinc")) == "initial.state = kinc: no such state; did you mean kink?");
  CHECK(message(with(request("kink"), [](StateRequest& r) { r.winding = 0; })) ==
        "boundary.winding = 0: the state kink winds 1 times; set boundary.winding=1");
}

TEST_CASE("the list of states has every state that can be made", "[states]") {
  const Lattice circle = Lattice::circle(64, 10), interval = Lattice::interval(64, 25);
  const Lattice wide = Lattice::circle(640, 200);  // kinks a distance apart
  int made = 0;
  for (const StateEntry* entry : state_entries()) {
    const StateEntry& info = *entry;
    const auto words = theories_in_words(info);
    CHECK_FALSE(info.formula.empty());
    CHECK_FALSE(words.empty());
    if (!info.build) continue;
    const auto theory = info.any_theory ? "wave" : words.substr(0, words.find_first_of(",;"));
    const Lattice &lattice = info.name == "kink-gas" ? wide : info.place == Place::point      ? Lattice::point()
                             : info.place == Place::interval ? interval
                                                             : circle;
    CHECK_FALSE(make_state(request(info.name, theory), lattice)->description().empty());
    ++made;
  }
  CHECK(made == 24);
}

TEST_CASE("the nearest name is the one a typing error away", "[states]") {
  const std::vector<std::string> known{"kink", "antikink", "breather", "noise"};
  CHECK(nearest("kikn", known) == "kink");
  CHECK(nearest("antikinc", known) == "antikink");
  CHECK(nearest("Breather", known) == "breather");
  CHECK_FALSE(nearest("qwertyuiop", known));
  CHECK_FALSE(nearest("xyz", {}));
}

namespace {

/// φ = A + Bt, a state of a program's own.
class Rising final : public State {
 public:
  Rising(double A, double B) : A_(A), B_(B) {}
  void at(double t, double, std::span<FieldPoint> out) const override { out[0] = {A_ + B_ * t, B_, 0}; }
  bool exact() const override { return true; }
  std::string description() const override { return "rising"; }

 private:
  double A_, B_;
};

const StateEntry rising_state{"rising",
                              "A + rate t",
                              {{"initial.amplitude", 3.0, "A"}, {"initial.rate", 0.0, "", "", {0, 10}, {}, "twice A"}},
                              {"wave"},
                              {"klein-gordon"},
                              Place::line,
                              [](const StateBuild& build) -> std::unique_ptr<State> {
                                const double A = build.number("initial.amplitude");
                                return std::make_unique<Rising>(A, build.number("initial.rate", 2 * A));
                              }};

}  // namespace

TEST_CASE("a program registers a state of its own, with parameters of its own", "[states]") {
  const Lattice circle = Lattice::circle(5, 1);
  CHECK(key_of(request("rising", "wave"), circle) == "initial.state");
  register_state(rising_state);
  auto r = request("rising", "wave");
  CHECK(values(*make_state(r, circle), 2, circle) == std::vector<double>(5, 15.0));
  r.values["initial.rate"] = 1;
  CHECK(values(*make_state(r, circle), 2, circle) == std::vector<double>(5, 5.0));
  r.values["initial.rate"] = 11.0;
  CHECK(key_of(r, circle) == "initial.rate");
  CHECK(key_of(request("rising", "phi4"), circle) == "initial.state");
  CHECK(key_of(request("rising", "wave"), Lattice::point()) == "initial.state");
}

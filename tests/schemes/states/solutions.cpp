// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/schemes/states/central_differences.hpp"
#include "tests/schemes/states/state_requests.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double pi = std::numbers::pi;

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

// max |φ_tt − φ_xx − N′(φ)| over the lattice at time t, by differences of values() with one step in t and x.
double defect(const State& state, const StateRequest& r, const Lattice& lattice, double t) {
  const double k = lattice.space_step();
  std::vector<std::vector<double>> rows;
  for (int j = -4; j <= 4; ++j) rows.push_back(values(state, t + j * k, lattice));
  const auto& now = rows[4];
  const auto at = [&](int i) {
    const int around = i < 0 ? -1 : i >= lattice.sites() ? 1 : 0;
    return now[i - around * lattice.sites()] + 2 * pi * state.winding() * around;
  };
  double worst = 0;
  const int margin = lattice.is_circle() ? 0 : 4;
  for (int i = margin; i < lattice.sites() - margin; ++i) {
    const std::size_t s = i;
    double tt = second[0] * now[s], xx = second[0] * now[s];
    for (int m = 1; m <= 4; ++m) {
      const std::size_t d = m;
      tt += second[d] * (rows[4 + d][s] + rows[4 - d][s]);
      xx += second[d] * (at(i + m) + at(i - m));
    }
    worst = larger(worst, (tt - xx) / (k * k) + force(r, now[s]));
  }
  return worst;
}

struct Case {
  std::string title;
  StateRequest request;
  Lattice lattice;
};

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
    return rows[4][(i - around * N) * d + a] + 2 * pi * state.winding() * around;
  };
  double worst = 0;
  const int margin = lattice.space() == Space::interval ? 4 : 0;
  for (int i = margin; i < N - margin; ++i) {
    Row u, u_t, u_x, box;
    for (int a = 0; a < d; ++a) {
      const std::size_t s = i * d + a;
      double t1 = 0, x1 = 0, t2 = second[0] * rows[4][s], x2 = t2;
      for (int m = 1; m <= 4; ++m) {
        const std::size_t e = m;
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
  std::vector<FieldPoint> here(state.components()), later(here), earlier(here);
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

      std::vector<FieldPoint> here(state->components()), around(here);
      const auto y = values(*state, t, c.lattice), v = velocities(*state, t, c.lattice);
      for (int i = 0; i < c.lattice.sites(); i += 7) {
        state->at(t, c.lattice.position(i), here);
        state->at(t, c.lattice.position(i) + c.lattice.length(), around);
        for (std::size_t a = 0; a < here.size(); ++a) {
          const std::size_t s = delf::at(i) * here.size() + a;
          CHECK(std::abs(here[a].phi - y[s]) < 1e-14);
          CHECK(std::abs(here[a].phi_t - v[s]) < 1e-14);
          if (c.lattice.is_circle()) CHECK(std::abs(around[a].phi - here[a].phi - 2 * pi * state->winding()) < 1e-11);
        }
      }
    }
  }
  for (const StateEntry* entry : state_entries())
    // another test may have registered one of its own
    if (entry->build && entry->name != std::string("rising")) CHECK(seen.contains(entry->name));
}

// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

// A (q, p) program on Kepler's problem.
using Point = std::array<double, 4>;  // q1, q2, p1, p2
using Map = std::function<Point(const Point&)>;
constexpr double h = 0.1;

Point slope(const Point& z) {
  const double r3 = std::pow(std::hypot(z[0], z[1]), 3);
  return {z[2], z[3], -z[0] / r3, -z[1] / r3};
}
Point plus(Point z, double by, const Point& s) {
  for (int n = 0; n < 4; ++n) z[n] += by * s[n];
  return z;
}
Point drift(Point z, double by) {
  z[0] += by * z[2], z[1] += by * z[3];
  return z;
}
Point kick(Point z, double by) {
  const Point s = slope(z);
  z[2] += by * s[2], z[3] += by * s[3];
  return z;
}
Point position_verlet(const Point& z) { return drift(kick(drift(z, h / 2), h), h / 2); }
Point gauss2(const Point& z) {
  const double r = std::sqrt(3.0) / 6;
  Point a = slope(z), b = a;
  for (int n = 0; n < 60; ++n) {
    const Point next = slope(plus(plus(z, h / 4, a), h * (0.25 - r), b));
    b = slope(plus(plus(z, h * (0.25 + r), a), h / 4, b)), a = next;
  }
  return plus(plus(z, h / 2, a), h / 2, b);
}
Point runge_kutta(const Point& z) {
  const Point a = slope(z), b = slope(plus(z, h / 2, a)), c = slope(plus(z, h / 2, b)), d = slope(plus(z, h, c));
  return plus(plus(plus(plus(z, h / 6, a), h / 3, b), h / 3, c), h / 6, d);
}

std::string table(const Map& map, Point z, const char* format) {
  std::string text = "t,q1,q2,p1,p2\n";
  for (int j = 0; j < 60; ++j, z = map(z)) {
    text += fmt::format("{}", j * h);
    for (const double x : z) text += ',', text += fmt::format(fmt::runtime(format), x);
    text += "\n";
  }
  return text;
}

const Json* check(const Json& json, const std::string& name) {
  for (const Json& one : json["checks"])
    if (one["name"] == name) return &one;
  return nullptr;
}

}  // namespace

TEST_CASE("rows of a (q, p) program: its map is named, and what it keeps is checked by itself") {
  const Folder folder;
  folder.write("small.ini",
               "[theory]\nname = kepler\n[lattice]\nspace = point\nstencil = vertex\ntime_step = 0.1\n[initial]\n"
               "state = kepler-orbit\n[run]\nsteps = 9\n[output]\nfigures = off\n");
  const Point first{0.7, 0, 0, 1.2}, V{1e-5, 3e-6, 5e-6, 0}, W{0, 1e-5, -1e-5, 5e-6};
  struct Case {
    const char* name;
    Map map;
    std::string keys, says, never;
    bool form, momentum, passes;  // dq^dp and angular momentum are kept; every check passes
    const char* format = "{:.17g}";
  };
  const std::string gauss = "--scheme.method=cgvi --scheme.tableau=gauss2";
  for (const Case& c : std::vector<Case>{
           {"verlet", position_verlet, "", "drift-kick-drift Störmer-Verlet", "not symplectic", true, true, false},
           {"gauss", gauss2, "", "cgvi gauss2 from the frame before it (scheme.method = cgvi, scheme.tableau = gauss2)",
            "not symplectic", true, true, false},
           {"gauss as stated", gauss2, gauss, "", "", true, true, true},
           {"runge-kutta", runge_kutta, gauss, "Runge-Kutta method of order 4", "is a symplectic", false, false, false},
           {"nine decimals", position_verlet, "", "drift-kick-drift", "Runge", true, true, false, "{:.9f}"},
       }) {
    INFO(c.name);
    folder.write("rows.csv", table(c.map, first, c.format));
    std::string nearby;
    for (const auto& [name, by, size] : {std::tuple{"a", V, 1.0}, {"b", W, 1.0}, {"c", V, 0.5}, {"d", W, 0.5}}) {
      folder.write(fmt::format("{}.csv", name), table(c.map, plus(first, size, by), c.format));
      nearby += fmt::format(" --nearby {}.csv", name);
    }
    const Ran ran = delf_program(folder, "verify small.ini --out out --fields rows.csv" + nearby + " " + c.keys);
    INFO(ran.out << ran.err);
    CHECK(ran.code == (c.passes ? 0 : 1));
    const Json json = Json::parse(read(folder / "out/verify.json"));
    const std::string diagnosis = json["diagnosis"].dump();
    if (c.says.empty()) CHECK(json["diagnosis"].empty());
    else CHECK(contains(diagnosis, c.says));
    if (!c.never.empty()) CHECK_FALSE(contains(diagnosis, c.never));
    const Json* form = check(json, "symplectic form dq^dp of a step");
    REQUIRE((form || std::string(c.format) != "{:.17g}"));
    if (form) CHECK((*form)["passed"] == c.form);
    // Gauss 2 keeps H to h^4, and position Verlet to h^2
    for (const Json& measured : json["measured"])
      if (measured["name"] == "energy H(q, p) of the rows") {
        const bool fourth_order = c.map(first) == gauss2(first);
        CHECK(measured["value"] > (fourth_order ? 1e-8 : 1e-6));
        CHECK(measured["value"] < (fourth_order ? 1e-6 : 1e-2));
        CHECK(contains(measured["region"].get<std::string>(), "-0.70857143 first"));
      }
    CHECK(contains(json["measured"].dump(), "energy H(q, p) of the rows"));
    const Json* momentum = check(json, "Noether with momenta, angular_momentum");
    REQUIRE(momentum);
    CHECK((*momentum)["passed"] == c.momentum);
    const Json* map = check(json, "one-step map (q, p)");
    CHECK((map != nullptr) == !c.keys.empty());
    if (map) CHECK((*map)["passed"] == c.passes);
    if (c.keys.empty()) CHECK(contains((*check(json, "form formula by differences, slab"))["failure"], "Follows from"));
  }
}

TEST_CASE("fields with momenta are recognised as elements of the engine") {
  const Folder folder;
  folder.write("small.ini", small_scene("[scheme]\nmethod = cgvi\ntableau = gauss2\n"));
  const Ran run = delf_program(folder, "run small.ini --out run --run.steps=12 --output.every=1");
  INFO(run.err);
  REQUIRE(run.code == 0);
  const Ran ran = delf_program(folder,
                               "verify small.ini --fields run/fields.h5 --out out --output.figures=off "
                               "--scheme.method=multisymplectic --lattice.stencil=triangle-vertex");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 1);
  CHECK(contains(ran.out, "cgvi S=3 gauss R=2 lumped"));
}

TEST_CASE("a (q, p) program in NumPy is verified, and a wrong one is found out") {
  const Folder folder;
  const std::string with = python(folder), examples = scenes_folder() + "/../examples/";
  for (const std::string method : {"gauss", "verlet", "wrong"}) {
    INFO(method);
    REQUIRE(shell(folder, with + " '" + examples + "orbit.py' " + method + " x").code == 0);
    const Ran ran = delf_program(folder, "verify '" + examples +
                                             "orbit.ini' --fields x/orbit.npz --nearby x/a.npz --nearby x/b.npz "
                                             "--out out");
    INFO(ran.out << ran.err);
    CHECK(ran.code == (method == "gauss" ? 0 : 1));
    const Json json = Json::parse(read(folder / "out/verify.json"));
    CHECK((*check(json, "one-step map (q, p)"))["passed"] == (method == "gauss"));
    CHECK((*check(json, "symplectic form dq^dp of a step"))["passed"] == (method != "wrong"));
    CHECK((*check(json, "Noether with momenta, angular_momentum"))["passed"] == (method != "wrong"));
  }
}

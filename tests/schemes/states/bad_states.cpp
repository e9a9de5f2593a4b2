// SPDX-License-Identifier: MIT
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "lattice/nearest_name.hpp"
#include "tests/schemes/states/state_requests.hpp"

using namespace delf;
using namespace delf::testing;

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
    const Lattice& lattice = info.name == "kink-gas"         ? wide
                             : info.place == Place::point    ? Lattice::point()
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

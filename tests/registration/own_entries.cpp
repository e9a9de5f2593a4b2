// SPDX-License-Identifier: MIT
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "schemes/methods/energies.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/command_line.hpp"
#include "tools/scene/keys.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// ℓ = ½φ_t² − ½φ_x² − ½m²φ² − ¼gφ⁴
struct Quartic {
  double mass, strength;

  auto operator()(const auto& j) const {
    const auto square = j.phi * j.phi;
    return 0.5 * (j.phi_t * j.phi_t - j.phi_x * j.phi_x) - (0.5 * mass * mass) * square -
           (0.25 * strength) * (square * square);
  }
};

const TheoryEntry own_theory{
    "own-quartic",
    "φ_tt − φ_xx + m²φ + gφ³ = 0",
    {mass_parameter(), {.key = "theory.quartic", .fallback = 0.5, .help = "g", .range = {.low = 0}}},
    [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<Quartic>>(
          Quartic{p.get<double>("theory.mass"), p.get<double>("theory.quartic")});
    }};

/// φ = A/cosh(x − L/2), at rest
class Bump final : public State {
 public:
  Bump(double height, double centre) : height_(height), centre_(centre) {}
  void at(double, double x, std::span<FieldPoint> out) const override {
    const double s = x - centre_, phi = height_ / std::cosh(s);
    out[0] = {phi, 0, -std::tanh(s) * phi};
  }
  bool exact() const override { return false; }
  std::string description() const override { return "own-bump"; }

 private:
  double height_, centre_;
};

const StateEntry own_state{.name = "own-bump",
                           .formula = "A/cosh(x - L/2)",
                           .parameters = {{.key = "initial.height", .fallback = 0.25, .help = "A"}},
                           .exact = {},
                           .approximate = {},
                           .place = Place::line,
                           .build = [](const StateBuild& b) -> std::unique_ptr<State> {
                             return std::make_unique<Bump>(b.number("initial.height"), b.lattice.length() / 2);
                           },
                           .any_theory = true};

double largest(const RowsInTime& rows) {
  double most = 0;
  for (int i = 0; i < rows.system.lattice().sites(); ++i) most = std::max(most, std::abs(rows.rows(rows.newest, i, 0)));
  return most;
}

const EnergyEntry own_energy{.name = "energy of own-cells",
                             .formula = "7",
                             .source = {},
                             .rows = {},
                             .make = [](const FieldTheory&, const LatticeSystem&, const Problem&) -> EnergyOfRows {
                               return [](const RowsInTime&) { return EnergyMomentum{.energy = 7}; };
                             }};

/// The action on the cells of a key; its energy is said to be 7.
const MethodEntry own_method{
    .name = "own-cells",
    .formula = "the action on cells of scheme.cells",
    .build = [](const FieldTheory& theory, const Problem& p) -> SchemeParts {
      return {{theory.variational(p.parameters.get<std::string>("scheme.cells"))},
              fields(theory.components()),
              theory.symmetries()};
    },
    .parameters =
        {{.key = "scheme.cells", .fallback = "rectangle", .help = "the cells", .choices = {"rectangle", "triangle"}}},
    .label = [](const Problem& p) { return "cells of a " + p.parameters.get<std::string>("scheme.cells"); },
    .starts = {StartRule::centred},
    .start = StartRule::centred,
    .energy = &own_energy,
    .monitors = {{"largest", largest}}};

[[maybe_unused]] const bool registered =
    (register_theory(own_theory), register_state(own_state), register_method(own_method), true);

/// Runs the program that this test is, with the entries above.
Ran own_program(const Folder& folder, const std::vector<std::string>& words) {
  const auto redirected = [&](int stream, const std::string& name, const auto& next) {
    const int before = dup(stream), file = open((folder / name).c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    dup2(file, stream), close(file);
    next();
    std::fflush(nullptr);
    dup2(before, stream), close(before);
  };
  Ran ran{};
  redirected(STDOUT_FILENO, ".out",
             [&] { redirected(STDERR_FILENO, ".err", [&] { ran.code = static_cast<int>(run_program(words)); }); });
  ran.out = read(folder / ".out"), ran.err = read(folder / ".err");
  return ran;
}

std::string own_scene(const Folder& folder, const std::string& more = "") {
  return folder.write("own.ini",
                      "[theory]\nname = own-quartic\nquartic = 0.75\n[lattice]\nlength = 20\nsites = 32\n"
                      "courant = 0.5\n[scheme]\nmethod = own-cells\ncells = triangle\n[initial]\nstate = own-bump\n"
                      "height = 0.5\n[run]\nsteps = 40\n[output]\nfigures = off\n" +
                          more);
}

}  // namespace

TEST_CASE("a scene runs a theory, a method and a state of a program's own, with keys of their own") {
  const Folder folder;
  const std::string results = (folder / "out").string();
  const Ran ran = own_program(folder, {"run", own_scene(folder), "--out", results});
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.find("warning") == std::string::npos);
  CHECK(contains(ran.out, "own-quartic on a circle"));
  CHECK(contains(ran.out, "cells of a triangle, N = 32"));

  const std::string again = read(folder / "out" / "scene.ini");
  for (const char* line : {"quartic = 0.75", "cells = triangle", "height = 0.5", "start = centred"})
    CHECK(contains(again, line));
  const auto series = lines(read(folder / "out" / "series.csv"));
  CHECK(series.front().ends_with("residual,largest"));
  CHECK(contains(series[1], ",7,"));                                          // the energy
  const double most = std::stod(series[1].substr(series[1].rfind(',') + 1));  // of row 1, near A
  CHECK(most > 0.45);
  CHECK(most < 0.5);
}

TEST_CASE("their parameters reach them: other values, other rows") {
  const Folder folder;
  const auto last = [&](const std::vector<std::string>& keys) {
    std::vector<std::string> words{"run", own_scene(folder), "--out", (folder / "out").string()};
    words.insert(words.end(), keys.begin(), keys.end());
    CHECK(own_program(folder, words).code == 0);
    return lines(read(folder / "out" / "series.csv")).back();
  };
  const std::string as_given = last({});
  CHECK(last({"--theory.quartic=0.75"}) == as_given);
  CHECK(last({"--theory.quartic=0.5"}) != as_given);
  CHECK(last({"--scheme.cells=rectangle"}) != as_given);
  CHECK(last({"--initial.height=0.4"}) != as_given);
}

TEST_CASE("they are verified and planned by scene") {
  const Folder folder;
  const Ran verified = own_program(folder, {"verify", own_scene(folder), "--out", (folder / "out").string()});
  INFO(verified.out << verified.err);
  CHECK(verified.code == 0);
  CHECK(contains(read(folder / "out" / "verify.json"), "form formula"));
  const Ran planned = own_program(folder, {"plan", own_scene(folder)});
  INFO(planned.err);
  CHECK(planned.code == 0);
  CHECK(contains(planned.out, "cells of a triangle"));
}

TEST_CASE("what they declare is listed, explained, checked and warned of like that of the built-in ones") {
  const Folder folder;
  const Ran listed = own_program(folder, {"list"});
  for (const char* name : {"own-quartic", "theory.quartic", "own-cells", "own-bump"}) CHECK(contains(listed.out, name));
  const Ran help = own_program(folder, {"help", "run"});
  CHECK(contains(help.out, "theory.quartic         g (0.5; at least 0)"));
  CHECK(contains(
      help.out,
      "with scheme.method = own-cells:\n  scheme.cells           the cells (rectangle; one of rectangle, triangle)"));
  CHECK(contains(help.out, "with initial.state = own-bump:\n  initial.height         A (0.25)"));

  const auto refused = [&](const std::string& key, const std::string& why) {
    const Ran ran = own_program(folder, {"run", own_scene(folder), key});
    CAPTURE(key, ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "command line: " + key.substr(0, key.find('=')) + " = "));
    CHECK(contains(ran.err, why));
  };
  refused("--theory.quartic=-1", "must be at least 0; raise theory.quartic");
  refused("--scheme.cells=rectangel", "did you mean rectangle?");
  refused("--initial.height=high", "is not a number");
  refused("--initial.start=exact", "needs scheme.method = ");

  const Ran unread = own_program(folder, {"run", own_scene(folder), "--theory.name=klein-gordon",
                                          "--scheme.method=multisymplectic", "--out", (folder / "out").string()});
  INFO(unread.err);
  CHECK(unread.code == 0);
  CHECK(contains(unread.err, "theory.quartic = 0.75: warning: the theory klein-gordon does not read it"));
  CHECK(contains(unread.err, "scheme.cells = triangle: warning: only scheme.method = own-cells reads it"));
}

TEST_CASE("parameters that are not given have their fallbacks, and those of another type or out of range are refused") {
  Problem p;
  p.theory = "own-quartic", p.method = "own-cells", p.lattice = Lattice::circle(16, 8), p.time_step = 0.1;
  CHECK(completed(p).parameters.get<double>("theory.quartic") == 0.5);
  CHECK(scheme_label(p) == "cells of a rectangle");
  const auto key_of = [&](const char* key, const ParameterValue& value) {
    Problem other = p;
    other.parameters[key] = value;
    try {
      Simulation{other};
    } catch (const BadInput& bad) {
      return bad.key();
    }
    return std::string("accepted");
  };
  CHECK(key_of("theory.quartic", 1) == "accepted");
  CHECK(key_of("theory.quartic", -1.0) == "theory.quartic");
  CHECK(key_of("theory.quartic", "much") == "theory.quartic");
  CHECK(key_of("scheme.cells", "hexagon") == "scheme.cells");
  CHECK(key_of("mesh.alpha", -1.0) == "accepted");  // not a key of theirs
}

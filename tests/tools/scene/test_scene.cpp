// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/scene.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

Scene scene_of(const Folder& folder, const std::string& text, const std::vector<Setting>& on_command_line = {}) {
  return read_scene(folder.write("test.ini", text), on_command_line);
}

}  // namespace

TEST_CASE("a scene gives its keys, and the table of keys what it leaves out") {
  const Folder folder;
  const Scene scene = scene_of(folder, small_scene("every = 7\nfields = false\ntimes = 0, 1.5,2\n"));
  CHECK(scene.name == "test");
  CHECK(scene.problem.theory == "sine-gordon");
  CHECK(scene.problem.stencil == "rectangle-symmetric");
  CHECK(scene.problem.method == "multisymplectic");
  CHECK(scene.problem.lattice.is_circle());
  CHECK(scene.problem.lattice.sites() == 64);
  CHECK(scene.problem.time_step == 0.5 * 20 / 64);
  CHECK(scene.problem.tolerance == 1e-14);
  CHECK(scene.problem.predictor_order == 8);
  CHECK_FALSE(scene.problem.circle_valued);
  CHECK(scene.initial.name == "breather");
  CHECK_FALSE(scene.initial.values.has("initial.position"));
  CHECK(scene.initial.seed == 1);
  CHECK_FALSE(scene.start);
  CHECK(scene.steps == 100);
  CHECK(scene.every == 7);
  CHECK_FALSE(scene.figures);
  CHECK_FALSE(scene.fields);
  CHECK(scene.times == std::vector<double>{0, 1.5, 2});
  CHECK(scene.problem.threads == 1);
  CHECK(scene.warnings.empty());
}

TEST_CASE("the command line wins over the file, and over the other way to say the same") {
  const Folder folder;
  const Scene scene =
      scene_of(folder, small_scene(), {{"lattice.sites", "128"}, {"lattice.time_step", "0.03"}, {"run.until", "1"}});
  CHECK(scene.problem.lattice.sites() == 128);
  CHECK(scene.problem.time_step == 0.03);
  CHECK(scene.steps == 33);
}

TEST_CASE("steps are the nearest whole number to until/h, and h is not altered") {
  const Folder folder;
  const auto steps = [&](const char* until) {
    const Scene scene = scene_of(folder, small_scene(), {{"run.until", until}, {"lattice.time_step", "0.1"}});
    CHECK(scene.problem.time_step == 0.1);
    return scene.steps;
  };
  CHECK(steps("0") == 0);
  CHECK(steps("0.3") == 3);
  CHECK(steps("0.34") == 3);
  CHECK(steps("0.36") == 4);
  CHECK(steps("1e6") == 10000000);
}

TEST_CASE("about 400 rows are recorded if the scene does not say how many") {
  const Folder folder;
  const auto every = [&](const char* steps) { return scene_of(folder, small_scene(), {{"run.steps", steps}}).every; };
  CHECK(every("0") == 1);
  CHECK(every("400") == 1);
  CHECK(every("5100") == 13);
  CHECK(every("4000000") == 10000);
}

TEST_CASE("line ends of DOS, a byte-order mark, comments and white space mean nothing") {
  const Folder folder;
  std::string text = "\xef\xbb\xbf# comment\n\n" + small_scene("  every   =  3   # thrice\n");
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 2) text.insert(at, 1, '\r');
  CHECK(scene_of(folder, text).every == 3);
}

TEST_CASE("keys that have no effect are warned of, with their line, and stop nothing") {
  const Folder folder;
  const auto warning = [&](const std::string& more) {
    const auto warnings = scene_of(folder, small_scene(more)).warnings;
    return warnings.size() == 1 ? warnings.front() : "warnings: " + std::to_string(warnings.size());
  };
  const std::string file = (folder / "test.ini").string();
  CHECK(contains(warning("[theory]\nlambda = 2\n"), file + ":14: theory.lambda = 2: warning: the theory sine-gordon"));
  CHECK(contains(warning("[initial]\nseparation = 2\n"), "the state breather does not read it"));
  CHECK(contains(warning("[boundary]\nleft = natural\n"), "a circle has no walls"));
  CHECK(scene_of(folder, small_scene("[theory]\nmass = 2\n[initial]\nspeed = 0.1\n")).warnings.empty());
}

TEST_CASE("a key that another key's value leaves without effect is warned of, unless the scene meant it for others") {
  const Folder folder;
  const std::string scene = small_scene("[lattice]\nanalyticity = 2\n[scheme]\nmethod = processed\n");
  const auto warnings = scene_of(folder, scene).warnings;
  REQUIRE(warnings.size() == 1);
  CHECK(contains(warnings.front(), "lattice.analyticity = 2: warning: with lattice.pairs = maximal it has no effect"));
  CHECK(scene_of(folder, scene, {{"lattice.pairs", "suited"}}).warnings.empty());
  CHECK(scene_of(folder, scene, {{"lattice.pairs", "maximal"}}).warnings.empty());
  CHECK(scene_of(folder, scene, {{"lattice.pairs", "suited"}, {"lattice.gradient_order", "2"}}).warnings.size() == 1);
}

TEST_CASE("keys of verify are read, and mean nothing to a run") {
  const Folder folder;
  const Scene scene = scene_of(
      folder, small_scene("[verify]\nregions = slab, 0:4x2:9\nvariations = 3\ntolerance = 1e-13\nchecks = forms\n"));
  CHECK(scene.warnings.empty());
  CHECK_THROWS_AS(scene_of(folder, small_scene("[verify]\ntolerance = x\n")), BadScene);
}

TEST_CASE("the resolved scene reads back as the same scene, and resolves to the same text") {
  const Folder folder;
  const Scene scene =
      scene_of(folder, small_scene("[lattice]\nstencil = triangle\n[theory]\nmass = 1.25\nlambda = 3\n"),
               {{"run.until", "4.7"}, {"lattice.courant", "0.3"}, {"run.threads", "3"}});
  const std::string text = resolved_text(scene, StartRule::centred, "words");
  const Scene again = read_scene(folder.write("again.ini", text), {});
  CHECK(again.problem.time_step == scene.problem.time_step);
  CHECK(again.problem.parameters.get<double>("theory.mass") == 1.25);
  CHECK(again.problem.stencil == "triangle");
  CHECK(again.steps == scene.steps);
  CHECK(again.every == scene.every);
  CHECK(again.start == StartRule::centred);
  CHECK(again.problem.threads == 3);
  CHECK(again.warnings.empty());
  CHECK(resolved_text(again, StartRule::centred, "words") == text);
}

TEST_CASE("an alias of a stencil is the stencil that it is on this lattice, and scene.ini holds its name") {
  const Folder folder;
  for (const char* alias : {"leapfrog", "yee", "stormer-verlet", "stormer", "verlet"}) {
    CAPTURE(alias);
    const Scene scene = scene_of(folder, small_scene(), {{"lattice.stencil", alias}});
    CHECK(scene.problem.stencil == "triangle-vertex");
    CHECK(contains(resolved_text(scene, StartRule::exact, ""), "stencil = triangle-vertex\n"));
  }
  const auto on_point = [&](const char* name) {
    return scene_of(folder,
                    "[theory]\nname = pendulum\n[lattice]\nspace = point\ntime_step = 0.1\n[initial]\nstate = "
                    "pendulum-swing\n[run]\nsteps = 1\n",
                    {{"lattice.stencil", name}})
        .problem.stencil;
  };
  CHECK(on_point("leapfrog") == "trapezoidal");
  CHECK(on_point("stormer-verlet") == "trapezoidal");
  CHECK(on_point("midpoint") == "midpoint");    // a name stays what it is
  CHECK(on_point("yee") == "triangle-vertex");  // which no point has room for: refused, by its name, when it is built
}

TEST_CASE("a key of two methods has the choices of the one in the scene, and may be left to it") {
  const Folder folder;
  const std::string mechanics =
      "[theory]\nname = henon-heiles\n[lattice]\nspace = point\ntime_step = 0.1\n[initial]\nstate = point\n"
      "[run]\nsteps = 3\n[scheme]\nmethod = cgvi\n";
  const Scene radau = scene_of(folder, mechanics + "quadrature = radau\n");
  CHECK(radau.problem.parameters.get<std::string>("scheme.quadrature") == "radau");
  CHECK_FALSE(radau.problem.parameters.has("scheme.points"));
  CHECK_FALSE(radau.problem.parameters.has("scheme.continuity"));
  CHECK(scene_of(folder, mechanics + "points = 4\n").problem.parameters.get<int>("scheme.points") == 4);
  const auto refused = [&](const std::string& more) {
    try {
      scene_of(folder, small_scene("[scheme]\nmethod = spacetime\nquadrature = " + more + "\n"));
    } catch (const BadInput& bad) {
      return std::string(bad.what());
    }
    return std::string();
  };
  CHECK(refused("lobatto").empty());
  CHECK(contains(refused("radau"), "scheme.quadrature = radau: is not known"));
}

TEST_CASE("a body may start by its momenta, where mass depends on where it is") {
  const Folder folder;
  const Scene scene = scene_of(folder,
                               "[theory]\nname = double-pendulum\n[lattice]\nspace = point\ntime_step = 0.1\n"
                               "[initial]\nstate = point\nq = 0.7, -0.4\np = 0.3, 1.1\n[run]\nsteps = 3\n");
  const auto state = make_state(scene.initial, scene.problem.lattice);
  std::vector<double> v(2);
  state->velocities(0, scene.problem.lattice, v);
  // p = (2 v1 + v2 cos(q1 − q2), v2 + v1 cos(q1 − q2))
  const double c = std::cos(1.1);
  CHECK(std::abs(2 * v[0] + c * v[1] - 0.3) < 1e-15);
  CHECK(std::abs(v[1] + c * v[0] - 1.1) < 1e-15);
}

// SPDX-License-Identifier: MIT
#include <cmath>
#include <sstream>

#include "lattice/index.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/stepper.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/report/in_words.hpp"
#include "tools/run/stepping.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// What stands beside a name in the plan of a scene; empty if the name is not there.
std::string planned(const std::string& arguments, const std::string& name) {
  const Folder folder;
  const Ran ran = delf_program(folder, "plan " + arguments);
  INFO(ran.err);
  CHECK(ran.code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "results"));
  for (const std::string& line : lines(ran.out))
    if (line.starts_with(name + " ")) return line.substr(line.find_first_not_of(' ', name.size()));
  return {};
}

}  // namespace

TEST_CASE("the plan predicts what steps cost, by taking some") {
  for (const char* scene : {"collision", "collision --lattice.stencil=triangle-vertex", "kepler", "r-adaptive",
                            "spacetime-element", "interval --run.steps=2"}) {
    const std::string cost = planned(scene, "cost");
    CAPTURE(scene, cost);
    double ns = 0;
    std::string words;
    std::istringstream in(cost);
    CHECK(in >> ns);
    CHECK(std::isfinite(ns));
    CHECK(ns > 0);
    std::getline(in, words, '(');
    CHECK(words == " ns per site and step on this machine ");
    long steps = 0;
    CHECK(in >> steps);
    CHECK(steps > 0);
    CHECK(contains(cost, ", without output"));
  }
  CHECK(contains(planned("collision --run.steps=1000000", "cost"), "; 1000000 steps: "));
}

TEST_CASE("the plan predicts nothing where no step is taken, or the steps fail") {
  CHECK(planned("collision --run.steps=0", "cost") == "none: no step is taken");
  CHECK(planned("collision --run.steps=1", "cost") == "none: no step is taken");
  // Few sites and steps far too long: they fail within the first few, however slow the machine.
  const std::string failing = "collision --lattice.sites=16 --lattice.courant=1e5 --run.steps=100 --lattice.stencil=";
  for (const auto& [stencil, why] : {std::pair{"triangle-vertex", "no longer finite"}, {"triangle", "not solved"}}) {
    const std::string cost = planned(failing + stencil, "cost");
    INFO(cost);
    CHECK(cost.starts_with("not predicted: step "));
    CHECK(contains(cost, why));
  }
}

TEST_CASE("a step that leaves a wave undetermined is refused by plan and run") {
  const Folder folder;
  const std::string scene =
      " nls --scheme.method=multisymplectic --lattice.stencil=triangle --run.steps=2 --lattice.sites=";
  for (const char* command : {"plan", "run"}) {
    const Ran ran = delf_program(folder, command + scene + "20");
    CAPTURE(command, ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "lattice.sites = 20: no equation of a step changes with b at sites 0, 1"));
    CHECK_FALSE(std::filesystem::exists(folder / "results"));
  }
  CHECK(delf_program(folder, "plan" + scene + "21").code == 0);
}

TEST_CASE("threads that steps cannot use are reported by the plan and by a run") {
  CHECK(planned("collision", "threads").empty());
  CHECK(planned("collision --run.threads=2", "threads").starts_with("1 of 2: each takes "));
  CHECK(planned("collision --lattice.sites=200001 --run.threads=2", "threads") == "2");
  CHECK(planned("interval --run.threads=2", "threads").starts_with("1 of 2: only rows on a circle"));
  const std::string loop = " --lattice.stencil=triangle-vertex --run.steps=3 --output.figures=off --run.threads=2";
  CHECK(planned("collision" + loop, "threads").starts_with("1 of 2: each takes "));
  CHECK(planned("collision --lattice.sites=100000" + loop, "threads") == "2");

  const Folder folder;
  const Ran ran = delf_program(folder, "run collision" + loop);
  CHECK(complaints(ran) == "");
  CHECK(contains(ran.out, "  threads    1 of 2: each takes "));
}

TEST_CASE("the steps that are said to be shared are those along rows on a circle") {
  struct Case {
    const char *theory, *stencil, *method;
    bool on_circle = true;
  };
  for (const auto& [theory, stencil, method, on_circle] :
       {Case{"sine-gordon", "triangle-vertex", "multisymplectic"}, Case{"phi4", "triangle-vertex", "multisymplectic"},
        Case{"klein-gordon", "triangle-vertex", "multisymplectic"}, Case{"wave", "triangle-vertex", "multisymplectic"},
        Case{"coupled-sine-gordon", "triangle-vertex", "multisymplectic"},
        Case{"complex-klein-gordon", "triangle-vertex", "multisymplectic"},
        Case{"sine-gordon-impurity", "triangle-vertex", "multisymplectic"},
        Case{"sine-gordon", "triangle-vertex", "multisymplectic", false},
        Case{"sine-gordon", "triangle", "multisymplectic"}, Case{"sine-gordon", "rectangle", "multisymplectic"},
        Case{"sine-gordon", "rectangle", "damped"}, Case{"sine-gordon", "rectangle", "guo"}}) {
    CAPTURE(theory, stencil, method, on_circle);
    Problem problem;
    problem.theory = theory;
    problem.stencil = stencil;
    problem.method = method;
    problem.lattice = on_circle ? Lattice::circle(20, 20) : Lattice::interval(20, 20);
    problem.time_step = 0.1;
    Simulation simulation(problem);
    const std::vector<double> vacuum(20 * simulation.components().size());
    simulation.start(std::vector(at(simulation.starting_rows()), vacuum));
    simulation.step(false);
    simulation.step(false);  // the first keeps the rows of the start
    CHECK(contains(threads_in_words(simulation, 2), "each takes") == on_circle);
  }
}

TEST_CASE("costs and durations are said with three digits or whole") {
  CHECK(cost_in_words(1.9444) == "1.94 ns per site and step");
  CHECK(cost_in_words(12345.6) == "12346 ns per site and step");
  CHECK(duration_in_words(0.0996) == "0.1 s");
  CHECK(duration_in_words(0.0123) == "12 ms");
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "schemes/stepping/evolution.hpp"
#include "schemes/simulation.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

using Looks = Simulation::Looks;
constexpr Looks all{true, true}, monitors{true, false}, residual{false, true}, nothing{false, false};

template <class Change>
Problem problem(int sites, const Change& change) {
  Problem p;
  p.stencil = "triangle-vertex";
  p.lattice = Lattice::circle(sites, 40);
  change(p);
  p.time_step = 0.5 * p.lattice.space_step();
  return p;
}
Problem of_stencil(int sites, const char* stencil) {
  return problem(sites, [&](Problem& p) { p.stencil = stencil; });
}

/// A travelling wave of all components; on the sphere a great circle.
Row wave(const Simulation& simulation, const Problem& p, double t) {
  Row row;
  const std::size_t C = simulation.components().size();
  for (int i = 0; i < p.lattice.sites(); ++i) {
    const double value = 0.3 * std::sin(2 * std::numbers::pi * i / p.lattice.sites() - t);
    const double on_sphere[] = {std::cos(value), std::sin(value), 0, 0};
    for (std::size_t c = 0; c < C; ++c) row.push_back(p.theory == "wave-map" ? on_sphere[c] : value);
  }
  return row;
}

void start(Simulation& simulation, const Problem& p) {
  if (p.method == "composition" || p.method == "spacetime") {
    const Row row = wave(simulation, p, 0);
    return simulation.start_legendre(row, Row(row.size(), 0.0));
  }
  std::vector<Row> rows;
  for (int j = 0; j < simulation.starting_rows(); ++j) rows.push_back(wave(simulation, p, j * p.time_step));
  simulation.start(rows);
}

struct Bytes {
  std::size_t planned, taken;
};
/// Planned for a run with some looks, and taken by one with others.
Bytes bytes(const Problem& p, Looks planned, Looks looks, int steps = 20) {
  Simulation simulation(p);
  const std::size_t foretold = simulation.bytes_of_run(planned);
  start(simulation, p);
  for (int n = 0; n < steps; ++n) {
    const bool looked_at = n % 2 != 0;
    simulation.step(looked_at);
    if (looked_at && looks.monitors) simulation.monitors();
    if (looked_at && looks.residual) CHECK(simulation.residual() < 1e-12);
  }
  return {foretold, simulation.bytes()};
}

struct Case {
  std::string name;
  Problem problem;
  bool residual_takes;  ///< room of its own
};
std::vector<Case> cases() {
  std::vector<Case> list{
      {"one loop", of_stencil(255, "triangle-vertex"), true},
      {"one loop, two fields", problem(255, [](Problem& p) { p.theory = "coupled-sine-gordon"; }), true},
      {"one loop, placed", problem(255, [](Problem& p) { p.theory = "sine-gordon-impurity"; }), true},
      {"one loop, two threads", problem(2500 * lanes, [](Problem& p) { p.threads = 2; }), true},
      {"no density", problem(255, [](Problem& p) { p.theory = "wave"; }), true},
      {"no density, an interval",
       problem(255, [](Problem& p) { p.theory = "wave", p.lattice = Lattice::interval(255, 40); }), true},
      {"an interval", problem(255, [](Problem& p) { p.lattice = Lattice::interval(255, 40); }), true},
      {"a stream", of_stencil(5000 * lanes + 1, "rectangle-symmetric"), true},
      {"slabs, a constant matrix", problem(40, [](Problem& p) { p.method = "spacetime"; }), true},
      {"slabs, Newton",
       problem(24,
               [](Problem& p) {
                 p.theory = "wave-map", p.stencil = "rectangle";
                 p.lattice = Lattice::circle(24, 2 * std::numbers::pi);
               }),
       true},
      {"vu-quoc-li", problem(255, [](Problem& p) { p.method = "vu-quoc-li"; }), true},
      {"guo", problem(255, [](Problem& p) { p.method = "guo"; }), true},
      {"guo, a long row", problem(5000 * lanes + 1, [](Problem& p) { p.method = "guo"; }), true},
      {"triangle", of_stencil(255, "triangle"), true},
      {"triangle, a long row", of_stencil(5000 * lanes + 1, "triangle"), true}};
  for (const char* stencil : {"rectangle", "rectangle-symmetric", "nine-tuple"})
    list.push_back({stencil, of_stencil(255, stencil), true});
  list.push_back({"hexagon", of_stencil(254, "hexagon"), true});
  for (const auto& [order, takes] : {std::pair(2, true), std::pair(6, false)})
    list.push_back(
        {"composition " + std::to_string(order),
         problem(255, [order = order](Problem& p) { p.method = "composition", p.parameters["scheme.order"] = order; }),
         takes});
  return list;
}

}  // namespace

TEST_CASE("what is planned of memory is what a run has taken at its end, however it is looked at") {
  for (const Case& c : cases())
    for (const Looks& looks : {all, monitors, residual, nothing}) {
      CAPTURE(c.name, looks.monitors, looks.residual);
      const Bytes run = bytes(c.problem, looks, looks);
      CHECK(run.planned == run.taken);
    }
}

TEST_CASE("the comparison can fail: monitors and the residual take room that is not there without them") {
  for (const Case& c : cases()) {
    CAPTURE(c.name);
    const Bytes unlooked = bytes(c.problem, all, nothing), unforeseen = bytes(c.problem, nothing, all);
    CHECK(unlooked.planned > unlooked.taken);
    CHECK(unforeseen.planned < unforeseen.taken);
    CHECK((bytes(c.problem, nothing, residual).taken > unlooked.taken) == c.residual_takes);
    CHECK(Simulation(c.problem).bytes() <= unlooked.taken);
  }
}

TEST_CASE("an explicit step takes its six rows and nothing more, four more with the residual, and one with monitors") {
  for (int N : {255, 256, 4095}) {
    const Problem p = of_stencil(N, "triangle-vertex");
    const Simulation simulation(p);
    const RowLayout& layout = *simulation.evolution().stepper().layout();
    const std::size_t row = RowBuffer::bytes_of(layout.doubles()), rows = 6 * row + layout.bytes();
    CAPTURE(N);
    CHECK(simulation.bytes() == rows);
    const std::size_t measured = RowBuffer::bytes_of(layout.doubles(), 4);  // w, the source term, E and its size
    CHECK(bytes(p, nothing, nothing, 3000).taken == rows);
    CHECK(bytes(p, residual, residual, 3000).taken == rows + measured);
    CHECK(bytes(p, all, all).taken == rows + measured + row);
    CHECK(bytes(of_stencil(N, "rectangle"), residual, residual).taken > rows + measured);
  }
}

TEST_CASE("the residual of one loop leaves all rows where they are, and the next steps are what they were") {
  const Problem p = of_stencil(255, "triangle-vertex");
  Simulation asked(p), other(p);
  for (Simulation* s : {&asked, &other}) {
    start(*s, p);
    for (int n = 0; n < 5; ++n) s->step();
  }
  const Stepper &looked_at = asked.evolution().stepper(), &left = other.evolution().stepper();
  CHECK(asked.residual() == other.residual());
  CHECK(asked.residual() < 1e-14);  // again
  for (int back : {0, 1, 2}) CHECK(looked_at.row(back) == left.row(back));
  Simulation unasked(p);
  start(unasked, p);
  for (int n = 0; n < 5; ++n) unasked.step();
  for (int n = 0; n < 7; ++n) {
    asked.step();
    unasked.step();
    CHECK(asked.evolution().stepper().row(0) == unasked.evolution().stepper().row(0));
    CHECK(asked.evolution().stepper().row(0) != unasked.evolution().stepper().row(1));
  }
  CHECK(asked.evolution().stepper().row(2) == unasked.evolution().stepper().row(2));
}

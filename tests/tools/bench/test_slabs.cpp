// SPDX-License-Identifier: MIT
#include <cmath>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tools/bench/by_hand/mechanics_by_hand.hpp"
#include "tools/bench/by_hand/spacetime_by_hand.hpp"
#include "tools/bench/slab_problems.hpp"

using namespace delf;
using namespace delf::bench;

namespace {

/// The largest difference of a component of the newest rows after so many steps.
template <class Packed>
double difference(Simulation& engine, Packed& packed, const TwoRows& rows, int steps, int component, int fields) {
  engine.start(rows), packed.start(rows);
  for (int n = 0; n < steps; ++n) engine.step(), packed.step();
  std::vector<double> row(rows[0].size() / at(fields + 1) * at(fields));
  engine.copy_row(0, row);
  double worst = 0;
  for (std::size_t i = 0; i * at(fields) < row.size(); ++i)
    worst = std::max(worst, std::abs(row[i * at(fields) + at(component)] - packed.newest(component)[i]));
  return worst;
}

}  // namespace

// Each also against a wrong step, which must show.
TEST_CASE("the packed slabs and the engine step the same equations") {
  const bool keeps = GENERATE(true, false);
  SECTION("a moving mesh") {
    const MovingMesh problem{22, 1e-13};
    Simulation engine(problem.problem());
    CHECK(difference(engine, *problem.by_hand(keeps), problem.rows(), 100, 1, 2) < 1e-8);
    PackedSlab<PackedMovingMesh> wrong({24, false}, 1e-11, keeps,
                                       PackedMovingMesh::Rectangle{1.001 * MovingMesh::time_step},
                                       PackedMovingMesh::Arclength{MovingMesh::alpha});
    CHECK(difference(engine, wrong, problem.rows(), 100, 1, 2) > 1e-5);
  }
  SECTION("a wave map") {
    const WaveMapOnCircle problem{32, 1e-13};
    Simulation engine(problem.problem());
    CHECK(difference(engine, *problem.by_hand(keeps), problem.rows(), 100, 2, 3) < 1e-10);
    PackedSlab<PackedWaveMap> wrong({32, true}, 1e-13, keeps, PackedWaveMap::Rectangle{problem.time_step(), 0.19},
                                    PackedWaveMap::Sphere{});
    CHECK(difference(engine, wrong, problem.rows(), 100, 2, 3) > 1e-5);
  }
}

TEST_CASE("loops of mechanics by hand and the engine step the same equations") {
  SECTION("the midpoint rule on a pendulum") {
    const Mechanics m{"pendulum", "midpoint", 0.05, 1e-14};
    const auto rows = m.rows("pendulum-swing");
    Simulation engine(m.problem());
    PendulumMidpointByHand loop{m.time_step, 1e-14}, wrong{1.01 * m.time_step, 1e-14};
    engine.start(rows), loop.start(rows[0][0], rows[1][0]), wrong.start(rows[0][0], rows[1][0]);
    for (int n = 0; n < 200; ++n) engine.step(), loop.step(), wrong.step();
    double q = 0;
    engine.copy_row(0, {&q, 1});
    CHECK(std::abs(loop.q - q) < 1e-10);
    CHECK(std::abs(wrong.q - q) > 1e-3);
  }
  SECTION("Störmer and Verlet's method on Kepler's problem") {
    const Mechanics m{"kepler", "trapezoidal", 0.01, 1e-14, {"q1", "q2"}};
    const auto rows = m.rows("kepler-orbit");
    Simulation engine(m.problem());
    KeplerVerletByHand loop{m.time_step}, wrong{1.01 * m.time_step};
    for (auto* each : {&loop, &wrong}) each->start({rows[0][0], rows[0][1]}, {rows[1][0], rows[1][1]});
    engine.start(rows);
    for (int n = 0; n < 200; ++n) engine.step(), loop.step(), wrong.step();
    double q[2];
    engine.copy_row(0, q);
    CHECK(std::abs(loop.q[1] - q[1]) < 1e-10);
    CHECK(std::abs(wrong.q[1] - q[1]) > 1e-3);
  }
  SECTION("Gauss's method of two stages on a pendulum") {
    const Mechanics m{"pendulum", "", 0.05, 1e-14};
    Simulation engine(m.gauss(2));
    const double q0[] = {2, 2}, v0[] = {0, 0};
    PendulumGaussByHand loop{m.time_step, 1e-14}, wrong{1.01 * m.time_step, 1e-14};
    engine.start_legendre(q0, v0), loop.start(2, 0), wrong.start(2, 0);
    loop.step(), wrong.step();  // a start has row 1
    for (int n = 0; n < 200; ++n) engine.step(), loop.step(), wrong.step();
    double q = 0;
    engine.copy_row(0, {&q, 1});
    CHECK(std::abs(loop.q - q) < 1e-10);
    CHECK(std::abs(wrong.q - q) > 1e-3);
  }
}

TEST_CASE("spacetime elements by hand and the engine step the same equations") {
  const SpacetimeBreather problem{40, 1e-14};
  Simulation engine(problem.problem());
  const std::vector<double> phi = problem.phi(), phi_t(phi.size(), 0.0);
  SpacetimeByHand loop(40, problem.space_step(), SpacetimeBreather::time_step, 1e-14),
      wrong(40, problem.space_step(), 1.01 * SpacetimeBreather::time_step, 1e-14);
  std::vector<double> row, at_rest(2 * phi.size(), 0.0);
  for (std::size_t i = 0; i < phi.size(); i += 2) row.insert(row.end(), {phi[i], phi[i + 1], phi[i], phi[i + 1]});
  engine.start_legendre(row, at_rest), loop.start(phi, phi_t), wrong.start(phi, phi_t);
  loop.step(), wrong.step();  // a start has row 1
  for (int n = 0; n < 50; ++n) engine.step(), loop.step(), wrong.step();
  std::vector<double> vertices(40);
  engine.copy_row(0, vertices);
  double worst = 0, of_wrong = 0;
  for (int i = 0; i < 40; ++i) {
    worst = std::max(worst, std::abs(vertices[i] - loop.newest(2 * i)));
    of_wrong = std::max(of_wrong, std::abs(vertices[i] - wrong.newest(2 * i)));
  }
  CHECK(worst < 1e-10);
  CHECK(of_wrong > 1e-3);
}

// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <string>

#include "schemes/simulation.hpp"
#include "schemes/state.hpp"
#include "tools/bench/by_hand/mechanics_by_hand.hpp"
#include "tools/bench/by_hand/packed_systems.hpp"
#include "tools/bench/by_hand/spacetime_by_hand.hpp"
#include "tools/bench/commands.hpp"
#include "tools/bench/sides.hpp"
#include "tools/bench/slab_problems.hpp"
#include "tools/bench/table.hpp"

namespace delf::bench {
namespace {

/// Starts again after so many steps, as long as a run stays in its domain.
Side again_after(long most, Side side) {
  auto left = std::make_shared<long>(most);
  return {[=] { side.restart(), *left = most; },
          [=](long steps) {
            for (long taken; steps > 0; steps -= taken) {
              if (*left == 0) side.restart(), *left = most;
              taken = std::min(steps, *left);
              side.advance(taken);
              *left -= taken;
            }
          }};
}

struct Compared {
  const Table& table;
  int repeats;

  void operator()(const std::string& name, const Side& engine, const Side& by_hand) const {
    const Pairing times = pair(engine, by_hand, repeats);
    table.row({name, number(times.b / 1000), number(times.a / 1000), in_words(times.ratio)});
  }
};

void moving_meshes(const Compared& compare, const std::vector<int>& nodes, double tolerance) {
  for (const int n : nodes) {
    const MovingMesh problem{n, tolerance};
    const auto rows = problem.rows();
    const Side engine = side_of(std::make_shared<Simulation>(problem.problem()), rows);
    for (const bool keeps : {true, false})
      compare(fmt::format("moving mesh, {} nodes; {}", n, keeps ? "kept" : "fresh"),
              again_after(MovingMesh::steps, engine),
              again_after(MovingMesh::steps, side_of(problem.by_hand(keeps), rows)));
  }
}

void wave_map(const Compared& compare, double tolerance) {
  const WaveMapOnCircle problem{128, tolerance};
  const auto rows = problem.rows();
  const Side engine = side_of(std::make_shared<Simulation>(problem.problem()), rows);
  for (const bool keeps : {true, false})
    compare(fmt::format("wave map, {} sites; {}", problem.sites, keeps ? "kept" : "fresh"),
            again_after(WaveMapOnCircle::steps, engine),
            again_after(WaveMapOnCircle::steps, side_of(problem.by_hand(keeps), rows)));
}

/// Any loop that starts by itself.
template <class Loop, class Start>
Side loop_side(Loop made, Start start) {
  auto loop = std::make_shared<Loop>(made);
  return {[=] { start(*loop); },
          [loop](long steps) {
            for (long n = 0; n < steps; ++n) loop->step();
          }};
}

void mechanics(const Compared& compare, double tolerance) {
  {
    const Mechanics m{"pendulum", "midpoint", 0.05, tolerance};
    const auto rows = m.rows("pendulum-swing");
    compare("pendulum, midpoint", side_of(std::make_shared<Simulation>(m.problem()), rows),
            loop_side(PendulumMidpointByHand{m.time_step, 2 * tolerance},
                      [=](auto& loop) { loop.start(rows[0][0], rows[1][0]); }));
  }
  {
    const Mechanics m{"kepler", "trapezoidal", 0.01, tolerance, {"q1", "q2"}};
    const auto rows = m.rows("kepler-orbit");
    compare("Kepler, Störmer–Verlet", side_of(std::make_shared<Simulation>(m.problem()), rows),
            loop_side(KeplerVerletByHand{m.time_step}, [=](auto& loop) {
              loop.start({rows[0][0], rows[0][1]}, {rows[1][0], rows[1][1]});
            }));
  }
  {
    const Mechanics m{"pendulum", "", 0.05, tolerance};
    const auto simulation = std::make_shared<Simulation>(m.gauss(2));
    Side engine = side_of(simulation, m.rows("pendulum-swing"));
    engine.restart = [simulation] {
      const double q[] = {2, 2}, v[] = {0, 0};  // the inner node's are not read
      simulation->start_legendre(q, v);
    };
    compare("pendulum, Gauss 2", engine,
            loop_side(PendulumGaussByHand{m.time_step, 2 * tolerance}, [](auto& loop) { loop.start(2, 0); }));
  }
}

void spacetime(const Compared& compare, double tolerance) {
  const SpacetimeBreather problem{80, tolerance};
  const std::vector<double> phi = problem.phi(), phi_t(phi.size(), 0.0);
  const auto simulation = std::make_shared<Simulation>(problem.problem());
  Side engine = side_of(simulation, TwoRows{});
  engine.restart = [=] {
    // A cell has four components, of which two are in the lowest row.
    std::vector<double> row, velocity(2 * phi.size(), 0.0);
    for (std::size_t i = 0; i < phi.size(); i += 2) row.insert(row.end(), {phi[i], phi[i + 1], phi[i], phi[i + 1]});
    simulation->start_legendre(row, velocity);
  };
  compare("spacetime (2,2), 80 cells", engine,
          loop_side(SpacetimeByHand{problem.cells, problem.space_step(), SpacetimeBreather::time_step, tolerance},
                    [=](auto& loop) { loop.start(phi, phi_t); }));
}

}  // namespace

void time_slabs(const Request& request) {
  const double tolerance = request.tolerances_or({1e-12}).front();
  fmt::print(
      "Slabs by the engine and by programs written for one system; µs per step, tolerance {}.\n"
      "kept, fresh: what the packed program does with its Jacobian\n\n",
      tolerance);
  const Table table({{"problem", 32}, {"by hand", 9}, {"engine", 9}, {"ratio", 24}});
  const Compared compare{table, request.repeats};
  moving_meshes(compare, request.sites_or({15, 22, 44, 63, 90}), tolerance);
  if (!request.sites.empty()) return;
  wave_map(compare, tolerance);
  spacetime(compare, tolerance);
  mechanics(compare, tolerance);
}

}  // namespace delf::bench

// SPDX-License-Identifier: MIT
#include "schemes/modified_energy.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <vector>

#include "jets/tables/density_on_table.hpp"
#include "jets/tables/named_tables.hpp"
#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_text.hpp"
#include "tests/catch.hpp"

using namespace delf;

namespace {

constexpr double length = 3 * std::numbers::pi;

struct Case {
  std::string theory, stencil, method = "multisymplectic";
  bool on_point() const { return theory == "pendulum" || theory == "kepler"; }
};

Problem problem_of(const Case& c, int sites) {
  Problem p;
  p.theory = c.theory, p.method = c.method;
  if (!c.stencil.empty()) p.stencil = c.stencil;
  p.lattice = c.on_point() ? Lattice::point() : Lattice::circle(sites, length);
  if (c.method == "spacetime") p.parameters["scheme.degree_time"] = 1, p.parameters["scheme.degree_space"] = 2;
  p.time_step = c.on_point() ? 2.4 / sites : 0.5 * length / sites;
  return completed(p);
}

/// How far energy and momentum of ℓ̃ move in a run: largest less smallest.
struct Spread {
  double energy, momentum;
};
Spread spread_of(const Case& c, int sites, int order) {
  const Problem p = problem_of(c, sites);
  Simulation simulation(p);
  const StencilTable& table = simulation.evolution().system().families()[0]->made_of()->table;
  const int d = simulation.count(Role::field), n = p.lattice.sites(),
            all = static_cast<int>(simulation.components().size());
  const double h = p.time_step;
  const auto field = [&](double i, double t) {
    const double x = 2 * std::numbers::pi * i / n;
    return std::sin(x) + 0.4 * std::cos(x + 0.3) + 0.3 + t * (0.7 * std::cos(x) + 0.2);
  };
  std::vector<std::vector<double>> rows(2, std::vector<double>(at(n * all)));
  std::vector<double> rates(at(n * all));
  for (int i = 0; i < n; ++i)
    for (int a = 0; a < all; ++a) {
      const bool second = d == 2 && a % 2 == 1;
      const double start = c.on_point() ? (second ? 0 : 1.1) : field(i, 0);
      const double rate = c.on_point() ? (second ? 0.9 : 0.3) : field(i, 1) - field(i, 0);
      rows[0][at(i * all + a)] = start, rows[1][at(i * all + a)] = start + h * rate, rates[at(i * all + a)] = rate;
      if (const double inside = table.nodes[at(a / d)].space; inside > 0) {
        // y_tt = (4/k²)(y₀ − 2y + y₁) + N′(y) in the middle of an element of degree 2: ψ = k⁴ φ_xxxx/384
        const double ratio = std::pow(2 * std::numbers::pi / n, 4) / 384, place = i + inside;
        const double mean = 0.3, drift = 0.2;  // of no derivative
        const double there = field(place, 0), by_t = field(place, 1) - there;
        rows[0][at(i * all + a)] = there + ratio * (there - mean);
        rates[at(i * all + a)] = by_t + ratio * (by_t - drift);
      }
      if (table.pattern.placement == Placement::brick_wall)  // ψ = −(h³/24) N″ φ_t of sine-Gordon
        for (const int j : {0, 1}) {
          const double phi = rows[at(j)][at(i)];
          rows[at(j)][at(i)] = phi + ((i + j) % 2 ? -1 : 1) * h * h * h / 24 * std::cos(phi) * rate;
        }
    }
  if (c.method == "multisymplectic") simulation.start(rows);
  else simulation.start_legendre(rows[0], rates);
  const ModifiedEnergy modified(ModifiedLagrangian(*text_of(p.theory, p.parameters), table, order), table, d, h,
                                p.lattice, 0);
  std::vector<double> earlier(at(n * d)), later(earlier), energies, momenta;
  simulation.copy_row(0, later);
  while (simulation.time(simulation.newest()) < 3) {
    earlier = later;
    simulation.step();
    simulation.copy_row(0, later);
    const auto [energy, momentum] = modified.of(earlier, later, 0);
    energies.push_back(energy), momenta.push_back(momentum);
  }
  const auto spread = [](const std::vector<double>& values) {
    const auto [least, most] = std::ranges::minmax(values);
    return most - least;
  };
  return {spread(energies), spread(momenta)};
}

/// The orders at which both spreads fall from n sites to 3n/2.
Spread order_of(const Case& c, int order, int n) {
  const Spread coarse = spread_of(c, n, order), fine = spread_of(c, 3 * n / 2, order);
  return {std::log(coarse.energy / fine.energy) / std::log(1.5),
          std::log(coarse.momentum / fine.momentum) / std::log(1.5)};
}

}  // namespace

TEST_CASE("energy and momentum of the modified Lagrangian move by the next order of h and k") {
  struct Expected {
    Case of;
    double two, four;      ///< orders of what ℓ̃ of order 2 and 4 leaves
    bool momentum = true;  ///< false: it is kept to rounding by the scheme itself
  };
  // the triangle alone has terms of odd orders, from 3 on
  for (const auto& [c, two, four, momentum] : std::vector<Expected>{{{"sine-gordon", "triangle"}, 3, 5},
                                                                    {{"sine-gordon", "triangle-vertex"}, 4, 6, false},
                                                                    {{"sine-gordon", "rectangle"}, 4, 6},
                                                                    {{"sine-gordon", "rectangle-symmetric"}, 4, 6},
                                                                    {{"sine-gordon", "six-tuple"}, 4, 6},
                                                                    {{"phi4", "rectangle-symmetric"}, 4, 6},
                                                                    {{"phi4", "six-tuple"}, 4, 6},
                                                                    {{"sine-gordon", "", "composition"}, 4, 6},
                                                                    {{"phi4", "", "composition"}, 4, 6}}) {
    INFO(c.theory << ", " << c.stencil << c.method);
    for (const int order : {2, 4}) {
      const double expected = order == 2 ? two : four;
      const Spread measured = order_of(c, order, 64);
      CHECK(measured.energy == Approx(expected).margin(0.35));
      if (momentum) CHECK(measured.momentum == Approx(expected).margin(0.4));
    }
  }
}

// Rows 0 and 1 have ψ of order 3 alone: what is left of it swings by itself, and in the energy it is of order 5 to 6.
TEST_CASE("energy and momentum of the modified Lagrangian on bricks move by the next order of h and k") {
  const Case c{"sine-gordon", "hexagon"};
  const Spread two = order_of(c, 2, 64), four = order_of(c, 4, 64);
  CHECK(two.energy == Approx(4).margin(0.35));
  CHECK(two.momentum == Approx(4).margin(0.35));
  CHECK(four.energy == Approx(5.6).margin(0.6));
  CHECK(four.momentum == Approx(5.8).margin(0.5));
}

// Nodes inside cells swing by themselves too, by what ψ of order 4 leaves: φ_t of the vertices has k⁵ of it.
TEST_CASE("energy and momentum of the modified Lagrangian of an element move by the next order of h and k") {
  const Case c{"sine-gordon", "", "spacetime"};
  const Spread two = order_of(c, 2, 64), four = order_of(c, 4, 64);
  CHECK(two.energy == Approx(4).margin(0.35));
  CHECK(two.momentum == Approx(4).margin(0.35));
  CHECK(four.energy == Approx(5.1).margin(0.4));
  CHECK(four.momentum == Approx(5.1).margin(0.4));
}

TEST_CASE("the energy of the modified Lagrangian in mechanics moves by the next order of h") {
  for (const Case& c : {Case{"kepler", "trapezoidal"},
                        {"kepler", "midpoint"},
                        {"kepler", "vertex"},
                        {"pendulum", "midpoint"},
                        {"pendulum", "trapezoidal"},
                        {"kepler", "", "composition"}}) {
    INFO(c.theory << ", " << c.stencil << c.method);
    CHECK(order_of(c, 0, 64).energy == Approx(2).margin(0.2));  // ℓ itself: a twin that fails
    CHECK(order_of(c, 2, 64).energy == Approx(4).margin(0.2));
    CHECK(order_of(c, 4, 64).energy == Approx(6).margin(0.3));
  }
}

// A mode cos qx of a linear theory on a stencil that is symmetric in time and space has the action a(y₀² + y₁²)/2 − b y₀y₁ of two
// rows, as K(ẏ² − ω²y²)/2 has exactly over h with cos ωh = a/b and K = bh² sin(ωh)/(ωh), a and b divided by hk.
TEST_CASE("the modified energy of a linear mode is that of its exact dispersion relation") {
  const Case theory{"klein-gordon", "rectangle-symmetric"};
  const double q = 2 * std::numbers::pi / length;
  for (const char* stencil : {"rectangle", "rectangle-symmetric", "six-tuple", "triangle-vertex"}) {
    INFO(stencil);
    const StencilTable& table = std::ranges::find(named_tables(), std::string(stencil), &NamedTable::name)->table;
    for (const int order : {2, 4}) {
      std::vector<double> errors;
      for (const int n : {16, 24}) {
        const Problem p = problem_of(theory, n);
        const auto density = text_of(p.theory, p.parameters);
        const double h = p.time_step, k = p.lattice.space_step(), m = density->names().parameters[0].second;
        double a[2][2] = {};
        for (const TablePoint& point : table.points)
          for (const auto& [slot, factor, scale] :
               {std::tuple{JetSlot::phi_t, 1.0, h}, {JetSlot::phi_x, -1.0, k}, {JetSlot::phi, -m * m, 1.0}}) {
            std::complex<double> row[2] = {};
            for (const auto& [vertex, weight] : point[slot]) {
              const Site v = table.pattern.vertices[at(vertex)];
              row[v.time] += weight / scale * std::polar(1.0, q * k * v.space);
            }
            for (int r = 0; r < 2; ++r)
              for (int s = 0; s < 2; ++s) a[r][s] += point.weight * factor * std::real(std::conj(row[r]) * row[s]);
          }
        // an end's own potential moves from one row to the other by a divergence
        const double b = -a[0][1], omega = std::acos(0.5 * (a[0][0] + a[1][1]) / b) / h;
        const double K = b * h * h * std::sin(omega * h) / (omega * h);
        const ModifiedEnergy modified(ModifiedLagrangian(*density, table, order), table, 1, h, p.lattice, 0);
        std::vector<double> rows[2];
        for (int j = 0; j < 2; ++j)
          for (int i = 0; i < n; ++i) rows[j].push_back(std::cos(q * k * i) * std::cos(omega * h * j + 0.4));
        errors.push_back(std::abs(modified.of(rows[0], rows[1], 0).energy - 0.25 * length * K * omega * omega));
      }
      CHECK(errors[0] < 1e-2);
      CHECK(std::log(errors[0] / errors[1]) / std::log(1.5) == Approx(order + 2).margin(0.3));
    }
  }
}

// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/expression.hpp"
#include "schemes/simulation.hpp"
#include "tests/catch.hpp"
#include "tests/verification/experiment.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A beam of length 1, φ_tt + φ_xxxx = 0, in its first mode w(x) cos(B²t).
struct Beam {
  const char* name;
  Wall left, right;
  double B;
  std::string shape;  ///< with b for B
};
constexpr Wall clamped = Wall::clamped, hinged = Wall::fixed, free_end = Wall::natural;

/// cosh − cos − s (sinh − sin) of a clamped left end, with plus signs of a free one, and s from the right end.
Beam with_hyperbolic(const char* name, Wall left, Wall right, double B, const char* sign, double s) {
  return {name, left, right, B, fmt::format("(cosh(b*x) {0} cos(b*x) - {1:.17g}*(sinh(b*x) {0} sin(b*x)))", sign, s)};
}
std::vector<Beam> beams() {
  const double clamped_clamped = 4.7300407448627040, cantilever = 1.8751040687119611, propped = 3.9266023120479188;
  const auto ratio = [](double B) { return (std::cosh(B) - std::cos(B)) / (std::sinh(B) - std::sin(B)); };
  const double c = cantilever, of_cantilever = (std::cosh(c) + std::cos(c)) / (std::sinh(c) + std::sin(c));
  return {with_hyperbolic("clamped", clamped, clamped, clamped_clamped, "-", ratio(clamped_clamped)),
          with_hyperbolic("cantilever", clamped, free_end, cantilever, "-", of_cantilever),
          {"hinged", hinged, hinged, std::numbers::pi, "sin(b*x)"},
          with_hyperbolic("free", free_end, free_end, clamped_clamped, "+", ratio(clamped_clamped)),
          with_hyperbolic("propped", clamped, hinged, propped, "-", ratio(propped))};
}

Problem problem_of(const Beam& beam, const std::string& stencil, int cells, double slope = 0) {
  Problem p;
  p.theory = "text";
  p.parameters["theory.density"] = std::string("0.5*phi_t^2 - 0.5*phi_xx^2");
  p.stencil = stencil;
  p.lattice = Lattice::interval(cells + 1, 1, beam.left, beam.right);
  p.time_step = 0.04 * p.lattice.space_step();
  if (slope != 0) {
    if (beam.left == clamped) p.parameters["boundary.left_slope"] = fmt::format("{}", slope);
    if (beam.right == clamped) p.parameters["boundary.right_slope"] = fmt::format("{}", slope);
  }
  return p;
}

Row row_of(const Formula& u, const Lattice& lattice, double t) {
  Row row;
  for (int i = 0; i < lattice.sites(); ++i) row.push_back(u(t, lattice.position(i)));
  return row;
}

struct Oscillation {
  double frequency, error;
};
/// The frequency by the third zero of the mode's coefficient, Σ w(x_i) y_i, and the error there.
Oscillation oscillation(const Beam& beam, const std::string& stencil, int cells, double slope = 0,
                        bool is_told = true) {
  const Problem p = problem_of(beam, stencil, cells, is_told ? slope : 0);
  const std::vector<std::pair<std::string, double>> b{{"b", beam.B}};
  const Formula u(fmt::format("{}*x + {}*cos(b^2*t)", slope, beam.shape), b, "exact.phi"),
      w(beam.shape, b, "exact.phi");
  const Row mode = row_of(w, p.lattice, 0);
  const auto coefficient = [&](const Row& row) {
    double sum = 0;
    for (std::size_t i = 0; i < row.size(); ++i)
      sum += mode[i] * (row[i] - slope * p.lattice.position(static_cast<int>(i)));
    return sum;
  };
  Simulation simulation(p);
  std::vector<Row> rows;
  for (int j = 0; j < simulation.starting_rows(); ++j) rows.push_back(row_of(u, p.lattice, j * p.time_step));
  simulation.start(rows);
  double before = coefficient(rows.back());
  for (int zeros = 0;;) {
    simulation.step();
    const Row row = newest(simulation, p.lattice);
    const double now = coefficient(row);
    const double t = static_cast<double>(simulation.newest()) * p.time_step;
    if (before * now <= 0 && ++zeros == 3)
      return {2.5 * std::numbers::pi / (t - p.time_step * now / (now - before)),
              distance(row, row_of(u, p.lattice, t))};
    before = now;
  }
}

}  // namespace

TEST_CASE("the ends of a beam are of second order: clamped, hinged and free") {
  for (const char* stencil : {"six-tuple", "nine-tuple"})
    for (const Beam& beam : beams()) {
      const Oscillation coarse = oscillation(beam, stencil, 16), fine = oscillation(beam, stencil, 32);
      const double exact = beam.B * beam.B;
      const double p = order(std::abs(coarse.frequency - exact), std::abs(fine.frequency - exact), 2),
                   of_rows = order(coarse.error, fine.error, 2);
      CAPTURE(stencil, beam.name, coarse.frequency, fine.frequency, exact, p, coarse.error, fine.error, of_rows);
      CHECK(p > 1.85);
      CHECK(p < 2.2);
      CHECK(of_rows > 1.8);
      CHECK(of_rows < 2.3);
      // without the error of second order
      CHECK((4 * fine.frequency - coarse.frequency) / 3 == Approx(exact).epsilon(3e-3));
    }
}

TEST_CASE("a clamped wall keeps the slope that it is given") {
  for (const char* stencil : {"six-tuple", "nine-tuple"})
    for (const Beam& beam : beams()) {
      if (beam.left != clamped) continue;
      const Oscillation level = oscillation(beam, stencil, 16), sloping = oscillation(beam, stencil, 16, 0.75);
      CAPTURE(stencil, beam.name);
      CHECK(sloping.frequency == Approx(level.frequency).epsilon(1e-9));
      CHECK(sloping.error == Approx(level.error).epsilon(1e-6));
      // of a level wall
      CHECK(std::abs(oscillation(beam, stencil, 16, 0.75, false).error / level.error - 1) > 0.2);
    }
}

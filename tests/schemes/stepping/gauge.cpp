// SPDX-License-Identifier: MIT
#include "schemes/stepping/gauge.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/start_values.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/undetermined.hpp"
#include "tests/catch.hpp"
#include "tests/schemes/support.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double pi = std::numbers::pi;

/// A density as text on a circle of length 2π.
Problem potential(const std::string& density, int sites, double time_step) {
  Problem p;
  p.theory = "text", p.stencil = "six-tuple", p.lattice = Lattice::circle(sites, 2 * pi), p.time_step = time_step;
  p.parameters["theory.density"] = density;
  return p;
}
const std::string linear = "0.5*phi_x*phi_t - 0.5*phi_xx^2",
                  korteweg_de_vries = "0.5*phi_x*phi_t + phi_x^3/6 - 0.5*phi_xx^2";

template <class Field>
Row sampled(const Lattice& lattice, const Field& phi) {
  Row row(at(lattice.sites()));
  for (int i = 0; i < lattice.sites(); ++i) row[at(i)] = phi(lattice.position(i));
  return row;
}
double mean(const Row& row) { return std::accumulate(row.begin(), row.end(), 0.0) / static_cast<double>(row.size()); }
Row newest(const Simulation& simulation) {
  Row row(at(simulation.evolution().system().lattice().sites()));
  simulation.copy_row(0, row);
  return row;
}

bool has_gauge(const Problem& p) {
  const Simulation simulation(p);
  return !undetermined_means(simulation.evolution().system(), simulation.evolution().plan()).empty();
}
std::string message_of_start(const Problem& p, const Row& row) {
  return message_of([&] {
    Simulation simulation(p);
    start_from_values(simulation, row, 0);
  });
}

/// The error of φ = ½ + sin(x + t) + ½ cos(2x + 8t), a solution of φ_tx + φ_xxxx = 0, at t = 1.
double linear_error(int sites) {
  const Problem p = potential(linear, sites, 0.5 / sites);
  const auto exact = [](double t) {
    return [t](double x) { return 0.5 + std::sin(x + t) + 0.5 * std::cos(2 * x + 8 * t); };
  };
  Simulation simulation(p);
  simulation.start({sampled(p.lattice, exact(0)), sampled(p.lattice, exact(p.time_step))});
  const auto steps = static_cast<int>(std::lround(1 / p.time_step));
  simulation.steps(steps - 1);
  const Row row = newest(simulation), wanted = sampled(p.lattice, exact(1));
  double error = 0;
  for (std::size_t i = 0; i < row.size(); ++i) error = std::max(error, std::abs(row[i] - wanted[i]));
  CHECK(std::abs(mean(row) - 0.5) < 1e-12);
  return error;
}

/// The errors at t = 0.5 of 50 steps and of 100, against 1600 steps.
template <class RowAt>
std::pair<double, double> errors_at_half(const RowAt& row_at) {
  const Row finest = row_at(0.5 / 1600);
  const auto off = [&](double time_step) {
    const Row row = row_at(time_step);
    double most = 0;
    for (std::size_t i = 0; i < row.size(); ++i) most = std::max(most, std::abs(row[i] - finest[i]));
    return most;
  };
  return {off(0.5 / 50), off(0.5 / 100)};
}

}  // namespace

TEST_CASE("the mean of a potential around a circle is a gauge, which rows keep: the linear one converges") {
  CHECK(has_gauge(potential(linear, 65, 0.01)));
  const double coarse = linear_error(33), fine = linear_error(65);
  CHECK(fine < 0.02);
  CHECK(coarse / fine > 3.5);
}

TEST_CASE("of two fields only the mean of a potential is a gauge, and a step keeps it") {
  // φ_tx + φ_xxxx = 0 beside a wave v, which the slope of φ pushes: L = … + v φ_x
  Problem p = potential("0.5*u_x*u_t - 0.5*u_xx^2 + 0.5*v_t^2 - 0.5*v_x^2 - 0.5*v^2 + 0.1*v*u_x", 33, 0.01);
  p.parameters["theory.fields"] = "v, u";
  Simulation simulation(p);
  const LatticeSystem& system = simulation.evolution().system();
  CHECK(undetermined_means(system, simulation.evolution().plan()) == std::vector{1});
  CHECK(simulation.plan_report().find("no equation determines the mean of u in a row") != std::string::npos);
  CHECK_NOTHROW(require_determined(simulation.evolution()));
  const auto row = [&](double t) {
    Row both;
    for (int i = 0; i < 33; ++i) {
      const double x = p.lattice.position(i);
      both.push_back(0.3 + std::cos(x) * std::cos(t)), both.push_back(0.5 + std::sin(x + t));
    }
    return both;
  };
  simulation.start({row(0), row(0.01)});
  simulation.steps(200);
  Row last(66);
  simulation.copy_row(0, last);
  double of_u = 0, of_v = 0;
  for (std::size_t n = 0; n < 66; n += 2) of_v += last[n] / 33, of_u += last[n + 1] / 33;
  CHECK(std::abs(of_u - 0.5) < 1e-12);
  CHECK(std::abs(of_v - 0.3 * std::cos(2.01)) < 0.01);  // its mean moves by v_tt + v = 0
}

TEST_CASE("fields of first order beside others start from row 0 and the others' rates: second order in time") {
  const auto row_at = [](double time_step) {
    Problem p =
        potential("0.5*u_x*u_t + u_x^3/6 - 0.5*u_xx^2 + 0.5*v_t^2 - 0.5*v_x^2 - 0.5*v^2 + 0.1*v*u_x", 33, time_step);
    p.parameters["theory.fields"] = "v, u";
    Row row, rates;
    for (int i = 0; i < 33; ++i) {
      const double x = p.lattice.position(i);
      row.push_back(0.3 + std::cos(x)), row.push_back(0.5 + std::sin(x));
      rates.push_back(0.4 * std::sin(x)), rates.push_back(0);
    }
    Simulation simulation(p);
    simulation.start_centred(row, rates);
    simulation.steps(static_cast<int>(std::lround(0.5 / time_step)) - 1);
    Row last(66);
    simulation.copy_row(0, last);
    return last;
  };
  const auto [coarse, fine] = errors_at_half(row_at);
  CAPTURE(coarse, fine);
  CHECK(fine < 1e-2);
  CHECK(std::abs(std::log2(coarse / fine) - 2) < 0.2);
}

TEST_CASE("an equation that determines the mean leaves no gauge") {
  Problem wave = potential("0.5*phi_t^2 - 0.5*phi_x^2", 33, 0.05);
  CHECK_FALSE(has_gauge(wave));
  wave.parameters["theory.density"] = std::string("0.5*phi_x*phi_t - 0.5*phi_xx^2 - 0.5*phi^2");
  CHECK_FALSE(has_gauge(wave));
  Problem clamped = potential(korteweg_de_vries, 33, 0.01);
  clamped.lattice = Lattice::interval(33, 2 * pi, Wall::clamped, Wall::clamped);
  CHECK_FALSE(has_gauge(clamped));
}

TEST_CASE("a density linear in phi_t starts from one row: Korteweg-de Vries, second order in time") {
  const auto row_at = [](double time_step) {
    const Problem p = potential(korteweg_de_vries, 33, time_step);
    Simulation simulation(p);
    start_from_values(simulation, sampled(p.lattice, [](double x) { return std::sin(x); }), 0);
    simulation.steps(static_cast<int>(std::lround(0.5 / time_step)) - 1);
    return newest(simulation);
  };
  const auto [coarse, fine] = errors_at_half(row_at);
  CHECK(fine < 1e-2);
  CHECK(std::abs(std::log2(coarse / fine) - 2) < 0.2);
}

TEST_CASE("other densities and stencils of three rows do not start from one row") {
  Problem p = potential(korteweg_de_vries, 33, 0.01);
  p.stencil = "nine-tuple";
  const Row row = sampled(p.lattice, [](double x) { return std::sin(x); });
  CHECK(message_of_start(p, row).find("six-tuple") != std::string::npos);
  p = potential("0.5*phi_t^2 - 0.5*phi_x^2", 33, 0.01);
  CHECK(message_of_start(p, row).find("centred") != std::string::npos);
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "tests/catch.hpp"
#include "tools/bench/collision.hpp"
#include "tools/bench/command_line.hpp"
#include "tools/bench/textbook/textbook_autovectorised.hpp"

using delf::bench::Collision;
using delf::bench::Textbook;

namespace {

constexpr int steps = 200;

std::vector<double> engine_row(const Collision& collision) {
  delf::Simulation simulation(collision.problem());
  simulation.start(collision.rows());
  for (int n = 0; n < steps; ++n) simulation.step();
  std::vector<double> row(collision.sites);
  simulation.copy_row(0, row);
  return row;
}

double difference(std::span<const double> a, std::span<const double> b) {
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

/// From the engine, when the textbook's circle is longer and its step larger by these factors: with the first alone
/// φ_xx has a wrong coefficient, with the second alone φ_tt, with both the same sin φ.
double textbook_error(const Collision& collision, double longer = 1, double slower = 1) {
  const auto textbook = delf::bench::make_textbook(collision.scheme, collision.sites, longer * Collision::length,
                                                   slower * collision.time_step(), collision.tolerance);
  const auto rows = collision.rows();
  textbook->start(rows[0], rows[1]);
  for (int n = 0; n < steps; ++n) textbook->step();
  return difference(textbook->row(), engine_row(collision));
}

}  // namespace

TEST_CASE("the textbook schemes that delf-bench times solve what the engine solves, and a wrong coefficient is seen") {
  for (const std::string& scheme : delf::bench::textbook_schemes()) {
    for (const int sites : {63, 255}) {
      const Collision collision{scheme, delf::bench::suited_sites(scheme, sites), 1e-14};
      CAPTURE(scheme, collision.sites);
      const double bound = 2e-10;  // 2e-11 were seen: rounding of y, where the engine keeps y and its increments
      CHECK(textbook_error(collision) < bound);
      CHECK(textbook_error(collision, 1 + 1e-6) > 10 * bound);
      CHECK(textbook_error(collision, 1, 1 + 1e-6) > 10 * bound);
      CHECK(textbook_error(collision, 1 + 1e-6, 1 + 1e-6) > 10 * bound);
    }
  }
}

TEST_CASE("the explicit loop that the compiler vectorises for delf-bench is leapfrog") {
  const Collision collision{"triangle-vertex", 255};
  const double h = collision.time_step();
  const auto error = [&](double coefficient) {
    auto rows = collision.rows();
    for (int n = 0; n < steps; ++n) {
      delf::bench::autovectorised_step(rows[1].data(), rows[0].data(), collision.sites, coefficient / 64, h * h);
      std::swap(rows[0], rows[1]);
    }
    return difference(rows[1], engine_row(collision));
  };
  CHECK(error(1) < 1e-11);
  CHECK(error(1 + 1e-6) > 1e-9);

  std::vector<double> x(1000), sine(1000);
  for (std::size_t i = 0; i < x.size(); ++i) x[i] = 0.01 * static_cast<double>(i) - 5;
  delf::bench::autovectorised_sine(x.data(), sine.data(), 1000);
  for (std::size_t i = 0; i < x.size(); ++i) CHECK(std::abs(sine[i] - std::sin(x[i])) < 1e-14);
}

TEST_CASE("delf-bench refuses bad options with exit code 2") {
  using Words = std::vector<std::string>;
  for (const Words& words :
       {Words{"bogus"}, Words{"schemes", "--sites", "x"}, Words{"schemes", "--sites", "3"}, Words{"sizes", "--nope"},
        Words{"schemes", "--scheme", "foo"}, Words{"schemes", "--tolerance", "nan"}, Words{"limit", "--repeats", "0"}})
    CHECK(delf::bench::run(words) == 2);
}

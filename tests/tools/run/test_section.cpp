// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/run/section.hpp"

using namespace delf::testing;
using delf::Section;

namespace {

/// The numbers of a section's table, line by line.
std::vector<std::vector<double>> numbers_of(const std::string& table) {
  std::vector<std::vector<double>> all;
  for (const std::string& line : lines(table)) {
    if (line.starts_with("time")) continue;
    std::vector<double> numbers;
    for (std::size_t at = 0; at != std::string::npos && at < line.size();) {
      numbers.push_back(std::stod(line.substr(at)));
      const auto comma = line.find(',', at);
      at = comma == std::string::npos ? comma : comma + 1;
    }
    all.push_back(numbers);
  }
  return all;
}

/// Of the motion (cos t, cos √2 t), t = nh.
Section of_two_oscillators(const std::string& text, double h, int rows) {
  Section section(text, 2, h);
  const double w = std::numbers::sqrt2;
  for (int n = 0; n <= rows; ++n)
    section.see({std::cos(n * h), std::cos(w * n * h), -std::sin(n * h), -w * std::sin(w * n * h)});
  section.finish();
  return section;
}

/// Of the times 3π/2 + 2πk the nearest.
double exact_time(double t) {
  constexpr double pi = std::numbers::pi;
  return 1.5 * pi + 2 * pi * std::round((t - 1.5 * pi) / (2 * pi));
}

/// The largest error of q2 where q1 = 0 and p1 > 0, whose times are 3π/2 + 2πk; the ends of the run are left out.
double section_error(double h) {
  double most = 0;
  for (const auto& point : numbers_of(of_two_oscillators("q1 = 0, p1 > 0", h, static_cast<int>(40 / h)).table()))
    if (point[0] > 4 * h && point[0] < 40 - 4 * h)
      most = std::max(most, std::abs(point[2] - std::cos(std::numbers::sqrt2 * exact_time(point[0]))));
  return most;
}

}  // namespace

TEST_CASE("a section has the crossings of its surface where its conditions hold, and no others") {
  const Section up = of_two_oscillators("q1 = 0, p1 > 0", 0.1, 400);
  const auto points = numbers_of(up.table());
  REQUIRE(points.size() == 6);  // 3π/2 + 2πk < 40
  CHECK(up.points() == 6);
  for (std::size_t k = 0; k < points.size(); ++k) {
    CHECK(std::abs(points[k][0] - (1.5 + 2.0 * static_cast<double>(k)) * std::numbers::pi) < 1e-9);
    CHECK(std::abs(points[k][1]) < 1e-14);
    CHECK(std::abs(points[k][3] - 1) < 1e-9);
  }
  CHECK(lines(up.table()).front() == "time,q1,q2,p1,p2");
  CHECK(of_two_oscillators("q1=0", 0.1, 400).points() == 13);
  CHECK(of_two_oscillators("p1 < 0, q1 = 0", 0.1, 400).points() == 7);
  CHECK(of_two_oscillators("q1 = 0, p1 > 0, q2 > 0", 0.1, 400).points() +
            of_two_oscillators("q1 = 0, p1 > 0, q2 < 0", 0.1, 400).points() ==
        6);
  CHECK(of_two_oscillators("q1 = 1.5", 0.1, 400).points() == 0);
  CHECK(up.drawn_columns() == std::array{3, 5});
}

TEST_CASE("points of a section are of order 8 in the step, from both sides") {
  const double slope = std::log2(section_error(0.4) / section_error(0.2));
  CAPTURE(section_error(0.4), section_error(0.2));
  CHECK(std::abs(slope - 8) < 0.7);
}

TEST_CASE("a run of few rows has a section too") {
  CHECK(of_two_oscillators("q1 = 0", 0.5, 4).points() == 1);
  CHECK(of_two_oscillators("q1 = 0", 0.5, 0).points() == 0);
}

TEST_CASE("a section that says nothing, or too much, is refused with an example") {
  for (const char* text : {"", "q1", "q1 = 0, q2 = 0", "p1 > 0", "q3 = 0", "q1 = much", "q = 0", "q1 == 0"}) {
    CAPTURE(text);
    try {
      Section(text, 2, 0.1);
      FAIL("it was accepted");
    } catch (const delf::BadInput& bad) {
      CHECK(bad.key() == "output.section");
      CHECK(contains(bad.what(), "q1 = 0, p1 > 0"));
    }
  }
  CHECK_NOTHROW(Section("q = 0, p > 0", 1, 0.1));
}

TEST_CASE("a run writes its section, whatever rows it records, and for any Lagrangian") {
  const Folder folder;
  const std::string run = "run henon-heiles --run.until=60 --output.figures=off --output.section=\"q1 = 0, p1 > 0\" ";
  REQUIRE(delf_program(folder, run + "--scheme.tableau=gauss4 --output.every=0 --out fine").code == 0);
  const Ran coarse = delf_program(folder, run +
                                              "--scheme.method=multisymplectic --lattice.stencil=trapezoidal "
                                              "--initial.start=centred --lattice.time_step=0.01 --out other");
  INFO(coarse.err);
  REQUIRE(coarse.code == 0);
  CHECK(contains(coarse.out, "section.csv"));
  const auto fine = numbers_of(read(folder / "fine/section.csv")),
             other = numbers_of(read(folder / "other/section.csv"));
  REQUIRE(fine.size() > 5);
  REQUIRE(other.size() == fine.size());
  for (std::size_t n = 0; n < fine.size(); ++n)
    for (std::size_t a = 0; a < 5; ++a) CHECK(std::abs(fine[n][a] - other[n][a]) < 1e-3);
  // the energy of every point is that of the start, 5/96
  for (const auto& x : fine)
    CHECK(std::abs(0.5 * (x[3] * x[3] + x[4] * x[4] + x[1] * x[1] + x[2] * x[2]) + x[1] * x[1] * x[2] -
                   x[2] * x[2] * x[2] / 3 - (0.5 * (0.0625 + 0.015625) + 0.0625 * 0.125 - 0.001953125 / 3)) < 1e-8);
  check_refused(delf_program(folder, "run henon-heiles --output.section=q3=0"), {"output.section", "q1 = 0, p1 > 0"});
}

TEST_CASE("a section of a method without momenta at row 0 is refused in one line") {
  const Folder folder;
  check_refused(delf_program(folder, "run lotka-volterra --output.section='q1 = 1, p1 > 0' --out out"),
                {"output.section", "no momenta at row 0"});
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("an angle crosses its section modulo 2 pi, and has values from -pi to pi there") {
  constexpr double pi = std::numbers::pi, h = 0.1;
  // q1 turns forwards, 0.95 of a turn in ten rows; q2 turns backwards
  const auto section = [&](const std::string& text, const std::vector<int>& angles, double speed = 6) {
    Section made(text, 2, h, angles);
    for (int n = 0; n <= 100; ++n) made.see({0.1 + speed * n * h, 1 - 2 * n * h, speed, -2});
    made.finish();
    return numbers_of(made.table());
  };
  const auto points = section("q1 = 0, p1 > 0", {0, 1});
  REQUIRE(points.size() == 9);  // 0.1 + 6t = 2πn, t < 10
  for (std::size_t n = 0; n < points.size(); ++n) {
    const double t = (2 * pi * static_cast<double>(n + 1) - 0.1) / 6;
    CHECK(std::abs(points[n][0] - t) < 1e-12);
    CHECK(std::abs(points[n][1]) < 1e-12);
    CHECK(std::abs(points[n][2] - std::remainder(1 - 2 * t, 2 * pi)) < 1e-12);
  }
  CHECK(section("q1 = 0", {}).empty());
  CHECK(section("q1 = 3", {}).size() == 1);
  CHECK(section("q1 = 3, q2 < 0", {0}).size() == 9);  // q2 itself, from 1 to −19, is no angle here
  CHECK(section("q1 = 3, q2 < 0", {0, 1}).size() == 3);
  CHECK(section("q2 = -1", {0, 1}).size() == 3);
  // more than a turn between two rows, in their order
  const auto fast = section("q1 = 0", {0}, 100);
  REQUIRE(fast.size() == 159);
  CHECK(std::ranges::is_sorted(fast, {}, [](const auto& point) { return point[0]; }));
  const auto back = section("q1 = 0", {0}, -100);
  REQUIRE(back.size() == 160);
  CHECK(std::ranges::is_sorted(back, {}, [](const auto& point) { return point[0]; }));
}

TEST_CASE("sections of pendulums that turn over have every turn: by name, as text, and on the circle") {
  const Folder folder;
  const std::string keys =
      "[lattice]\nspace = point\nstencil = trapezoidal\ntime_step = 0.05\n[initial]\nstate = point\nq = 0.1\nv = 8\n"
      "[run]\nuntil = 30\n[output]\nfigures = off\nsection = q = 0, p > 0\n";
  folder.write("p.ini", "[theory]\nname = pendulum\n" + keys);
  folder.write("t.ini", "[theory]\ndensity = 0.5*phi_t^2 + cos(phi) - 1\n" + keys);
  const auto count = [&](const std::string& command) {
    const Ran ran = delf_program(folder, "run " + command + " --out out");
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    return lines(read(folder / "out/section.csv")).size() - 1;
  };
  CHECK(count("p.ini") == 37);  // 30.0125/T, T = ∫ dq/√(64 + 2 cos q − 2 cos 0.1) = 0.79806
  CHECK(count("t.ini --theory.angles=phi") == 37);
  CHECK(count("t.ini") == 0);
  CHECK(count("t.ini --theory.fibre=S1") == 37);
  check_refused(delf_program(folder, "run t.ini --theory.angles=psi --out out"),
                {"theory.angles", "none of the fields"});
  check_refused(
      delf_program(folder, "run t.ini --theory.angles=phi --theory.density='0.5*phi_t^2 - 0.5*phi^2' --out out"),
      {"theory.angles", "grows by 2 pi"});
}

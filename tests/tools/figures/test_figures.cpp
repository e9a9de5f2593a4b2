// SPDX-License-Identifier: MIT
#include <cmath>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/film.hpp"
#include "tools/figures/trace.hpp"

using namespace delf::testing;
using delf::Film;
using delf::Trace;

TEST_CASE("figures are drawn as PNG and as SVG, and nothing else is left beside them") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const auto scene = GENERATE(as<std::string>(), "collision --run.until=30", "phi4-kink --run.until=5",
                              "kink --run.until=2 --output.times=0,1,1.7 --output.every=3",
                              "collision --lattice.stencil=triangle --lattice.courant=1.2 --run.until=400",
                              "collision --run.until=300 --output.every=100");
  INFO(scene);
  const Ran ran = delf_program(folder, "run " + scene + " --out 'with blank'");
  INFO(ran.err);
  CHECK_FALSE(contains(ran.err, "figures"));
  for (const char* name : {"spacetime", "waveforms", "energy"}) {
    CHECK(read(folder / (std::string("with blank/figures/") + name + ".png")).starts_with("\x89PNG"));
    const std::string svg = read(folder / (std::string("with blank/figures/") + name + ".svg"));
    CHECK(contains(svg, "<svg"));
    CHECK(contains(svg, "</svg>"));
  }
  for (const auto& entry : std::filesystem::directory_iterator(folder / "with blank"))
    CHECK_FALSE(entry.path().filename().string().starts_with("."));
}

TEST_CASE("the figure of the energy error says which energy that is") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  REQUIRE(delf_program(folder, "run kink --run.until=1 --out here").code == 0);
  const std::string svg = read(folder / "here/figures/energy.svg");
  CHECK(contains(svg, "symmetric rectangle"));
  CHECK(contains(svg, "order 2"));
  REQUIRE(delf_program(folder, "run pendulum --run.until=1 --out point").code == 0);
  const std::string point = read(folder / "point/figures/energy.svg");
  CHECK_FALSE(contains(point, "rectangle"));
  CHECK(contains(point, "midway between the last two rows"));
}

TEST_CASE("figures name what they draw: the field, the density of a text, what colours stand for") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  REQUIRE(delf_program(folder, "run kdv --run.until=0.5 --out kdv").code == 0);
  const std::string waves = read(folder / "kdv/figures/waveforms.svg");
  CHECK(contains(waves, "kdv: waveforms of φ"));
  CHECK(contains(waves, "ℓ = 0.5*phi_x*phi_t + phi_x^3"));
  REQUIRE(delf_program(folder, "run gauss-kink --run.until=1 --out gauss").code == 0);
  CHECK(contains(read(folder / "gauss/figures/energy.svg"), "H of the last row"));
  // coordinates by the names of their theory, and all of eighteen: six colours a panel
  REQUIRE(delf_program(folder, "run henon-heiles-text --run.until=1 --out named").code == 0);
  CHECK(contains(read(folder / "named/figures/orbit.svg"), ">u<"));
  REQUIRE(delf_program(folder, "run solar-system --run.until=2000 --out planets").code == 0);
  const std::string planets = read(folder / "planets/figures/trajectory.svg");
  for (int n = 1; n <= 18; ++n) CHECK(contains(planets, std::string(">q").append(std::to_string(n)).append("<")));
  REQUIRE(delf_program(folder, "run refined-kink --out complex").code == 0);
  CHECK(contains(read(folder / "complex/figures/levels.svg"), ">level<"));
  CHECK(contains(read(folder / "complex/figures/field.svg"), ">phi<"));
}

TEST_CASE("waveforms are drawn over the exact solution, as long as there is one") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  REQUIRE(delf_program(folder, "run soliton-bounce --run.until=0.2 --out exact").code == 0);
  CHECK(contains(read(folder / "exact/figures/waveforms.svg"), "grey: exact"));
  REQUIRE(delf_program(folder, "run collision --run.until=1 --out unknown").code == 0);
  CHECK_FALSE(contains(read(folder / "unknown/figures/waveforms.svg"), "grey: exact"));
}

TEST_CASE("without gnuplot a run succeeds, and says which package is missing") {
  const Folder folder;
  const Ran ran = delf_program(folder, "run kink --run.until=1 --out here", "PATH=/nowhere");
  CHECK(ran.code == 0);
  REQUIRE(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "gnuplot-nox"));
  CHECK(std::filesystem::exists(folder / "here/summary.json"));
  CHECK_FALSE(std::filesystem::exists(folder / "here/figures"));
}

TEST_CASE("a film keeps the first and the last row, few enough, and evenly spaced but for the last") {
  const auto lattice = delf::Lattice::circle(2000, 10);
  Film film(lattice);
  for (int f = 0; f < 5000; ++f) film.append(f, std::vector<double>(2000, f));
  film.finish();
  CHECK(film.frames() <= 601);
  CHECK(film.space().size() <= 600);
  CHECK(film.time(0) == 0);
  CHECK(film.time(film.frames() - 1) == 4999);
  CHECK(film.frame(film.frames() - 1)[3] == 4999);
  CHECK(film.even_frames() == film.frames() - 1);
  CHECK(film.time(2) - film.time(1) == film.time(film.even_frames() - 1) - film.time(film.even_frames() - 2));
}

TEST_CASE("frames farther apart than the motion lasts are aliased, whatever their number") {
  const delf::Lattice lattice = delf::Lattice::circle(16, 16);
  // cos(qx − ωt) and its rate, in so many frames a period
  const auto film_of = [&](double frames_a_period, double amplitude) {
    Film film(lattice);
    for (int f = 0; f < 2000; ++f) {
      std::vector<double> row, rates;
      for (int i = 0; i < 16; ++i) {
        const double phase = 2 * std::acos(-1.0) * (i / 16.0 - f / frames_a_period);
        row.push_back(std::cos(2 * std::acos(-1.0) * i / 16.0) + amplitude * std::cos(phase));
        rates.push_back(amplitude * std::sin(phase) * 2 * std::acos(-1.0) / frames_a_period);
      }
      film.append(f, row, rates);
    }
    film.finish();
    return film;
  };
  CHECK(film_of(200, 1).stride() == 4);
  CHECK_FALSE(film_of(200, 1).is_aliased());
  CHECK_FALSE(film_of(12, 1).is_aliased());  // three frames in a period are left
  CHECK(film_of(9, 1).is_aliased());
  CHECK(film_of(4.01, 1).is_aliased());  // nearly at rest
  CHECK_FALSE(film_of(4.01, 1e-3).is_aliased());
}

TEST_CASE("a map that shows what is not there says so, in its title and in the report") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  // the two collide every 25.29
  const auto [every, aliased] = GENERATE(table<std::string, bool>({{"13", false}, {"640", true}}));
  const Ran ran = delf_program(
      folder,
      "run collision --run.until=400 --output.fields=off --output.format=svg --out out --output.every=" + every);
  INFO(ran.out);
  REQUIRE(ran.code == 0);
  CHECK(contains(ran.out, "what moves in them may be an alias; set output.every = ") == aliased);
  CHECK(contains(read(folder / "out/figures/spacetime.svg"), "may be an alias") == aliased);
}

TEST_CASE("a trace keeps every extreme in bounded memory") {
  Trace trace;
  for (int i = 0; i < 1000000; ++i) trace.append(i, i == 123456 ? 7.0 : i == 765432 ? -3.0 : 0.0);
  CHECK(trace.intervals().size() <= 2000);
  double least = 0, most = 0;
  for (const auto& interval : trace.intervals()) {
    least = std::min(least, interval.least);
    most = std::max(most, interval.most);
  }
  CHECK(most == 7);
  CHECK(least == -3);
  CHECK(trace.intervals().front().begin == 0);
  CHECK(trace.intervals().back().end == 999999);
}

TEST_CASE("a long subtitle is smaller, or on several lines, and never cut") {
  const auto labels = [](const std::string& subtitle) {
    return lines(delf::figure_title("title", subtitle)).size() - 1;
  };
  CHECK(labels("short") == 1);
  std::string words;
  for (int i = 0; i < 30; ++i) words += (i ? " word" : "word") + std::to_string(i);
  CHECK(labels(words) == 2);
  CHECK(labels(words + " " + words) == 4);
  CHECK(contains(delf::figure_title("title", words), "word29"));
  // the size is made to fit: one line, whatever rounding makes of the columns, until the letters are of 8 points
  for (std::size_t columns = 80; columns <= 130; ++columns) {
    INFO(columns);
    std::string two(columns, 'a');
    two[columns / 2] = ' ';
    CHECK(labels(two) == 1);
  }
}

TEST_CASE("curves that cannot be distinguished are said to, and a spike does not flatten the axis") {
  std::vector<std::vector<double>> curves(3, std::vector<double>(1000));
  for (std::size_t i = 0; i < 1000; ++i) {
    const double x = 0.01 * static_cast<double>(i);
    curves[0][i] = std::sin(x), curves[1][i] = std::cos(x), curves[2][i] = std::sin(x) + 0.001;
  }
  CHECK(delf::coinciding(curves, 2) == std::vector<std::size_t>{0, 1, 0});
  const auto name = [](std::size_t c) { return "q" + std::to_string(c); };
  CHECK(contains(delf::key_of_curves(3, name, curves), "'q2 (on q0)'"));
  CHECK(delf::key_of_curves(1, name, {curves[0]}).empty());
  CHECK(delf::robust_range("y", curves).empty());
  curves[1][500] = 1e6;
  CHECK(contains(delf::robust_range("y", curves), "set yrange [-1."));
}

TEST_CASE("a colour scale is symmetric for what swings about zero, and wide enough for what is constant") {
  const auto swinging = delf::colour_scale(std::vector<double>{-0.9, 0, 1});
  CHECK(swinging.swings);
  CHECK(swinging.least == -swinging.most);
  CHECK_FALSE(delf::colour_scale(std::vector<double>{0, 1, 2}).swings);
  const auto constant = delf::colour_scale(std::vector<double>{3, 3, 3});
  CHECK(constant.least < 3);
  CHECK(constant.most > 3);
  CHECK(delf::nice_step(40, 5) == 10);
  CHECK(delf::nice_step(5, 8) == 1);
}

// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <complex>
#include <cstdio>
#include <functional>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tools/figures/energy_figure.hpp"
#include "tools/figures/figure_style.hpp"
#include "tools/figures/spectrum_figure.hpp"
#include "tools/figures/thinned_rows.hpp"
#include "tools/figures/trace.hpp"

using namespace delf::testing;
using delf::ThinnedRows;
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
  CHECK(contains(read(folder / "complex/figures/field.svg"), ">φ<"));
  // a pair of fields has a map each, by the symbols that its waveforms have
  REQUIRE(delf_program(folder, "run coupled-sine-gordon --run.until=2 --out pair").code == 0);
  for (const char* figure : {"spacetime", "waveforms"})
    for (const char* symbol : {"φ₁", "φ₂"})
      CHECK(contains(read(folder / ("pair/figures/" + std::string(figure) + ".svg")), symbol));
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

TEST_CASE("thinned rows keep the first and the last row, few enough, and evenly spaced but for the last") {
  const auto lattice = delf::Lattice::circle(2000, 10);
  ThinnedRows thinned(lattice);
  for (int f = 0; f < 5000; ++f) thinned.append(f, std::vector<double>(2000, f));
  thinned.finish();
  CHECK(thinned.frames() <= 601);
  CHECK(thinned.space().size() <= 600);
  CHECK(thinned.time(0) == 0);
  CHECK(thinned.time(thinned.frames() - 1) == 4999);
  CHECK(thinned.frame(thinned.frames() - 1)[3] == 4999);
  CHECK(thinned.even_frames() == thinned.frames() - 1);
  CHECK(thinned.time(2) - thinned.time(1) ==
        thinned.time(thinned.even_frames() - 1) - thinned.time(thinned.even_frames() - 2));
}

TEST_CASE("frames farther apart than the motion lasts are aliased, whatever their number") {
  const delf::Lattice lattice = delf::Lattice::circle(16, 16);
  // cos(qx − ωt) and its rate, in so many frames a period
  const auto rows_of = [&](double frames_a_period, double amplitude) {
    ThinnedRows thinned(lattice);
    for (int f = 0; f < 2000; ++f) {
      std::vector<double> row, rates;
      for (int i = 0; i < 16; ++i) {
        const double phase = 2 * std::acos(-1.0) * (i / 16.0 - f / frames_a_period);
        row.push_back(std::cos(2 * std::acos(-1.0) * i / 16.0) + amplitude * std::cos(phase));
        rates.push_back(amplitude * std::sin(phase) * 2 * std::acos(-1.0) / frames_a_period);
      }
      thinned.append(f, row, rates);
    }
    thinned.finish();
    return thinned;
  };
  CHECK(rows_of(200, 1).stride() == 4);
  CHECK_FALSE(rows_of(200, 1).is_aliased());
  CHECK_FALSE(rows_of(12, 1).is_aliased());  // three frames in a period are left
  CHECK(rows_of(9, 1).is_aliased());
  CHECK(rows_of(4.01, 1).is_aliased());  // nearly at rest
  CHECK_FALSE(rows_of(4.01, 1e-3).is_aliased());
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

namespace {

/// The numbers of "set xtics FIRST,STEP,LAST" as they are printed, and their places.
std::vector<std::pair<double, std::string>> tics_of(const std::string& command) {
  double first = 0, step = 0, last = 0;
  REQUIRE(std::sscanf(command.c_str(), "set xtics %lf,%lf,%lf", &first, &step, &last) == 3);
  std::vector<std::pair<double, std::string>> tics;
  for (double tic = first; tic <= last; tic += step) {
    std::ostringstream text;
    text << (std::abs(tic) < 1e-9 * step ? 0.0 : tic);
    tics.emplace_back(tic, text.str());
  }
  return tics;
}

/// True if numbers of panels beside each other have less than a letter between them: letters are 0.0088 of the width of a figure, as in its SVG.
bool touch(const std::string& command, double from, double to, double width, double gap) {
  auto tics = tics_of(command);
  const std::size_t here = tics.size();
  for (std::size_t n = 0; n < here; ++n)
    tics.emplace_back(tics[n].first + (to - from) * (1 + gap / width), tics[n].second);
  for (std::size_t n = 1; n < tics.size(); ++n) {
    const double apart = (tics[n].first - tics[n - 1].first) * width / (to - from);
    const auto letters = static_cast<double>(tics[n].second.size() + tics[n - 1].second.size()) / 2;
    if (apart < 0.0088 * (letters + 1)) return true;
  }
  return false;
}

}  // namespace

TEST_CASE("numbers of panels beside each other do not touch") {
  constexpr double width = 0.268, gap = 0.03;
  for (const double from : {0.0, -20.0})
    for (const double to : {40.0, 4000.0, 40000.0, 1e6, 1.5, 0.0012, 6.283185307})
      if (to > from) {
        INFO(from << " to " << to << ": " << delf::panel_tics(from, to, width, gap));
        CHECK_FALSE(touch(delf::panel_tics(from, to, width, gap), from, to, width, gap));
        CHECK(tics_of(delf::panel_tics(from, to, width, gap)).size() >= 2);
      }
  // and this can fail: as waveforms of a long circle once were
  CHECK(touch("set xtics 0,1000,4000", 0, 4000, width, gap));
}

TEST_CASE("lines are told apart without red, green or blue cones, and seen on white") {
  using Colour = std::array<double, 3>;
  const auto linear = [](const std::string& hex) {
    Colour c;
    for (std::size_t i = 0; i < 3; ++i) {
      const double part = std::stoi(hex.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
      c[i] = part <= 0.04045 ? part / 12.92 : std::pow((part + 0.055) / 1.055, 2.4);
    }
    return c;
  };
  // in linear RGB: all cones, then protanopia, deuteranopia and tritanopia             Machado, Oliveira, Fernandes (2009)
  const std::array<std::array<Colour, 3>, 4> sights{
      {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
       {{{0.152286, 1.052583, -0.204868}, {0.114503, 0.786281, 0.099216}, {-0.003882, -0.048116, 1.051998}}},
       {{{0.367322, 0.860646, -0.227968}, {0.280085, 0.672501, 0.047413}, {-0.011820, 0.042940, 0.968881}}},
       {{{1.255528, -0.076749, -0.178779}, {-0.078411, 0.930809, 0.147602}, {0.004733, 0.691367, 0.303900}}}}};
  // CIE L*a*b* of linear sRGB
  const auto lab = [](const Colour& c) {
    const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16 / 116.0; };
    const double x = f(std::max(0.0, 0.4124 * c[0] + 0.3576 * c[1] + 0.1805 * c[2]) / 0.9505),
                 y = f(std::max(0.0, 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2])),
                 z = f(std::max(0.0, 0.0193 * c[0] + 0.1192 * c[1] + 0.9505 * c[2]) / 1.089);
    return Colour{116 * y - 16, 500 * (x - y), 200 * (y - z)};
  };
  const auto nearest = [&](const std::vector<std::string>& colours) {
    double least = 1e300;
    for (const auto& sight : sights) {
      std::vector<Colour> seen;
      for (const std::string& hex : colours) {
        const Colour c = linear(hex);
        Colour s{};
        for (std::size_t i = 0; i < 3; ++i)
          for (std::size_t j = 0; j < 3; ++j) s[i] += sight[i][j] * c[j];
        seen.push_back(lab(s));
      }
      for (std::size_t a = 0; a < seen.size(); ++a)
        for (std::size_t b = 0; b < a; ++b)
          least =
              std::min(least, std::hypot(seen[a][0] - seen[b][0], seen[a][1] - seen[b][1], seen[a][2] - seen[b][2]));
    }
    return least;
  };
  std::vector<std::string> colours;
  for (std::size_t c = 0; c < delf::line_colours; ++c) {
    colours.push_back(delf::component_colour(c));
    const Colour rgb = linear(colours.back());
    CHECK(1.05 / (0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] + 0.05) >= 3);
  }
  CHECK(nearest(colours) > 24);
  CHECK(nearest({"#31688e", "#d95f02", "#1b9e77", "#7570b3", "#e7298a", "#666666"}) < 2);  // and it can fail
}

TEST_CASE("the waves of a row are its Fourier sum, for any number of sites") {
  for (const int N : {1, 2, 3, 60, 97, 128, 255}) {
    std::vector<double> row;
    for (int i = 0; i < N; ++i) row.push_back(std::sin(0.3 * i * i) + 2);
    const std::vector<double> sizes = delf::mode_sizes(row);
    REQUIRE(static_cast<int>(sizes.size()) == N / 2 + 1);
    for (int n = 0; n <= N / 2; ++n) {
      std::complex<double> sum = 0;
      for (int i = 0; i < N; ++i) sum += row[i] * std::polar(1.0, -2 * std::acos(-1.0) * (n * i % N) / N);
      CHECK(std::abs(sizes[n] - std::abs(sum) / N) < 1e-13);
    }
  }
  CHECK(delf::mode_sizes(std::vector<double>(100'003, 1.0)).empty());  // a prime: ten thousand million terms
}

namespace {

/// True if the figure of these energy errors has a logarithmic axis.
bool is_logarithmic(const std::function<double(int)>& error) {
  const Folder folder;
  const delf::Lattice lattice = delf::Lattice::circle(8, 8);
  const ThinnedRows rows(lattice);
  Trace trace;
  for (int n = 0; n < 1000; ++n) trace.append(n, error(n));
  const std::vector<double> times;
  const delf::FigureSource source{"scene", "theory", "scheme", false, lattice, 0, rows, trace, times};
  return contains(delf::energy_figure(source, folder.path()), "set logscale y");
}

}  // namespace

TEST_CASE("an energy error that grows through decades has a logarithmic axis, and another has none") {
  CHECK(is_logarithmic([](int n) { return 1e-13 * std::exp(0.02 * n); }));
  CHECK(is_logarithmic([](int n) { return 0.1 * n; }));  // beyond the energy itself
  CHECK_FALSE(is_logarithmic([](int n) { return 1e-3 * n; }));
  CHECK_FALSE(is_logarithmic([](int n) { return 1e-5 * std::sin(n); }));
  CHECK_FALSE(is_logarithmic([](int n) { return 1e-15 * (n % 3); }));  // round-off
}

TEST_CASE("errors, phase portraits and spectra are drawn where there are any") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const auto drawn = [&](const std::string& run, const std::string& name) {
    const Ran ran = delf_program(folder, "run " + run + " --output.format=svg --overwrite --out out");
    INFO(run << ": " << ran.err);
    CHECK(ran.code == 0);
    CHECK_FALSE(contains(ran.err, "no figures"));
    return read(folder / ("out/figures/" + name + ".svg"));
  };
  CHECK(contains(drawn("kink --run.until=2", "error"), "error against the exact solution"));
  CHECK(drawn("collision --run.until=2", "error").empty());
  CHECK(contains(drawn("pendulum --run.until=2", "phase"), "momentum over coordinate"));
  CHECK(contains(drawn("kepler --run.until=2", "phase"), ">p2<"));
  CHECK(drawn("kink --run.until=2", "phase").empty());
  const std::string spectrum = drawn("collision --run.until=2 --figures.spectrum=on", "spectrum");
  CHECK(contains(spectrum, "waves about φ = 0"));
  CHECK(contains(spectrum, "frequency"));
  CHECK(drawn("collision --run.until=2", "spectrum").empty());
  const Ran wall = delf_program(folder, "run soliton-bounce --figures.spectrum=on --run.until=0.1 --out wall");
  CHECK(wall.code == 0);
  CHECK(contains(wall.err, "only a circle has waves"));
}

// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "lattice/error.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/measure/kinks.hpp"
#include "tools/measure/spectrum.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

constexpr double pi = std::numbers::pi;
const std::vector<double> levels{pi};

MeasuredField field_on(const Lattice& lattice, bool angle, double monodromy = 0) {
  return {lattice, 0.1, monodromy, angle, 1, nullptr};
}

nlohmann::json measures_of(const Folder& folder, const std::string& scene, const std::string& more = "") {
  const Ran ran = delf_program(folder, "run '" + scene + "' --out out " + more);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / "out/summary.json"))["measures"];
}

std::string kink_scene(const std::string& measures) {
  return "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 40\nsites = 401\ncourant = 0.5\n"
         "[initial]\nstate = kink\nposition = 15\nspeed = 0.5\n[run]\nuntil = 10\n[output]\nfigures = off\nfields = "
         "off\n"
         "[measure]\n" +
         measures;
}

}  // namespace

TEST_CASE("kinks are the places where a row passes pi modulo 2 pi, with the sign of its slope") {
  const Lattice lattice = Lattice::interval(5, 4);
  const std::vector<double> row{0, 2 * pi, 4 * pi, 2 * pi, 2 * pi};
  const auto angles = kinks_of(field_on(lattice, true), row, levels);
  REQUIRE(angles.size() == 3);
  CHECK(angles[0].x == Approx(0.5));
  CHECK(angles[1].x == Approx(1.5));
  CHECK(angles[2].x == Approx(2.5));
  CHECK(angles[0].sign + angles[1].sign + angles[2].sign == 1);
  // a value on the line passes level pi once only
  const auto numbers = kinks_of(field_on(lattice, false), row, levels);
  REQUIRE(numbers.size() == 1);
  CHECK(numbers[0].x == Approx(0.5));
  // two in one cell, from right to left where the field falls
  const auto steep = kinks_of(field_on(lattice, true), std::vector<double>{4 * pi, 0, 0, 0, 0}, levels);
  REQUIRE(steep.size() == 2);
  CHECK(steep[0].x == Approx(0.25));
  CHECK(steep[1].x == Approx(0.75));
  CHECK(steep[0].sign == -1);
}

TEST_CASE("a field without bound has no kinks") {
  const Lattice lattice = Lattice::interval(4, 3);
  CHECK(kinks_of(field_on(lattice, true), std::vector<double>{0, 1e100, -1e100, 0}, levels).empty());
  CHECK(kinks_of(field_on(lattice, true), std::vector<double>{0, std::nan(""), 1e300 * 1e300, 0}, levels).empty());
}

TEST_CASE("a kink across the seam of a circle is found") {
  const Lattice lattice = Lattice::circle(4, 4);
  const std::vector<double> row{0.1, 0.2, 0.3, 0.4};
  CHECK(kinks_of(field_on(lattice, true), row, levels).empty());
  const auto kinks = kinks_of(field_on(lattice, true, 2 * pi), row, levels);
  REQUIRE(kinks.size() == 1);
  CHECK(kinks[0].x == Approx(3 + (pi - 0.4) / (2 * pi + 0.1 - 0.4)));
}

TEST_CASE("places are those of the space, round a circle too") {
  const MeasuredField ring = field_on(Lattice::circle(4, 4), true), bar = field_on(Lattice::interval(5, 4), true);
  CHECK(ring.place(-5) == -5);
  CHECK(bar.place(4) == 4);
  for (const double x : {1e300, -1e300, std::nan("")}) {
    CHECK_THROWS_AS(ring.place(x), BadInput);
    CHECK_THROWS_AS(bar.place(x), BadInput);
  }
  CHECK_THROWS_AS(bar.place(4.001), BadInput);
  CHECK_THROWS_AS(bar.place(-0.001), BadInput);
}

TEST_CASE("the peak of a spectrum is found between its lines") {
  std::vector<double> wave;
  for (int j = 0; j < 256; ++j) wave.push_back(3 + std::sin(2 * pi * 12.3 * j / 256));
  CHECK(spectrum_peak(wave, false) == Approx(12.3).epsilon(2e-3));
  CHECK(spectrum_peak(wave, true) == 12);
  CHECK(std::isnan(spectrum_peak(std::vector<double>(64, 1.0), false)));
  CHECK(std::isnan(spectrum_peak(std::vector<double>(4, 1.0), false)));
}

TEST_CASE("a kink is measured: number, place, speed, energy on its left, values") {
  const Folder folder;
  const std::string scene = folder.write(
      "kink.ini",
      kink_scene("n = kinks\ncharge = kink_charge\nx = position(1)\nfrom_right = position(-1)\nv = speed(1)\n"
                 "all = energy_left(L)\nhalf = energy_left(15 + 0.5*9.975)\nat = value(20)\n"
                 "none = position(2)\nsum = 2*speed(1) + pi*0\nend = t\npassed = crossings(18, pi)\n"
                 "high = maximum(18)\n"));
  const auto m = measures_of(folder, scene);
  CHECK(m["n"] == 1);
  CHECK(m["charge"] == 1);
  CHECK(m["x"].get<double>() == Approx(20).margin(0.01));
  CHECK(m["from_right"] == m["x"]);
  CHECK(m["v"].get<double>() == Approx(0.5).margin(0.001));
  // 8γ, and by symmetry half of it left of the kink
  const double energy = 8 / std::sqrt(0.75);
  CHECK(m["all"].get<double>() == Approx(energy).epsilon(0.01));
  CHECK(m["half"].get<double>() == Approx(energy / 2).epsilon(0.01));
  CHECK(m["at"].get<double>() == Approx(pi).margin(0.02));
  CHECK(m["none"].is_null());
  CHECK(m["sum"].get<double>() == Approx(2 * m["v"].get<double>()));
  CHECK(m["end"].get<double>() == Approx(10));
  CHECK(m["passed"] == 1);
  CHECK(m["high"].get<double>() == Approx(4 * std::atan(std::exp(3 / std::sqrt(0.75)))).margin(0.01));
  const auto summary = nlohmann::json::parse(read(folder / "out/summary.json"));
  CHECK(m["all"].get<double>() == Approx(summary["energy_final"].get<double>()).epsilon(1e-9));
}

TEST_CASE("a breather and a wave are measured: frequency, times of extremes, wavenumber") {
  const Folder folder;
  const std::string breather =
      folder.write("breather.ini",
                   "[theory]\nname = sine-gordon\n[lattice]\nlength = 40\nsites = 201\ncourant = 0.5\n[initial]\n"
                   "state = breather\nfrequency = 0.6\n[run]\nuntil = 100\n[output]\nfigures = off\nfields = off\n"
                   "every = 2\n[measure]\nomega = frequency(20)\nlow = minimum(20)\nwhen = maximum_time(20)\n");
  auto m = measures_of(folder, breather);
  CHECK(m["omega"].get<double>() == Approx(0.6).epsilon(0.01));
  CHECK(m["low"].get<double>() == Approx(-4 * std::atan(std::sqrt(1 - 0.36) / 0.6)).epsilon(0.01));
  const std::string wave = folder.write(
      "wave.ini",
      "[theory]\nname = klein-gordon\n[lattice]\nlength = 40\nsites = 201\ncourant = 0.5\n[initial]\n"
      "state = plane-wave\nwavenumber = 3\n[run]\nuntil = 10\n[output]\nfigures = off\n[measure]\nk = wavenumber\n");
  m = measures_of(folder, wave);
  CHECK(m["k"].get<double>() == Approx(2 * pi * 3 / 40));
}

TEST_CASE("modes of a row are measured, between walls and around a circle") {
  const Folder folder;
  const auto scene = [&](const std::string& space, const std::string& phi) {
    return folder.write("modes.ini",
                        "[theory]\nname = wave\n[lattice]\nstencil = triangle-vertex\n" + space +
                            "\nlength = 8\ncourant = 0.5\n[initial]\nphi = " + phi +
                            "\nphi_t = 0\n[run]\nsteps = 1\n[output]\nfigures = off\nfields = off\n[measure]\n"
                            "one = mode(1)\ntwo = mode(2)\nthree = mode(3)\nrate = mode_rate(3)\n");
  };
  // leapfrog's first row is that of rest, less ½h²ω² of it; ω² = (4/k²) sin²(qk/2)
  const double h = 0.25, squared = 16 * std::pow(std::sin(3 * pi / 32), 2);
  auto m = measures_of(folder, scene("space = interval\nsites = 17", "0.5*sin(pi*x/8) - 2*sin(3*pi*x/8)"));
  CHECK(m["one"].get<double>() == Approx(0.5).epsilon(0.01));
  CHECK(std::abs(m["two"].get<double>()) < 1e-14);
  CHECK(m["three"].get<double>() == Approx(-2 * (1 - 0.5 * h * h * squared)).epsilon(1e-12));
  CHECK(m["rate"].get<double>() == Approx(h * squared).epsilon(1e-12));
  m = measures_of(folder, scene("space = interval\nsites = 17\n[boundary]\nleft = natural\nright = natural\n[lattice]",
                                "0.5*cos(pi*x/8)"));
  CHECK(m["one"].get<double>() == Approx(0.5).epsilon(0.01));
  CHECK(std::abs(m["three"].get<double>()) < 1e-14);
  m = measures_of(folder, scene("sites = 16", "7 + 0.5*sin(2*pi*x/8 + 1)"));
  CHECK(m["one"].get<double>() == Approx(0.5).epsilon(0.03));
  CHECK(std::abs(m["two"].get<double>()) < 1e-14);
}

TEST_CASE("a measure without a value in the end is null, and does not lose the run") {
  const Folder folder;
  const std::string scene = folder.write(
      "kink.ini", kink_scene("none = 2*position(2)\nzero = 1/(kinks - 1)\nnegative = log(value(1) - value(39))\n"
                             "some = log(value(39) - value(1))\n"));
  const auto m = measures_of(folder, scene);
  for (const char* name : {"none", "zero", "negative"}) CHECK(m[name].is_null());
  CHECK(m["some"].get<double>() == Approx(std::log(2 * pi)).epsilon(1e-4));
}

TEST_CASE("a measure on the command line wins, and scene.ini repeats measures") {
  const Folder folder;
  const std::string scene = folder.write("kink.ini", kink_scene("n = kinks\n"));
  CHECK(measures_of(folder, scene, "--measure.n=3 --measure.more=2*kinks") ==
        nlohmann::json{{"n", 3.0}, {"more", 2.0}});
  CHECK(contains(read(folder / "out/scene.ini"), "[measure]\nmore = 2*kinks\nn = 3\n") !=
        contains(read(folder / "out/scene.ini"), "[measure]\nn = 3\nmore = 2*kinks\n"));
}

TEST_CASE("parameters of a theory hide neither quantities nor the length of space") {
  const Folder folder;
  const auto text_scene = [&](const std::string& parameters, const std::string& measures) {
    return folder.write(
        "text.ini", "[theory]\nname = text\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2\nparameters = " + parameters +
                        "\n[lattice]\nlength = 40\nsites = 41\ncourant = 0.5\n[initial]\nstate = formula\n"
                        "phi = sin(2*pi*x/40)\n[run]\nsteps = 2\n[output]\nfigures = off\nfields = off\n[measure]\n" +
                        measures);
  };
  const auto m = measures_of(folder, text_scene("q1 = 5, __1 = 7", "at = value(10)\nown = q1\nsum = q1 + value(10)\n"));
  CHECK(m["at"].get<double>() == Approx(1).margin(0.05));
  CHECK(m["own"] == 5);
  CHECK(m["sum"].get<double>() == Approx(6).margin(0.05));
  for (const char* measure : {"kinks", "L", "value(L/2)"}) {
    const Ran ran =
        delf_program(folder, "run '" + text_scene("L = 5", std::string("m = ") + measure + "\n") + "' --out no");
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "\"L\" is the length of space in formulas"));
  }
}

TEST_CASE("a measure whose name has a meaning, or is none, is refused in one line") {
  const Folder folder;
  for (const auto& [name, says] : std::vector<std::pair<std::string, std::string>>{
           {"status", "\"status\" is a name of summary.json"},
           {"error_estimate", "\"error_estimate\" is a name of summary.json"},
           {"pi", "has a meaning already"},
           {"sin", "has a meaning already"},
           {"a b", "is no name"},
           {"a,b", "is no name"},
           {"1x", "is no name"}}) {
    const std::string scene = folder.write("kink.ini", kink_scene(name + " = kinks\n"));
    for (const std::string command : {"run", "sweep --lattice.sites=101,201"}) {
      const auto space = command.find(' ');
      const Ran ran = delf_program(folder, command.substr(0, space) + " '" + scene + "' --out out" +
                                               (space == std::string::npos ? "" : command.substr(space)));
      INFO(name << "\n" << ran.err);
      CHECK(ran.code == 2);
      CHECK(lines(ran.err).size() == 1);
      CHECK(contains(ran.err, "kink.ini:18: measure." + name));
      CHECK(contains(ran.err, says));
      CHECK_FALSE(std::filesystem::exists(folder / "out"));
    }
  }
}

TEST_CASE("a measure that cannot be read is refused in one line") {
  const Folder folder;
  for (const auto& [measure, says] :
       std::vector<std::pair<std::string, std::string>>{{"speed", "write speed(n [, level])"},
                                                        {"value(1, 2)", "write value(x)"},
                                                        {"value(1", "the bracket is not closed"},
                                                        {"2*x", "x is no number here"},
                                                        {"speeed(1)", "speeed"},
                                                        {"value(-1)", "value: x = -1 is not in space"},
                                                        {"maximum(L + 1)", "give a place from 0 to 40"},
                                                        {"value(1e300)", "is not in space"},
                                                        {"energy_left(41)", "is not in space"},
                                                        {"position(1.5)", "there is no kink 1.5"},
                                                        {"speed(0)", "there is no kink 0"},
                                                        {"position(1e300)", "there is no kink"},
                                                        {"mode(0)", "modes are 1, 2, ..."},
                                                        {"mode(1.5)", "modes are 1, 2, ..."},
                                                        {"mode_rate(400)", "modes are 1, 2, ..."},
                                                        {"log(0*kinks)", "not a finite number"},
                                                        {"__1 + kinks", "names that begin with __"},
                                                        {"value(y)", "y"},
                                                        {"", "no value is given"}}) {
    const std::string scene = folder.write("kink.ini", kink_scene("m = " + measure + "\n"));
    const Ran ran = delf_program(folder, "run '" + scene + "' --out out");
    INFO(measure << "\n" << ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "kink.ini:18: measure.m"));
    CHECK(contains(ran.err, says));
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  }
  CHECK(contains(delf_program(folder, "help measures").out, "energy_left(x)"));
}

TEST_CASE("the time at which the energy is lost is measured, of sites that move too") {
  const Folder folder;
  const std::string scene = folder.write(
      "damped.ini",
      "[theory]\nname = sine-gordon\n[lattice]\nlength = 40\nsites = 101\ncourant = 0.5\n[scheme]\nmethod = "
      "damped\n[initial]\nstate = breather\nfrequency = 0.6\n[run]\nuntil = 10\n[output]\nfigures = off\n"
      "fields = off\nevery = 3\n[measure]\nlost = energy_error_time(0.1)\nnever = energy_error_time(2)\n");
  const auto m = measures_of(folder, scene);
  double first = 0;
  std::istringstream series(read(folder / "out/series.csv"));
  std::string line;
  for (std::getline(series, line); first == 0 && std::getline(series, line);) {
    double step, time, energy, error;
    REQUIRE(std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf", &step, &time, &energy, &error) == 4);
    if (std::abs(error) > 0.1) first = time;
  }
  CHECK(first > 0);
  CHECK(m["lost"].get<double>() == Approx(first));
  CHECK(m["never"].is_null());

  const std::string moving = "run two-soliton-bounce --run.until=0.5 --output.figures=off --output.fields=off ";
  Ran ran = delf_program(folder, moving + "'--measure.lost=energy_error_time(1e-12)' --out moving");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(nlohmann::json::parse(read(folder / "moving/summary.json"))["measures"]["lost"].get<double>() > 0);
  ran = delf_program(folder, moving + "--measure.k=kinks --out refused");
  CHECK(ran.code == 2);
  CHECK(ran.err.find("the sites of this scheme move") != std::string::npos);
  ran = delf_program(folder, moving + "'--measure.lost=energy_error_time(0)' --out refused");
  CHECK(ran.code == 2);
}

TEST_CASE("measures at a place see all steps: records beyond Nyquist's frequency change nothing") {
  const Folder folder;
  const auto scene = [&](const std::string& until, const std::string& every) {
    return folder.write("oscillator.ini",
                        "[theory]\nname = harmonic-oscillator\n[lattice]\nstencil = trapezoidal\nspace = point\n"
                        "time_step = 0.1\n[initial]\nstate = point\nq = 1\n[run]\nuntil = " +
                            until + "\n[output]\nfigures = off\nevery = " + every +
                            "\n[measure]\nomega = frequency(0)\npassed = crossings(0, 0)\nhigh = maximum(0)\n"
                            "low = minimum(0)\nwhen = minimum_time(0)\n");
  };
  // trapezoidal: sin(ωh/2) = h/2
  const double omega = 20 * std::asin(0.05);
  for (const char* every : {"1", "50", "0"}) {
    INFO(every);
    const auto m = measures_of(folder, scene("50", every));
    CHECK(m["omega"].get<double>() == Approx(omega).epsilon(0.01));
    CHECK(m["passed"] == 16);
    CHECK(m["high"].get<double>() == Approx(1).epsilon(1e-3));
    CHECK(m["low"].get<double>() == Approx(-1).epsilon(1e-3));
    CHECK(std::remainder(m["when"].get<double>() - pi / omega, 2 * pi / omega) == Approx(0.0).margin(2e-3));
  }
  // of less than a period no frequency is known
  CHECK(measures_of(folder, scene("5", "1"))["omega"].is_null());
}

TEST_CASE("a run in parts has the measures of the whole, to the bit") {
  const Folder folder;
  const std::string scene =
      folder.write("kink.ini", kink_scene("omega = frequency(20)\npassed = crossings(18, pi)\nhigh = maximum(18)\n"
                                          "when = maximum_time(18)\nlast = value(18)\n"));
  const auto whole = measures_of(folder, scene, "--output.every=7");
  measures_of(folder, scene, "--output.every=7 --run.until=4");
  const Ran ran = delf_program(folder, "resume out --run.until=10");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(nlohmann::json::parse(read(folder / "out/summary.json"))["measures"] == whole);
}

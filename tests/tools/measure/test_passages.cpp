// SPDX-License-Identifier: MIT
// Widths, peaks, passages, lines of a spectrum, returns of modes and extremes of the energy, on solutions that are known.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf::testing;

namespace {

constexpr double pi = std::numbers::pi;

Ran measured(const Folder& folder, const std::string& scene, const std::string& more = "") {
  return delf_program(folder, "run " + scene + " --output.figures=off --output.fields=off --out out " + more);
}

nlohmann::json measures_of(const std::string& scene, const std::string& more) {
  const Folder folder;
  const Ran ran = measured(folder, scene, more);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / "out/summary.json"))["measures"];
}

}  // namespace

TEST_CASE("the width of a kink, the mean of a field and the highest peaks are measured") {
  const auto kink = measures_of("kink",
                                "--lattice.sites=1023 --run.until=1 '--measure.w=pulse_width(pi/2, 3*pi/2)' "
                                "'--measure.none=pulse_width(0, 100)'");
  CHECK(kink["w"].get<double>() == Approx(2 * std::log(1 / std::tan(pi / 8)) * std::sqrt(0.75)).epsilon(2e-3));
  CHECK(kink["none"].is_null());
  const Folder folder;
  const std::string hills = folder.write(
      "hills.ini",
      "[theory]\nname = wave\n[lattice]\nspace = circle\nlength = 40\nsites = 400\ncourant = 0.5\n[initial]\nphi = 2 + "
      "exp(-(x - 10.03)^2) + 3*exp(-(x - 30)^2)\nphi_t = 0\n[run]\nsteps = 1\n[measure]\nfirst = peak(1)\nat = "
      "peak_position(1)\nsecond = peak_position(2)\nthird = peak(3)\nm = mean\n");
  REQUIRE(measured(folder, hills).code == 0);
  const auto m = nlohmann::json::parse(read(folder / "out/summary.json"))["measures"];
  CHECK(m["first"].get<double>() == Approx(5).epsilon(3e-3));
  CHECK(m["at"].get<double>() == Approx(30).margin(1e-6));
  CHECK(m["second"].get<double>() == Approx(10.03).margin(2e-3));
  CHECK(m["third"].is_null());
  CHECK(m["m"].get<double>() == Approx(2 + 4 * std::sqrt(pi) / 40).epsilon(1e-4));
  // hills of the last digits are no peaks
  REQUIRE(
      measured(folder, hills, "'--initial.phi=2 + exp(-(x - 10.03)^2) + 3*exp(-(x - 30)^2) + 1e-15*sin(9*x)'").code ==
      0);
  CHECK(nlohmann::json::parse(read(folder / "out/summary.json"))["measures"]["third"].is_null());
}

TEST_CASE("passages of an orbit: its period, and the coordinate in a section") {
  const std::string orbit =
      "kepler --scheme.method=cgvi --scheme.tableau=gauss4 --lattice.time_step=0.05 --run.until=20 ";
  const auto m = measures_of(orbit,
                             "'--measure.T=crossing_time(0, 0, 4) - crossing_time(0, 0, 2)' "
                             "'--measure.q2=section_value(2, 0, 2)' '--measure.late=crossing_time(0, 0, 99)'");
  CHECK(m["T"].get<double>() == Approx(2 * pi).margin(1e-4));
  CHECK(m["q2"].get<double>() == Approx(-0.64).margin(1e-4));  // rising through q1 = 0
  CHECK(m["late"].is_null());
  const Folder folder;
  CHECK(measured(folder, orbit, "'--measure.a=section_value(3, 0, 1)'").code == 2);
  CHECK(measured(folder, orbit, "'--measure.a=crossing_time(0, 0, 0.5)'").code == 2);
  CHECK(measured(folder, "kink", "'--measure.a=section_value(1, 0, 1)'").code == 2);
  CHECK(measured(folder, "kink", "'--measure.a=peak(0)'").code == 2);
}

TEST_CASE("lines of a spectrum have the amplitudes of the waves at a place, and a mode comes back") {
  const Folder folder;
  const std::string string = folder.write(
      "string.ini",
      "[theory]\nname = wave\n[lattice]\nspace = interval\nlength = pi\nsites = 201\ncourant = 0.5\n[initial]\nphi = "
      "0.3*sin(x) + 0.1*sin(2*x)\nphi_t = 0\n[run]\nuntil = 20*pi\n[output]\nevery = 4\n[measure]\none = spectral_line(1, 1, "
      "20*pi)\ntwo = spectral_line(1, 2, 20*pi)\nthree = spectral_line(1, 3, 20*pi)\nback = mode_return(1, 3*pi/2)\nwhen = "
      "mode_return_time(1, 3*pi/2)\nleast = energy_minimum\nmost = energy_maximum\n");
  const Ran ran = measured(folder, string);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const auto m = nlohmann::json::parse(read(folder / "out/summary.json"))["measures"];
  CHECK(m["one"].get<double>() == Approx(0.3 * std::sin(1.0)).epsilon(0.01));
  CHECK(m["two"].get<double>() == Approx(0.1 * std::sin(2.0)).epsilon(0.01));
  CHECK(m["three"].get<double>() < 1e-3);
  CHECK(m["back"].get<double>() == Approx(0.3).epsilon(1e-3));
  const double when = m["when"].get<double>() / pi;  // |cos t| is 1 at every multiple of π
  CHECK(when == Approx(std::round(when)).margin(0.02));
  const double energy = pi / 4 * (0.3 * 0.3 + 4 * 0.1 * 0.1);
  CHECK(m["least"].get<double>() == Approx(energy).epsilon(1e-3));
  CHECK(m["most"].get<double>() == Approx(energy).epsilon(1e-3));
  CHECK(m["least"].get<double>() <= m["most"].get<double>());
}

TEST_CASE("a run in parts has the passages, lines and returns of the whole") {
  const std::string keys =
      "kink --lattice.sites=63 --output.every=3 '--measure.t=crossing_time(15, pi, 1)' '--measure.l=spectral_line(15, 1, 20)' "
      "'--measure.m=mode_return(1, 5)' '--measure.e=energy_maximum' ";
  const Folder whole, parts;
  REQUIRE(measured(whole, keys, "--run.until=20").code == 0);
  REQUIRE(measured(parts, keys, "--run.until=9").code == 0);
  const Ran on = delf_program(parts, "resume out --run.until=20");
  INFO(on.err);
  REQUIRE(on.code == 0);
  const auto of = [](const Folder& folder) {
    return nlohmann::json::parse(read(folder / "out/summary.json"))["measures"];
  };
  CHECK(of(whole) == of(parts));
}

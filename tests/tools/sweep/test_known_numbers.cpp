// SPDX-License-Identifier: MIT
// Scenes against the numbers in their heads: published, or of programs that share nothing with delf.
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

Json summary_of(const std::string& command) {
  const Folder folder;
  const Ran ran = delf_program(folder, "run " + command + " --output.figures=off --output.fields=off --out out");
  INFO(command << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(read(folder / "out/summary.json"));
}

struct Known {
  std::string command, number;
  double value, margin;
};

// A number of summary.json, or a measure.
void check(const Known& known) {
  const Json summary = summary_of(known.command);
  const Json number = summary.contains(known.number) ? summary[known.number] : summary["measures"][known.number];
  INFO(known.command << ": " << known.number);
  CHECK(number.get<double>() == Approx(known.value).margin(known.margin));
}

}  // namespace

TEST_CASE("kinks and breathers have the energies 8 gamma and 16 eta") {
  // errors of second order, of relative size k² at most
  for (const double v : {0.0, 0.5, 0.8}) {
    const double energy = 8 / std::sqrt(1 - v * v);
    check({"kink --run.until=1 --lattice.sites=511 --initial.speed=" + std::to_string(v), "energy_final", energy,
           1e-3 * energy});
  }
  for (const double omega : {0.3, 0.6, 0.9}) {
    const double energy = 16 * std::sqrt(1 - omega * omega);
    check(
        {"breather --run.until=1 --lattice.length=60 --lattice.sites=1024 --initial.frequency=" + std::to_string(omega),
         "energy_final", energy, 1e-3 * energy});
  }
}

TEST_CASE("the errors of the breather at 400 and at 800 sites are those of its scene") {
  check({"breather --lattice.sites=400", "error_linf", 0.1587, 2e-4});
  check({"breather --lattice.sites=800", "error_linf", 0.03938, 5e-5});
}

TEST_CASE("a kink at rest on a lattice has the energy of its saddle on a site, and less between two") {
  const std::string scene = "peierls-barrier ";
  check({scene, "energy_final", 7.891928862, 1e-7});
  check({scene + "--initial.position=20.5", "energy_final", 7.866564707, 1e-7});
  check({scene + "--lattice.length=60 --initial.position=30", "energy_final", 7.881716463, 1e-7});
  check({scene + "--lattice.length=60 --initial.position=30.75", "energy_final", 7.501852912, 1e-7});
  check({scene + "--lattice.length=80 --initial.position=40", "energy_final", 8.073168347, 1e-6});
  check({scene + "--lattice.length=80 --initial.position=41", "energy_final", 6.838472554, 1e-6});
}

TEST_CASE("kinks on coarse lattices go as far as an independent leapfrog takes them") {
  const std::string scene = "peierls-nabarro ";
  check({scene + "--initial.speed=0.3", "place", 20.1974938, 1e-6});
  check({scene + "--lattice.length=120 --lattice.sites=121 --initial.speed=0.25 --run.until=200", "place", 54.151723,
         1e-5});
  check(
      {scene + "--lattice.length=120 --lattice.sites=121 --initial.speed=0.05 --initial.position=20.5 --run.until=200",
       "place", 20.52847199, 1e-6});
}

TEST_CASE("a discrete breather comes back after 100 periods, and has none at a strong coupling") {
  const Json weak = summary_of("discrete-breather")["measures"];
  CHECK(weak["omega"].get<double>() == Approx(0.8).epsilon(1e-4));
  CHECK(weak["middle"].get<double>() == Approx(2.0442594).margin(1e-4));
  CHECK(weak["far"].get<double>() < 1e-5);
  const Json strong = summary_of("discrete-breather --theory.c=0.5")["measures"];
  CHECK(strong["middle"].get<double>() < 1);
  CHECK(strong["far"].get<double>() > 0.1);
}

TEST_CASE("ripples on a plane wave grow at the rate of the linear theory") {
  for (const auto& [K, rate] : {std::pair{"0.5", 0.2522216}, {"0.75", 0.2785611}, {"1", 0.1597109}}) {
    const Json m = summary_of(std::string("modulational-instability --theory.K=") + K)["measures"];
    INFO(K);
    CHECK(m["formula"].get<double>() == Approx(rate).epsilon(1e-6));
    CHECK(m["rate"].get<double>() == Approx(rate).epsilon(1e-3));
  }
}

TEST_CASE("the lowest mode of the Fermi-Pasta-Ulam chain comes back") {
  const Json back = summary_of("fermi-pasta-ulam")["measures"],
             away = summary_of("fermi-pasta-ulam --run.until=4000")["measures"];
  // 0.981 at t = 9376 of an integrator of order four; leapfrog's phase has an error of second order
  CHECK(back["share1"].get<double>() == Approx(0.981).margin(0.001));
  CHECK(away["share1"].get<double>() < 0.15);
  CHECK(away["share2"].get<double>() + away["share3"].get<double>() > 0.6);
}

TEST_CASE("a gas of solitons keeps all of them, and one of phi4 does not") {
  // 836.0972: the sum of 8γ over the speeds that the seed draws, by a program of ten lines
  const std::string gas = "soliton-gas --lattice.sites=20000 --output.every=200 ";
  const Json sine_gordon = summary_of(gas), phi4 = summary_of(gas + "--theory.name=phi4 --theory.lambda=2");
  CHECK(sine_gordon["measures"]["number"] == 100);
  CHECK(sine_gordon["measures"]["charge"] == 0);
  CHECK(sine_gordon["energy_final"].get<double>() == Approx(836.0972).epsilon(2e-3));
  CHECK(phi4["measures"]["number"].get<double>() < 90);
  CHECK(phi4["measures"]["charge"] == 0);
}

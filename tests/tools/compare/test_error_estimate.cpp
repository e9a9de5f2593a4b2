// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/outcome/error_estimate.hpp"

using namespace delf;
using namespace delf::testing;
using Json = nlohmann::json;

namespace {

Json summary_of(const Folder& folder, const std::string& scene, const std::string& more) {
  const Ran ran = delf_program(folder, "run " + scene + " --output.figures=off --output.fields=off --out out " + more);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  return Json::parse(read(folder / "out/summary.json"));
}

}  // namespace

TEST_CASE("Richardson's estimate is that of a power of h, and is none where differences do not fall") {
  // y = 1 + 3hᵖ at h = 1, ½, ¼
  for (const double p : {1.0, 2.0, 4.0, 6.0}) {
    const double half = std::exp2(-p), quarter = std::exp2(-2 * p);
    const Richardson r = richardson(3 * (1 - half), 3 * (half - quarter), 1);
    CHECK(r.converging);
    CHECK(r.order == Approx(p));
    CHECK(r.error == Approx(3));
  }
  CHECK_FALSE(richardson(0.1, 0.1, 1).converging);
  CHECK_FALSE(richardson(0.1, 0.2, 1).converging);
  CHECK(std::isnan(richardson(0.1, 0.2, 1).error));
  CHECK_FALSE(richardson(NAN, 0.1, 1).converging);
  // rounding is no error to speak of
  CHECK(richardson(1e-16, 3e-16, 1).error <= 3e-16);
}

TEST_CASE("the estimate is within a factor of two of the true error, for schemes of order 2, 4 and 6") {
  const Folder folder;
  struct Case {
    std::string scene;
    double order;
  };
  const std::vector<Case> cases{
      {"kink --run.until=5 --lattice.sites=101", 2},
      {"breather --run.until=5 --lattice.sites=101", 2},
      {"breather --run.until=5 --lattice.sites=101 --lattice.stencil=triangle", 2},
      {"breather --run.until=5 --lattice.sites=102 --lattice.stencil=hexagon", 2},
      {"phi4-kink --run.until=5 --lattice.sites=101", 2},
      {"phi6-kink --run.until=5 --lattice.sites=101", 2},
      {"wave-packet --run.until=5", 2},
      {"breather --run.until=5 --lattice.sites=100 --scheme.method=composition "
       "--scheme.order=4 --lattice.space_order=4",
       4},
      {"breather --run.until=5 --lattice.length=80 --lattice.sites=480 --lattice.courant=0.35 "
       "--scheme.method=processed --scheme.kernel=ti4 --lattice.space_order=10",
       4},
      {"breather --run.until=5 --lattice.sites=140 --scheme.method=composition "
       "--scheme.order=6 --lattice.space_order=6",
       6},
      {"kink-train --run.until=5 --lattice.sites=101", 2}};
  for (const Case& c : cases) {
    const Json s = summary_of(folder, c.scene, "--output.estimate=on");
    INFO(c.scene << "\n" << s["error_estimate"].dump() << "\n" << s["error_linf"].dump());
    REQUIRE(s["error_estimate"]["converging"] == true);
    const double ratio = s["error_estimate"]["error"].get<double>() / s["error_linf"].get<double>();
    CHECK(ratio > 0.5);
    CHECK(ratio < 2);
    CHECK(s["error_estimate"]["order"].get<double>() == Approx(c.order).margin(0.25 * c.order));
  }
}

TEST_CASE("measures are estimated too, and what does not converge is called so") {
  const Folder folder;
  Json s = summary_of(folder, "kink", "--run.until=5 --output.estimate=on '--measure.v=speed(1)' --measure.n=kinks");
  const double v = s["measures"]["v"].get<double>();
  const auto exact = 0.5;
  CHECK(std::abs(v - exact) < 0.02);
  CHECK(s["error_estimate"]["measures"]["n"]["error"] == 0);
  CHECK(s["error_estimate"]["measures"].contains("v"));
  // chaos: kinks that are captured, and bounce some ten times
  s = summary_of(folder, "phi4-collision", "--initial.speed=0.21 --lattice.sites=800 --output.estimate=on");
  CHECK(s["error_estimate"]["converging"] == false);
  CHECK(s["error_estimate"]["error"].is_null());
  CHECK(contains(read(folder / ".out"), "not converging"));
  CHECK_FALSE(summary_of(folder, "kink", "--run.until=1").contains("error_estimate"));
}

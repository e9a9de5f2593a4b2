// SPDX-License-Identifier: MIT
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/stability/point_limits.hpp"
#include "tools/stability/stability_request.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

PointFinding found(const std::string& tableau, int functions = 0, int points = 0) {
  Problem p;
  p.method = "cgvi", p.lattice = Lattice::point();
  if (functions == 0) p.parameters["scheme.tableau"] = tableau;
  else {
    p.parameters["scheme.functions"] = functions, p.parameters["scheme.points"] = points;
    p.parameters["scheme.quadrature"] = tableau;
  }
  return find_point_limit({tableau, p}, {.schemes = {}, .most = 6, .steps = 500});
}

}  // namespace

TEST_CASE("limits of elements of time in ωh are those of theory, by theory and by running") {
  struct Known {
    PointFinding finding;
    double limit, order;
  };
  for (const Known& known : {Known{found("stormer-verlet"), 2, 2}, Known{found("lobatto3"), std::sqrt(8.0), 4},
                             Known{found("gauss", 2, 2), std::sqrt(12.0), 2}}) {
    const PointFinding& f = known.finding;
    CAPTURE(f.scheme, f.theory, f.observed, f.order);
    CHECK(std::abs(f.theory - known.limit) < 1e-4 * known.limit);
    CHECK(std::abs(f.observed - known.limit) < 0.01 * known.limit);
    CHECK(f.agrees);
    CHECK(std::abs(f.order - known.order) < 0.15);
    CHECK(f.microseconds > 0);
  }
  // stable again: 3.464 to 4.899
  const PointFinding lobatto = found("lobatto3");
  REQUIRE(lobatto.stable.size() == 2);
  CHECK(std::abs(lobatto.stable[1].first - std::sqrt(12.0)) < 1e-4);
  CHECK(std::abs(lobatto.stable[1].second - std::sqrt(24.0)) < 1e-4);
  CHECK(std::isinf(found("gauss2").theory));
}

TEST_CASE("discontinuous elements are measured in phase space, with both of their traces") {
  // S = 1 … 4 are stable below ωh = 1, 4, 2.3, 4.8
  const double limits[] = {1, 4, 2.3, 4.8};
  for (int S = 1; S <= 3; ++S) {
    Problem p;
    p.method = "dgvi", p.lattice = Lattice::point();
    p.parameters["scheme.functions"] = S, p.parameters["scheme.points"] = S;
    const PointFinding f = find_point_limit({"dgvi", p}, {.schemes = {}, .most = 6, .steps = 500});
    CAPTURE(S, f.theory, f.observed, f.order, f.left_out);
    CHECK(std::abs(f.theory - limits[S - 1]) < 0.05 * limits[S - 1]);
    CHECK(f.agrees);
    CHECK(std::abs(f.order - (S % 2 == 1 ? 2 * S : 2 * S - 2)) < 0.3);
  }
}

TEST_CASE("the table of mechanics is written, a planted limit is found, and unknown schemes are refused") {
  const Folder folder;
  const std::string run =
      "stability pendulum --stability.steps=300 --stability.schemes=\"trapezoidal, cgvi lobatto2\" ";
  const Ran ran = delf_program(folder, run + "--out out");
  INFO(ran.out << ran.err);
  REQUIRE(ran.code == 0);
  CHECK(contains(ran.out, "3 of 3 limits agree"));
  CHECK(contains(read(folder / "out/methods.md"), "| cgvi lobatto2 | 2.0"));
  const auto json = nlohmann::json::parse(read(folder / "out/stability.json"));
  REQUIRE(json["point_limits"].size() == 3);
  CHECK(std::abs(json["point_limits"][1]["theory"].get<double>() - 2) < 1e-4);
  CHECK(delf_program(folder, run + "--stability.fault=limit --out fault").code == 1);
  check_refused(delf_program(folder, "stability pendulum --stability.schemes=,"),
                {"stability.schemes = ,: names nothing"});
  check_refused(delf_program(folder, "stability kink --stability.corners=,"), {"stability.corners = ,: names nothing"});
  check_refused(delf_program(folder, "stability pendulum --stability.schemes=lobato3"),
                {"stability.schemes", "lobato3"});
}

TEST_CASE("a scheme that is named again is listed once") {
  const Folder folder;
  const Ran ran = delf_program(folder,
                               "stability pendulum --stability.steps=100 --out out "
                               "--stability.schemes='trapezoidal, midpoint, midpoint, trapezoidal'");
  CHECK(ran.code == 0);
  CHECK(contains(ran.out, "2 of 2 limits agree"));
  const Problem base;
  CHECK(chosen_schemes({"triangle", "guo", "triangle"}, base).size() == 2);
}

TEST_CASE("an interrupted table of mechanics is written as far as it is") {
  const Folder folder;
  const Ran ran = shell(folder, "'" + program_path() +
                                "' stability pendulum --stability.steps=100000 --out cut & "
                                "p=$!; sleep 0.8; kill -INT $p; wait $p");
  INFO(ran.err << ran.out);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "not finished (interrupted): "));
  CHECK(nlohmann::json::parse(read(folder / "cut/stability.json")).contains("point_limits"));
}

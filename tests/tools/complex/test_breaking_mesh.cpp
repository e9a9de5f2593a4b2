// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

struct Broken {
  nlohmann::json summary;
  std::vector<std::string> lines;  ///< of series.csv
  std::string err;
};

/// Steps of a wave map on a mesh that are too long for Newton's method.
Broken broken(const std::string& keys) {
  const Folder folder;
  const Ran ran = delf_program(folder, "run turning-soliton --out out --output.figures=off " + keys);
  CAPTURE(ran.out, ran.err);
  CHECK(ran.code == 3);
  return {nlohmann::json::parse(read(folder / "out/summary.json")), lines(read(folder / "out/series.csv")), ran.err};
}

}  // namespace

TEST_CASE("a run on a mesh that breaks leaves the last good row, and row 0 if there is no other") {
  const Broken later = broken("--lattice.time_step=0.7 --output.every=10");
  REQUIRE(later.lines.size() == 3);
  CHECK(later.lines[1].starts_with("0,0,"));
  CHECK(later.lines[2].starts_with("2,1.4,"));
  CHECK(later.summary["status"] == "no-convergence");
  CHECK(later.summary["steps"] == 2);
  CHECK(later.summary["break_time"].get<double>() == Approx(2.1));
  CHECK(later.summary["break_reason"] == "no-convergence");
  CHECK(contains(later.err, "row 2 is the last good one, and is saved"));

  const Broken at_once = broken("--lattice.time_step=5");
  REQUIRE(at_once.lines.size() == 2);
  CHECK(at_once.lines[1].starts_with("0,0,"));
  CHECK(at_once.summary["steps"] == 0);
  CHECK(at_once.summary["break_time"] == 5);
  CHECK(contains(at_once.err, "row 0 is the last good one, and is saved"));

  // the last good row is the one that a run without a break has there
  const Folder folder;
  REQUIRE(delf_program(folder, "run turning-soliton --out out --lattice.time_step=0.7 --run.until=1.4").code == 0);
  const std::string whole = lines(read(folder / "out/series.csv")).back();
  CHECK(whole.substr(0, 40) == later.lines[2].substr(0, 40));
}

// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/verify/verdict.hpp"
#include "tools/verify/verdict_figures.hpp"

using namespace delf::testing;
using namespace delf;

namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

Scene scene() {
  Scene made{Settings("collision.ini", {}, {})};
  made.name = "collision";
  made.problem.time_step = 0.02;
  return made;
}

std::string json_of(const Verdict& v) { return verdict_json(subject_of(scene().problem), scene(), v); }
std::string report_of(const Verdict& v) { return verdict_report(subject_of(scene().problem), scene(), v); }

Verdict verdict() {
  Verdict v;
  v.checks = {{"form formula", "a staircase of 31 sites, rows 812 … 819, local V, W", 3e-15, 1e-13, 2.5, 114, 400},
              {"equations", "site 31, row 99", 4e-4, 1e-12, 1, 7, 16000,
               "The rows do not solve the equations at site 31 of row 99. " + std::string(150, 'x') + " end"},
              {"derivatives", "", not_a_number, 1e-9, 1, 0, 10}};
  v.measured = {{"energy", "rows 0 … 1600", 3e-6, 1, 255, 1.998, "no theorem promises it"},
                {"Θˡ in the vacuum", "", 1e-7}};
  v.left_out = {"noether: no symmetry is declared"};
  v.points = {{"rectangle", 12, 0, true}, {"staircase", 300, 3e-15, false}, {"the user's_own", 30, not_a_number, true}};
  v.worst = {"a staircase",
             {{812, 3, 0, true, false, 0}, {813, 3, 0, false, true, 0.1}, {813, 4, 0, false, true, not_a_number}},
             3e-15};
  v.map = {{0.5, 1.5}, {0, 1, 2}, {not_a_number, -16, -15.5, INFINITY, -INFINITY, -16}};
  v.severity = v.map;
  v.severest = {{3, "phi", 99, 4e-4, 1e-3, 1e-16}, {4, "phi", 7, 1e-17, 1e-3, 1e-16}};
  v.energy = {"an energy", "its formula", {0, 0.5, 1}, {2, 2 + 1e-15, 2}};
  v.reversal = {{1, 10, 100}, {0, 1e-16, 1e-15}};
  v.seed = 7;
  v.stencils = 25500;
  v.subject = "rows computed here";
  return v;
}

Verdict good_verdict() {
  Verdict v = verdict();
  v.checks.resize(1);
  return v;
}

}  // namespace

TEST_CASE("a verdict passes if every check of a finished one does, and never without a check") {
  CHECK_FALSE(verdict().passed());
  Verdict v = good_verdict();
  CHECK(v.passed());
  v.status = "interrupted";
  CHECK_FALSE(v.passed());
  CHECK_FALSE(Verdict{}.passed());
}

TEST_CASE("verify.json has every check with all that it is made of") {
  const auto json = nlohmann::json::parse(json_of(verdict()));
  for (const char* key : {"version", "scene", "theory", "stencil", "method", "sites", "time_step", "seed", "subject",
                          "status", "seconds", "stencils", "passed", "measured", "left_out", "regions", "reversal"}) {
    INFO(key);
    REQUIRE(json.contains(key));
    CHECK_FALSE(json[key].is_null());
  }
  CHECK(json["passed"] == false);
  CHECK(json["seed"] == 7);
  REQUIRE(json["checks"].size() == 3);
  const auto& first = json["checks"][0];
  CHECK(first["name"] == "form formula");
  CHECK(first["value"] == 3e-15);
  CHECK(first["tolerance"] == 1e-13);
  CHECK(first["normaliser"] == 2.5);
  CHECK(first["count"] == 114);
  CHECK(first["samples"] == 400);
  CHECK(first["passed"] == true);
  CHECK(first["failure"].is_null());
  CHECK(contains(json["checks"][1]["failure"], "site 31 of row 99"));
  CHECK(json["measured"][0]["order"] == 1.998);
  CHECK(json["left_out"][0] == "noether: no symmetry is declared");
  CHECK(json["regions"][0]["variations"] == "local");
  CHECK(json["regions"][1]["variations"] == "evolved");
  CHECK(json["reversal"]["steps"] == std::vector{1, 10, 100});
  CHECK(json["reversal"]["distance"][2] == 1e-15);
}

TEST_CASE("what is not a number is null in verify.json, and has failed") {
  const auto json = nlohmann::json::parse(json_of(verdict()));
  CHECK(json["checks"][2]["value"].is_null());
  CHECK(json["checks"][2]["passed"] == false);
  CHECK(json["measured"][1]["order"].is_null());
  CHECK(json["regions"][2]["value"].is_null());
}

TEST_CASE("the report of a verdict says which checks failed, and in what words, within 120 columns") {
  const std::string report = report_of(verdict());
  INFO(report);
  CHECK(contains(report, "FAILED: equations\n  The rows do not solve the equations at site 31 of row 99.\n"));
  CHECK(contains(report, "FAILED: derivatives\n"));
  CHECK(contains(report, "measured, not promised"));
  CHECK(contains(report, "2.00"));
  CHECK(contains(report, "noether: no symmetry is declared"));
  CHECK(lines(report).back() == "FAILED: 2 of 3 checks");
  CHECK_FALSE(contains(report_of(good_verdict()), "FAILED"));
  CHECK(lines(report_of(good_verdict())).back() == "passed: 1 of 1 checks");

  Verdict wide = verdict();
  for (Check& check : wide.checks) {
    check.name = "the form formula on regions that are given by hand, for all of the variations";
    check.region += " and what is known about a region of which a lot is known: rows, sites, holes and walls";
    check.count = 123456789012;
  }
  wide.subject = "rows of /" + std::string(200, 'p');
  for (const Verdict& v : {verdict(), wide})
    for (const std::string& line : lines(report_of(v))) {
      INFO(line);
      CHECK(columns_of(line) <= 120);
      CHECK_FALSE(line.ends_with(' '));
    }
}

TEST_CASE("a verdict that was interrupted does not end as one that passed") {
  Verdict v = good_verdict();
  v.status = "interrupted";
  CHECK(lines(report_of(v)).back() == "not finished (interrupted): 1 of 1 checks passed so far");
  CHECK(lines(report_of(Verdict{})).back() == "FAILED: there was nothing to check");
}

TEST_CASE("text is wrapped at blanks, by columns and not by bytes, and words that are too long are broken") {
  CHECK(wrapped("a bc  def", 4) == std::vector<std::string>{"a bc", "def"});
  CHECK(wrapped("φφφ φφφφφ", 3) == std::vector<std::string>{"φφφ", "φφφ", "φφ"});
  CHECK(wrapped(" \n", 4).empty());
  CHECK(shortened("φφφφ", 4) == "φφφφ");
  CHECK(shortened("φφφφφ", 4) == "φφφ…");
}

TEST_CASE("the figures of a verdict are drawn as PNG and as SVG, and those without data are not") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  CHECK(draw_verdict(verdict(), "the user's", "hexagon, N = 254", {}, folder.path()).empty());
  CHECK(verdict_figure_names().size() == 6);
  for (const std::string& name : verdict_figure_names()) {
    INFO(name);
    CHECK(read(folder / ("figures/" + name + ".png")).starts_with("\x89PNG"));
    const std::string svg = read(folder / ("figures/" + name + ".svg"));
    CHECK(contains(svg, "<svg"));
    CHECK(contains(svg, "</svg>"));
  }

  const Folder empty;
  CHECK(draw_verdict(Verdict{}, "nothing", "", {}, empty.path()).empty());
  CHECK_FALSE(std::filesystem::exists(empty / "figures"));
  Verdict one;
  one.map = {{0.5, 1.5}, {0}, {-16, not_a_number}};  // a point: time alone
  one.worst.sites = {{0, 0, 5, true, true, 0}};
  CHECK(draw_verdict(one, "pendulum", "midpoint", {}, empty.path()).empty());
  CHECK(std::filesystem::exists(empty / "figures/residual-map.png"));
  CHECK(std::filesystem::exists(empty / "figures/worst-region.png"));
  CHECK_FALSE(std::filesystem::exists(empty / "figures/time-reversal.png"));
}

TEST_CASE("a boundary site is a ring, and a bar where sites are too dense for rings") {
  const Folder folder;
  Verdict v;
  const auto drawn = [&] { return worst_region_figure({v, "kdv", ""}, folder.path()); };
  for (int i = 0; i < 9; ++i) v.worst.sites.push_back({12557, i, 0, false, true, 0.1});
  const std::string rings = drawn();
  CHECK(contains(rings, "'holes' using"));
  CHECK_FALSE(contains(rings, "boxxyerror"));
  CHECK(contains(rings, "set lmargin at screen 0.117"));  // beside numbers of five digits
  for (int i = 9; i < 161; ++i) v.worst.sites.push_back({12557, i, 0, false, true, 0.1});
  const std::string bars = drawn();
  CHECK_FALSE(contains(bars, "'holes' using"));
  CHECK(contains(bars, "'rings' using 1:2:"));
  CHECK(contains(bars, "boxxyerror"));
  for (DrawnSite& s : v.worst.sites) s.time = 7;
  CHECK(contains(drawn(), "set lmargin at screen 0.105"));
}

TEST_CASE("failures that differ in numbers alone are explained once") {
  Verdict v;
  v.checks = {{"form formula, slab", "", 1, 1e-13, 1, 1, 1, "At row 12 it is -8.06e-07."},
              {"equations", "", 1, 1e-13, 1, 1, 1, "Site 3 is wrong."},
              {"form formula, hole", "", 1, 1e-13, 1, 1, 1, "At row 5090 it is 3."}};
  const std::string report = report_of(v);
  CHECK(contains(report,
                 "FAILED: form formula, slab\nFAILED: form formula, hole\n  At row 12 it is -8.06e-07.\n  This is"));
  CHECK_FALSE(contains(report, "At row 5090"));
  CHECK(contains(report, "FAILED: equations\n  Site 3 is wrong.\n\n"));
}

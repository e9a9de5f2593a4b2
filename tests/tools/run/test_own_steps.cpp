// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

const std::string own = "--lattice.time_steps=reversible ";
const std::string bounce = "soliton-bounce --lattice.sites=17 --output.figures=off --scheme.time=trapezoid " + own;

Json summary(const Folder& folder, const std::string& out) {
  return Json::parse(read(folder / (out + "/summary.json")));
}

}  // namespace

TEST_CASE("steps that the rows of a moving mesh choose run, end by time, and run again to the same bits") {
  const Folder folder;
  const std::string keys = bounce + "--lattice.time_step=0.05 --output.every=7 ";
  const Ran ran = delf_program(folder, "run " + keys + "--run.until=2 --out out");
  CAPTURE(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(contains(ran.out, "long, chosen by the field"));
  const Json json = summary(folder, "out");
  CHECK(json["time"].get<double>() >= 2);
  CHECK(json["time"].get<double>() < 2 + json["time_step_max"].get<double>());
  CHECK(json["time_step_max"] < 0.05);
  CHECK(json["steps"].get<int>() > 2 / json["time_step_max"].get<double>());
  // times of series.csv: of every seventh row, and of the last
  const auto rows = lines(read(folder / "out/series.csv"));
  REQUIRE(rows.size() > 4);
  CHECK(rows[2].starts_with("7,"));
  CHECK(std::stod(rows[2].substr(2)) < 7 * 0.05);
  CHECK(std::stod(rows.back().substr(rows.back().find(',') + 1)) == json["time"].get<double>());

  REQUIRE(delf_program(folder, "run out/scene.ini --out again").code == 0);
  CHECK(read(folder / "again/series.csv") == read(folder / "out/series.csv"));
  REQUIRE(delf_program(folder, "run " + keys + "--run.until=1 --out short").code == 0);
  REQUIRE(delf_program(folder, "resume short --run.until=2").code == 0);
  CHECK(read(folder / "short/series.csv").find(rows.back()) != std::string::npos);
  CHECK(summary(folder, "short")["time_step_min"] == json["time_step_min"]);
  REQUIRE(delf_program(folder, "run " + keys + "--run.steps=9 --out nine").code == 0);
  CHECK(summary(folder, "nine")["steps"] == 9);
}

TEST_CASE("rows whose steps were chosen are verified as they are, computed or recorded, and go back") {
  const Folder folder;
  const std::string keys = bounce + "--lattice.time_step=0.05 --run.until=1 ";
  const Ran verified = delf_program(folder, "verify " + keys + "--out v");
  CAPTURE(verified.out, verified.err);
  CHECK(verified.code == 0);
  for (const char* part : {"time reversal", "form formula", "not symplectic"}) CHECK(contains(verified.out, part));
  for (const char* fault : {"field", "sign", "variation"})
    CHECK(delf_program(folder, "verify " + keys + "--out w --verify.fault=" + fault).code == 1);
  REQUIRE(delf_program(folder, "run " + keys + "--output.every=1 --out out").code == 0);
  CHECK(delf_program(folder, "verify " + keys + "--fields out/fields.h5 --out of").code == 0);
  CHECK(delf_program(folder,
                     "verify soliton-bounce --lattice.sites=17 --scheme.time=trapezoid --lattice.time_step=0.05 "
                     "--fields out/fields.h5 --out uniform")
            .code == 2);
}

TEST_CASE("where steps cannot be chosen, the key says so") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& why) {
    const Ran ran = delf_program(folder, arguments);
    CAPTURE(ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, why));
  };
  refused("run kink " + own, "scheme.method = multisymplectic has steps of one length; use scheme.method = r-adaptive");
  refused("run soliton-bounce --lattice.step_control=2", "has no effect without lattice.time_steps = reversible");
  refused("run soliton-bounce " + own + "--initial.start=exact", "use legendre");
}

TEST_CASE("rows whose steps were chosen are refused where some were recorded, or steps are to be equal") {
  const Folder folder;
  const std::string keys = bounce + "--lattice.time_step=0.05 ";
  REQUIRE(delf_program(folder, "run " + keys + "--run.until=0.5 --output.every=3 --out out").code == 0);
  const std::string fields = "--fields out/fields.h5 --out v";
  check_refused(delf_program(folder, "verify " + keys + fields),
                {"--fields out/fields.h5: was recorded with output.every = 3", "record every row (output.every = 1)"});
  check_refused(delf_program(folder,
                             "verify soliton-bounce --lattice.sites=17 --scheme.time=trapezoid "
                             "--lattice.time_step=0.05 " +
                                 fields),
                {"was made with lattice.time_steps = reversible", "use --lattice.time_steps=reversible"});
  // rows that do not say how they were recorded
  const Ran without = shell(folder, python(folder) +
                                        " - <<'END'\n"
                                        "import h5py\n"
                                        "del h5py.File('out/fields.h5', 'r+').attrs['scene']\n"
                                        "END");
  REQUIRE(without.code == 0);
  check_refused(delf_program(folder, "verify " + keys + fields), {"of 3 rows one was recorded"});
}

TEST_CASE("a run goes on from rows whose steps were chosen, by steps that the field chooses") {
  const Folder folder;
  // positions are fields of the one, and slaved to the fields in the other
  const auto strategy = GENERATE(as<std::string>(), "multiplier", "control");
  const std::string keys = "--scheme.strategy=" + strategy;
  REQUIRE(delf_program(folder,
                       "run " + bounce + "--lattice.time_step=0.05 --output.every=1 --run.steps=30 --out whole " + keys)
              .code == 0);
  folder.write("next.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 25\nsites = 17\ntime_step = 0.05\n"
               "[scheme]\nmethod = r-adaptive\ntime = trapezoid\n[mesh]\nalpha = 2.5\n"
               "[initial]\nstate = file\nfile = whole/fields.h5\nframe = 12\n[run]\nsteps = 18\n"
               "[output]\nevery = 1\nfigures = off\n");
  const Ran rest = delf_program(folder, "run next.ini --out rest " + own + keys);
  INFO(rest.err);
  REQUIRE(rest.code == 0);
  const delf::FieldsReader a(folder / "whole/fields.h5"), b(folder / "rest/fields.h5");
  const auto there = a.row(30), here = b.row(18);
  REQUIRE(there.size() == here.size());
  double largest = 0;
  for (std::size_t i = 0; i < here.size(); ++i) largest = std::max(largest, std::abs(here[i] - there[i]));
  CHECK(largest < 1e-9);
  CHECK(*b.time(18) == Approx(*a.time(30) - *a.time(12)).epsilon(1e-10));

  check_refused(delf_program(folder, "run next.ini --out no --lattice.step_control=5 " + own + keys),
                {"next.ini:16: initial.frame = 12: frames 12 and 13 of the file are",
                 "and the field there chooses steps", "use lattice.time_step and lattice.step_control of the file"});
  check_refused(delf_program(folder, "run next.ini --out no " + keys),
                {"next.ini:16: initial.frame = 12: frames 12 and 13 of the file are",
                 "the time step is 0.05; use lattice.time_step = 0.0", "lattice.time_steps = reversible if"});
}

TEST_CASE("a strength that makes every step tiny, and a step out of all range, are refused by what they mean") {
  const Folder folder;
  const std::string run = "run " + bounce + "--run.steps=3 --out out --lattice.time_step=";
  check_refused(delf_program(folder, run + "0.05 --lattice.step_control=1e5"),
                {"--lattice.step_control = 1e5: makes the first step", "use s of 0.1 to 10"});
  check_refused(delf_program(folder, run + "0.05 --lattice.step_control=1e9"), {"must be at most 1000000"});
  check_refused(delf_program(folder, run + "0.05 --lattice.step_control=-1"), {"must be above 0"});
  check_refused(delf_program(folder, run + "0.05 --lattice.step_control=nan"), {"is not a finite number"});
  check_refused(delf_program(folder, run + "1e200"), {"--lattice.time_step = 1e200", "overflow double precision"});
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
  // too long a step breaks, and leaves row 0
  const Ran broken = delf_program(folder, run + "10");
  CHECK(broken.code == 3);
  CHECK(lines(broken.err).size() == 1);
  CHECK(summary(folder, "out")["records"] == 1);
  CHECK(lines(read(folder / "out/series.csv")).size() == 2);
}

TEST_CASE("an estimate of the error is refused before the run where other runs have other rows") {
  const Folder folder;
  const std::string estimate = "--output.estimate=on --run.until=0.2 --out out";
  check_refused(delf_program(folder, "run " + bounce + estimate),
                {"--output.estimate = on: reversible steps end at times of their own", "delf convergence"});
  check_refused(delf_program(folder, "run soliton-bounce " + estimate), {"sites move"});
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("the report of a moving mesh begins with the limit of its step") {
  const Folder folder;
  const std::string few = "run soliton-bounce --run.steps=3 --output.figures=off --out out ";
  CHECK(contains(delf_program(folder, few).out,
                 "limit      h below 0.0764, 0.816 of the narrowest cell, which is 0.0936"));
  CHECK(contains(delf_program(folder, few + "--scheme.time=trapezoid").out, "0.577 of the narrowest cell"));
  for (const char* unlimited : {"--scheme.time=midpoint", "--scheme.strategy=uniform"})
    CHECK_FALSE(contains(delf_program(folder, few + unlimited).out, "  limit "));
  CHECK_FALSE(contains(delf_program(folder, "run kink --run.steps=3 --output.figures=off --out kink").out, "  limit "));
}

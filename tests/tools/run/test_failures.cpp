// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using delf::FieldsReader;

namespace {

std::string status(const Folder& folder, const std::string& results) {
  return nlohmann::json::parse(read(folder / (results + "/summary.json")))["status"];
}

}  // namespace

TEST_CASE("a blow-up ends with exit code 3, its step, time and site, and the last finite state saved") {
  const Folder folder;
  const auto every = GENERATE(as<std::string>(), "1", "1000", "0");
  const Ran ran = delf_program(folder,
                               "run collision --lattice.stencil=triangle --lattice.courant=1.2 --run.until=400 "
                               "--output.figures=off --out up --output.every=" +
                                   every);
  INFO(ran.err);
  CHECK(ran.code == 3);
  REQUIRE(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "step "));
  CHECK(contains(ran.err, "t = "));
  CHECK(contains(ran.err, "site "));
  CHECK(status(folder, "up") == "not-finite");

  const auto json = nlohmann::json::parse(read(folder / "up/summary.json"));
  CHECK(json["failure"].is_string());
  const FieldsReader fields(folder / "up/fields.h5");
  const auto last = fields.row(fields.frames() - 1);  // throws unless finite
  CHECK(*fields.time(fields.frames() - 1) == json["time"]);
  CHECK(lines(read(folder / "up/series.csv")).back().starts_with(std::to_string(json["steps"].get<int>()) + ","));
}

TEST_CASE("an implicit step that cannot be solved ends with exit code 3") {
  const Folder folder;
  folder.write("hard.ini", small_scene());
  const Ran ran = delf_program(folder,
                               "run hard.ini --initial.state=noise --initial.amplitude=3 --theory.mass=40 "
                               "--lattice.stencil=rectangle --scheme.max_iterations=1 --out hard");
  INFO(ran.err);
  CHECK(ran.code == 3);
  CHECK(lines(ran.err).size() == 1);
  CHECK(status(folder, "hard") == "no-convergence");
  CHECK(lines(read(folder / "hard/series.csv")).size() >= 2);
}

TEST_CASE("rows that do not solve their equations are not recorded, and end with exit code 3") {
  const Folder folder;
  // a frequency at which products of rows lose all their digits, and one at which they do not
  const auto [mass, code] = GENERATE(table<std::string, int>({{"1e20", 3}, {"1", 0}}));
  const Ran ran = delf_program(folder,
                               "run breather --scheme.method=cgvi --initial.state=noise --initial.start=legendre "
                               "--run.steps=3 --output.figures=off --out lost --theory.mass=" +
                                   mass);
  INFO(ran.err);
  CHECK(ran.code == code);
  const auto json = nlohmann::json::parse(read(folder / "lost/summary.json"));
  CHECK(json["residual_max"] < 1e-12);
  CHECK(json["status"] == (code == 0 ? "done" : "no-convergence"));
  CHECK(contains(ran.err, "row 1 is the last good one that was recorded") == (code == 3));
}

TEST_CASE("an energy that is not finite ends a run with exit code 3, with the last good row saved") {
  const Folder folder;
  folder.write("log.ini",
               "[theory]\ndensity = 0.5*phi_t^2 + log(phi)\n[lattice]\nstencil = trapezoidal\nspace = point\n"
               "time_step = 0.5\n[initial]\nphi = 0.3\nphi_t = -4\n[run]\nsteps = 40\n[output]\nfigures = off\n");
  // φ jumps over the singularity in the first step, or in a later one; whatever is recorded
  const std::string keys = GENERATE(as<std::string>(), "", "--output.every=0", "--output.every=7",
                                    "--initial.phi=11 --initial.phi_t=-8 --output.every=1",
                                    "--initial.phi=11 --initial.phi_t=-8 --output.every=0");
  const Ran ran = delf_program(folder, "run log.ini --out out " + keys);
  INFO(keys << "\n" << ran.err);
  CHECK(ran.code == 3);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "the energy is not finite"));
  CHECK(contains(ran.err, "log(phi) has no value"));
  CHECK(status(folder, "out") == "not-finite");
  const FieldsReader fields(folder / "out/fields.h5");
  REQUIRE(fields.frames() > 0);
  CHECK(fields.frames() < 6);
  CHECK(fields.row(0)[0] > 0);
}

TEST_CASE("a wave map on a stencil with a staggered ghost is refused with exit code 2, and its plan names the ghost") {
  const Folder folder;
  const std::string symmetric =
      " wave-map --lattice.stencil=rectangle-symmetric --lattice.sites=16 --run.steps=4 "
      "--output.figures=off";
  const Ran ran = delf_program(folder, "run" + symmetric + " --out out");
  INFO(ran.err);
  CHECK(ran.code == 2);
  REQUIRE(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "lattice.stencil = rectangle-symmetric: waves near theta = pi, z = -1"));
  CHECK(contains(ran.err, "lattice.stencil = rectangle"));
  CHECK_FALSE(contains(ran.err, "reduce"));
  const Ran planned = delf_program(folder, "plan" + symmetric);
  CHECK(planned.code == 0);
  CHECK(contains(planned.out, "ghost        waves near theta = pi, z = -1"));
  CHECK(delf_program(folder, "run wave-map --lattice.sites=16 --run.steps=4 --output.figures=off --out out").code == 0);
}

TEST_CASE("a mesh that crosses itself ends with exit code 3, and the last mesh in order is saved") {
  const Folder folder;
  const Ran ran = delf_program(folder,
                               "run soliton-bounce --scheme.time=trapezoid --mesh.alpha=5 --lattice.sites=65 "
                               "--lattice.time_step=0.05 --output.every=1 --output.figures=off --out out");
  INFO(ran.err);
  CHECK(ran.code == 3);
  CHECK(contains(ran.err, "of the mesh pass each other"));
  CHECK(contains(ran.err, "apart, closer than any others"));
  CHECK(status(folder, "out") == "mesh-crossing");
  const auto summary = nlohmann::json::parse(read(folder / "out/summary.json"));
  CHECK(summary["break_reason"] == "mesh-crossing");
  CHECK(summary["break_time"].get<double>() == Approx(0.05 * (summary["steps"].get<double>() + 1)));
  CHECK(summary["mesh_min_spacing"] > 0);
  CHECK(summary["step_over_limit"] > 1);  // 0.577 of the narrowest cell
  CHECK(contains(summary["warnings"].dump(), "and should stay below 1"));
  const FieldsReader fields(folder / "out/fields.h5");
  const auto last = fields.row(fields.frames() - 1);  // phi, X site by site
  for (std::size_t n = 1; n + 2 < last.size(); n += 2) CHECK(last[n] < last[n + 2]);
}

TEST_CASE("a mesh that is not in order from the start is bad input") {
  const Folder folder;
  std::string rows = "row,site,phi,X\n";
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 5; ++i)
      rows += std::to_string(j) + "," + std::to_string(i) + ",0," + std::to_string(i == 2 && j == 1 ? 3.5 : i) + "\n";
  folder.write("rows.csv", rows);
  const std::string scene = folder.write("scene.ini",
                                         "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 4\n"
                                         "sites = 5\ntime_step = 0.01\n[scheme]\nmethod = r-adaptive\n"
                                         "[initial]\nstate = file\nfile = rows.csv\n[run]\nsteps = 3\n");
  const Ran ran = delf_program(folder, "run " + scene);
  INFO(ran.err);
  CHECK(ran.code == 2);
  CHECK(contains(ran.err, "sites 2 and 3 of the mesh are not in order in row 1"));
}

TEST_CASE("an interrupted run writes all so far, and ends with exit code 130") {
  const Folder folder;
  const auto signal = GENERATE(as<std::string>(), "INT", "TERM");
  const auto stencil = GENERATE(as<std::string>(), "rectangle-symmetric", "triangle-vertex");
  const Ran ran =
      shell(folder, "'" + program_path() +
                        "' run collision --run.until=1e7 --output.every=5000 --output.figures=off --out cut "
                        "--lattice.stencil=" +
                        stencil + " & p=$!; while [ ! -s cut/fields.h5 ]; do sleep 0.05; done; sleep 0.3; kill -" +
                        signal + " $p; wait $p");
  INFO(ran.err);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "interrupted"));
  const auto json = nlohmann::json::parse(read(folder / "cut/summary.json"));
  CHECK(json["status"] == "interrupted");
  CHECK(json["steps"] > 0);
  const FieldsReader fields(folder / "cut/fields.h5");
  CHECK(*fields.time(fields.frames() - 1) == json["time"]);
  CHECK(lines(read(folder / "cut/series.csv")).size() == delf::at(fields.frames()) + 1);
}

TEST_CASE("an interrupted estimate ends with exit code 130, and the run is there") {
  const Folder folder;
  // The run takes a third of a second, its estimate some twenty times as long; a slower one is interrupted itself.
  const Ran ran =
      shell(folder, "'" + program_path() +
                        "' run kink --run.until=6000 --output.estimate=on --output.figures=off --output.fields=off "
                        "--out cut & p=$!; sleep 0.8; kill -INT $p; wait $p");
  INFO(ran.err << ran.out);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "none: interrupted"));
  const auto json = nlohmann::json::parse(read(folder / "cut/summary.json"));
  CHECK(json["status"] == "interrupted");
  CHECK(json["error_estimate"]["failure"] == "interrupted");
  CHECK(json["steps"] > 0);
}

TEST_CASE("a full disk ends with exit code 4 and one line, and what fitted stays readable") {
  const Folder folder;
  const int blocks = GENERATE(1, 16, 200, 3000);  // of 512 bytes: scene.ini, series.csv and fields.h5 do not fit
  const Ran ran = delf_program(folder, "run collision --run.until=200 --output.every=5 --output.figures=off --out full",
                               // HDF5 forgets a buffer when it fails
                               "ulimit -f " + std::to_string(blocks) + "; ASAN_OPTIONS=detect_leaks=0");
  INFO(ran.err);
  CHECK(ran.code == 4);
  CHECK(ran.out.empty());
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "full/"));
  if (blocks == 3000) {
    CHECK(status(folder, "full") == "system-failure");
    CHECK(FieldsReader(folder / "full/fields.h5").frames() > 100);
  }
}

TEST_CASE("a full disk during a run on a mesh ends with exit code 4, one line and a summary of what fitted") {
  const Folder folder;
  const int blocks = GENERATE(1, 16, 200);
  const Ran ran = delf_program(
      folder,
      "run sphere --lattice.mesh=icosahedron:2 --run.steps=400 --output.every=1 --output.figures=off --out full",
      "ulimit -f " + std::to_string(blocks) + "; ASAN_OPTIONS=detect_leaks=0");
  INFO(ran.err);
  CHECK(ran.code == 4);
  CHECK(ran.out.empty());
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "full/"));
  CHECK_FALSE(std::filesystem::exists(folder / "full/summary.json.part"));
  if (blocks == 200) {
    CHECK(status(folder, "full") == "system-failure");
    CHECK(lines(read(folder / "full/series.csv")).size() > 10);
  }
}

TEST_CASE("results that cannot be put anywhere end with exit code 4") {
  const Folder folder;
  folder.write("file", "");
  for (const char* out : {"file", "file/below", "/dev/null/below", "/proc/delf"}) {
    const Ran ran = delf_program(folder, std::string("run kink --run.steps=3 --out ") + out);
    INFO(ran.err);
    CHECK(ran.code == 4);
    CHECK(lines(ran.err).size() == 1);
  }
  CHECK(delf_program(folder, "list > /dev/full").code == 4);
}

TEST_CASE("a lattice that fits into no memory ends with exit code 4, and says how much it asked for") {
#ifdef __SANITIZE_ADDRESS__
  const std::string limit;  // it would keep the sanitizer itself from starting
#else
  const std::string limit = "ulimit -v 4000000;";
#endif
  const Folder folder;
  const Ran ran = delf_program(folder, "run collision --lattice.sites=2147483647 --run.steps=2", limit);
  INFO(ran.err);
  CHECK(ran.code == 4);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "137 GB"));
}

TEST_CASE("slabs are solved from a first guess through any number of rows") {
  const Folder folder;
  const auto scene = GENERATE(as<std::string>(), "wave-map --lattice.sites=16", "gauss-kink");
  for (const char* rows : {"0", "1", "2", "4", "5", "8"}) {
    const Ran ran = delf_program(
        folder, "run " + scene + " --run.steps=6 --output.figures=off --out out --scheme.seed_order=" + rows);
    INFO(scene << " " << rows << ": " << ran.err);
    CHECK(ran.code == 0);
  }
}

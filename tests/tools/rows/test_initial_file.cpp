// SPDX-License-Identifier: MIT
#include <cmath>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/hdf5_handle.hpp"

using namespace delf::testing;
using delf::FieldsReader;

namespace {

constexpr double pi = std::numbers::pi;

// Rows of φ(t, x) at the times 0, step, 2 step, …, on so many sites a distance apart.
std::string table(const std::function<double(double, double)>& phi, int rows, double step, int sites, double apart,
                  bool times = false) {
  std::string text = times ? "row,site,t,phi\n" : "row,site,phi\n";
  char line[120];
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < sites; ++i) {
      if (times) std::snprintf(line, sizeof line, "%d,%d,%.17g,%.17g\n", j, i, j * step, phi(j * step, i * apart));
      else std::snprintf(line, sizeof line, "%d,%d,%.17g\n", j, i, phi(j * step, i * apart));
      text += line;
    }
  return text;
}

double kink(double t, double x) { return 4 * std::atan(std::exp((x - 10 - 0.5 * t) / std::sqrt(0.75))); }

// The attribute winding of a file, as another program might write it.
void set_winding(const std::filesystem::path& path, hid_t type, const void* values, hsize_t count) {
  const delf::Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose);
  REQUIRE(file);
  H5Adelete(file, "winding");
  if (!values) return;
  const delf::Hdf5Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  const delf::Hdf5Handle attribute(H5Acreate2(file, "winding", type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  REQUIRE(H5Awrite(attribute, type, values) >= 0);
}

nlohmann::json summary_of(const Folder& folder, const std::string& arguments) {
  const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out out");
  INFO(arguments << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / "out/summary.json"));
}

std::vector<double> last_row(const Folder& folder, const std::string& out = "out") {
  const FieldsReader fields(folder / (out + "/fields.h5"));
  return fields.row(fields.frames() - 1);
}

const std::string sine_gordon =
    "[theory]\nname = sine-gordon\n[lattice]\nstencil = triangle-vertex\nlength = 20\nsites = 64\n"
    "time_step = 0.1\n[initial]\nstate = file\nfile = rows.csv\n[run]\nuntil = 10\n";

}  // namespace

TEST_CASE("a run goes on from the rows of another") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  const auto scene = GENERATE(as<std::string>(), "small.ini --lattice.stencil=triangle-vertex", "small.ini",
                              "kink-train --output.every=1 --output.figures=off");
  REQUIRE(delf_program(folder, "run " + scene + " --run.steps=60 --out whole").code == 0);
  const Ran part = delf_program(folder, "run " + scene +
                                            " --run.steps=35 --initial.state=file "
                                            "--initial.file=whole/fields.h5 --initial.frame=25 --out part");
  INFO(part.err);
  REQUIRE(part.code == 0);
  const FieldsReader whole(folder / "whole/fields.h5"), rest(folder / "part/fields.h5");
  CHECK(rest.winding() == whole.winding());
  for (const int frame : {0, 1, 2, 35}) {
    const auto a = whole.row(25 + frame), b = rest.row(frame);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    CHECK(largest < 1e-11);
  }
  // and its scene.ini finds the file from anywhere
  REQUIRE(delf_program(folder, "run part/scene.ini --out elsewhere/again").code == 0);
  CHECK(read(folder / "part/series.csv") == read(folder / "elsewhere/again/series.csv"));
}

TEST_CASE("a brick wall goes on from an odd frame, and rows that begin there are verified") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  const std::string hexagon = "small.ini --lattice.stencil=hexagon ";
  REQUIRE(delf_program(folder, "run " + hexagon + "--run.steps=60 --out whole").code == 0);
  const FieldsReader whole(folder / "whole/fields.h5");
  const auto distance = [&](const std::string& out, int first) {
    const FieldsReader rest(folder / out / "fields.h5");
    const auto a = whole.row(first + 20), b = rest.row(20);
    double largest = 0;
    for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
    return largest;
  };
  const auto goes_on = [&](const std::string& from, int frame, const std::string& more) {
    const Ran ran =
        delf_program(folder, "run " + hexagon + "--run.steps=30 --initial.state=file --initial.file=" + from +
                                 "/fields.h5 --initial.frame=" + std::to_string(frame) + " " + more);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
  };
  const auto verified = [&](const std::string& arguments) {
    return delf_program(folder, "verify " + hexagon + "--verify.checks=equations --out verified " + arguments).code;
  };
  goes_on("whole", 13, "--out odd");
  CHECK(distance("odd", 13) < 1e-11);
  CHECK(contains(read(folder / "odd/scene.ini"), "first_row = 1"));
  CHECK(verified("--fields odd/fields.h5") == 0);
  goes_on("odd", 3, "--out even");  // row 16 of the first run
  CHECK(distance("even", 16) < 1e-11);
  CHECK_FALSE(contains(read(folder / "even/scene.ini"), "first_row = 1"));
  CHECK(verified("--fields even/fields.h5") == 0);
  // bricks laid the other way are another scheme
  goes_on("whole", 13, "--lattice.first_row=0 --out wrong");
  CHECK(distance("wrong", 13) > 1e-9);
  CHECK(verified("--fields odd/fields.h5 --lattice.first_row=0") == 1);
}

TEST_CASE("a file of rows is first looked up beside the scene") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --out inner").code == 0);
  std::filesystem::create_directory(folder / "away");
  folder.write("inner/next.ini", small_scene("[initial]\n"));
  const Ran ran = delf_program(folder, "run ../inner/next.ini --initial.state=file --initial.file=fields.h5 --out out",
                               "cd away &&");
  INFO(ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("a file that cannot give the rows is refused, and says why") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --out rows").code == 0);
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --output.every=5 --out sparse").code == 0);
  folder.write("text.h5", "this is no HDF5\n");
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    const Ran ran = delf_program(folder, "run small.ini --initial.state=file " + arguments);
    check_refused(ran, {reason});
    CHECK_FALSE(std::filesystem::exists(folder / "results"));
  };
  refused("", "needs initial.file");
  refused("--initial.file=nowhere.h5", "no such file");
  refused("--initial.file=text.h5", "is not an HDF5 file");
  refused("--initial.file=rows", "is a directory; name the file in it");
  refused("--initial.file=rows/fields.h5 --initial.frame=5", "frame 6 is needed, and the file has 6");
  refused("--initial.file=rows/fields.h5 --lattice.sites=65", "has 64 sites");
  refused("--initial.file=rows/fields.h5 --lattice.courant=0.25", "apart");
  refused("--initial.file=sparse/fields.h5", "apart");
  refused("--initial.file=rows/fields.h5 --initial.start=centred", "no velocities");
  refused("--initial.file=rows/fields.h5 --out rows", "choose another --out");
}

TEST_CASE("rows whose ends differ by multiples of 2 pi wind around a circle, whatever file they are in") {
  const Folder folder;
  folder.write("kink.ini", sine_gordon);
  const auto rows = [](double t, double x) { return kink(t, x); };
  folder.write("rows.csv", table(rows, 2, 0.1, 64, 20.0 / 64));
  const auto wound = summary_of(folder, "kink.ini");
  CHECK(wound["winding"] == 1);
  CHECK(wound["energy_initial"].get<double>() == Approx(8 / std::sqrt(0.75)).epsilon(2e-2));
  CHECK(wound["energy_error_max"].get<double>() < 1e-2);
  // the same rows as NumPy writes them
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 64), }";
  header.resize(117, ' ');
  std::string npy = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + header + "\n";
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < 64; ++i) {
      const double value = rows(0.1 * j, i * 20.0 / 64);
      npy.append(reinterpret_cast<const char*>(&value), sizeof value);
    }
  folder.write("rows.npy", npy);
  const auto from_csv = last_row(folder);
  CHECK(summary_of(folder, "kink.ini --initial.file=rows.npy")["winding"] == 1);
  CHECK(last_row(folder) == from_csv);
  npy.replace(npy.size() - 8, 8, std::string("\0\0\0\0\0\0\xf8\x7f", 8));  // not a number
  folder.write("nan.npy", npy);
  check_refused(delf_program(folder, "run kink.ini --initial.file=nan.npy"), {"row 1 holds what is no finite number"});
  check_refused(delf_program(folder, "run kink.ini --initial.file=rows.npy --initial.frame=1"), {"row 2 is needed"});
  // two kinks, an antikink, a pair, waves, and one site after another at random
  folder.write("rows.csv", table(
                               [](double, double x) {
                                 return 4 * std::atan(std::exp(2 * (x - 5))) + 4 * std::atan(std::exp(2 * (x - 15)));
                               },
                               2, 0.1, 64, 20.0 / 64));
  CHECK(summary_of(folder, "kink.ini")["winding"] == 2);
  folder.write("rows.csv",
               table([](double, double x) { return 4 * std::atan(std::exp(10 - x)); }, 2, 0.1, 64, 20.0 / 64));
  CHECK(summary_of(folder, "kink.ini")["winding"] == -1);
  folder.write("rows.csv", table(
                               [](double, double x) {
                                 return 4 * std::atan(std::exp(2 * (x - 5))) - 4 * std::atan(std::exp(2 * (x - 15)));
                               },
                               2, 0.1, 64, 20.0 / 64));
  CHECK(summary_of(folder, "kink.ini")["winding"] == 0);
  folder.write("rows.csv",
               table([](double, double x) { return 4 * std::sin(2 * pi * x / 20 + 1); }, 2, 0.1, 64, 20.0 / 64));
  CHECK(summary_of(folder, "kink.ini")["winding"] == 0);
  folder.write("rows.csv", table([](double, double x) { return 5 * std::sin(1000 * x * x); }, 2, 0.1, 64, 20.0 / 64));
  CHECK(summary_of(folder, "kink.ini --run.steps=3")["winding"] == 0);
}

TEST_CASE("rows that do not close around a circle are refused, and boundary.gain closes them") {
  const Folder folder;
  folder.write("rows.csv", table([](double, double x) { return x; }, 2, 0.1, 64, 20.0 / 64));
  folder.write("line.ini", sine_gordon);
  const std::string wave = "line.ini --theory.name=wave";
  check_refused(delf_program(folder, "run " + wave), {"row 0 gains some 20 around the circle", "boundary.gain = 20"});
  const auto closed = summary_of(folder, wave + " --boundary.gain=20");
  CHECK(closed["energy_initial"].get<double>() == Approx(10).epsilon(1e-12));
  folder.write("rows.csv", table(kink, 2, 0.1, 64, 20.0 / 64));
  check_refused(delf_program(folder, "run line.ini --boundary.winding=0"),
                {"it jumps at the seam by 6.2", "use boundary.winding = 1"});
  CHECK(summary_of(folder, "line.ini --lattice.space=interval")["winding"] == 0);
}

TEST_CASE("a file's winding is one whole number, and that of the scene") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n").replace(small_scene().find("breather"), 8, "kink"));
  REQUIRE(delf_program(folder, "run small.ini --lattice.length=30 --run.steps=5 --out rows").code == 0);
  const auto path = folder / "rows/fields.h5";
  const std::string run =
      "small.ini --lattice.length=30 --initial.state=file --initial.file=rows/fields.h5 --run.steps=20";
  CHECK(summary_of(folder, run)["winding"] == 1);
  check_refused(delf_program(folder, "run " + run + " --boundary.winding=0"),
                {"--boundary.winding = 0", "wind 1 times"});
  const auto refused = [&](const std::string& reason) {
    check_refused(delf_program(folder, "run " + run), {"initial.file", "its attribute winding", reason});
  };
  const double wrong[] = {1.5, std::nan(""), 1e300};
  for (const double value : wrong) {
    set_winding(path, H5T_NATIVE_DOUBLE, &value, 1);
    refused("write one whole number");
  }
  const int two[] = {1, 1};
  set_winding(path, H5T_NATIVE_INT, two, 2);
  refused("has 2 values");
  const delf::Hdf5Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  set_winding(path, text, "1", 1);
  refused("is a text");
  const double whole = 1;
  set_winding(path, H5T_NATIVE_DOUBLE, &whole, 1);
  CHECK(summary_of(folder, run)["winding"] == 1);
  set_winding(path, H5T_NATIVE_INT, nullptr, 0);  // left out: the rows say it
  CHECK(summary_of(folder, run)["winding"] == 1);
}

TEST_CASE("the space of a file is that of the scene") {
  const Folder folder;
  folder.write("small.ini", small_scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --run.steps=5 --out rows").code == 0);
  const auto refused = [&](const std::string& arguments, const std::vector<std::string>& parts) {
    check_refused(delf_program(folder, "run small.ini --initial.state=file --initial.file=rows/fields.h5 " + arguments),
                  parts);
  };
  // h is the same, so that nothing else is wrong
  refused("--lattice.length=10 --lattice.time_step=0.15625", {"lattice.length", "lies at", "use lattice.length = 20"});
  refused("--lattice.space=interval --lattice.time_step=0.15625 --lattice.length=19.6875",
          {"lattice.space", "lie on lattice.space = circle"});
}

TEST_CASE("fields of a table go by their names, where these are the scheme's") {
  const Folder folder;
  folder.write("ra.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nspace = interval\nlength = 25\nsites = 17\ntime_step = 0.01\n"
               "[scheme]\nmethod = r-adaptive\n[mesh]\nalpha = 2.5\n[initial]\nstate = file\nfile = "
               "rows.csv\n[run]\nsteps = 5\n");
  const std::string given = read(scenes_folder() + "/r-adaptive-rows.csv");
  folder.write("rows.csv", given);
  summary_of(folder, "ra.ini");
  const auto in_order = last_row(folder);
  std::string turned;
  for (const std::string& line : lines(given)) {
    const auto last = line.rfind(','), before = last == std::string::npos ? last : line.rfind(',', last - 1);
    turned += line[0] == '#' ? line + "\n"
                             : line.substr(0, before) + line.substr(last) + line.substr(before, last - before) + "\n";
  }
  folder.write("turned.csv", turned);
  summary_of(folder, "ra.ini --initial.file=turned.csv");
  CHECK(last_row(folder) == in_order);
  std::string other = turned;
  other.replace(other.find("X,phi"), 5, "Y,phi");
  folder.write("other.csv", other);
  check_refused(delf_program(folder, "run ra.ini --initial.file=other.csv"),
                {"has the fields Y, phi, and the scheme has phi, X"});
  check_refused(delf_program(folder, "run ra.ini --lattice.length=30"),
                {"lattice.length", "lie from X = 0 to 25", "use lattice.length = 25"});
}

TEST_CASE("rows of another step start by their values and rates") {
  const Folder folder;
  folder.write("kink.ini", sine_gordon + "[output]\nevery = 1\n");
  const std::string run = "kink.ini --lattice.length=40 --lattice.sites=256 --lattice.time_step=0.05 --run.until=4";
  const double k = 40.0 / 256;
  const auto error = [&] {
    const FieldsReader fields(folder / "out/fields.h5");
    const auto row = fields.row(fields.frames() - 1);
    double worst = 0;
    for (std::size_t i = 0; i < row.size(); ++i)
      worst = std::max(worst, std::abs(row[i] - kink(4, static_cast<double>(i) * k)));
    return worst;
  };
  // of two rows a step of 0.1 apart, by their time; of the key; and of five rows
  folder.write("rows.csv", table(kink, 2, 0.1, 256, k, true));
  CHECK(summary_of(folder, run)["start"] == "centred");
  CHECK(error() < 0.02);
  folder.write("rows.csv", table(kink, 2, 0.1, 256, k));
  summary_of(folder, run + " --initial.time_step=0.1");
  CHECK(error() < 0.02);
  summary_of(folder, run);  // taken as the run's: twice as fast
  CHECK(error() > 1);
  folder.write("rows.csv", table(kink, 5, 0.1, 256, k, true));
  summary_of(folder, run);
  CHECK(error() < 0.02);
  REQUIRE(delf_program(folder, "run out/scene.ini --output.figures=off --out again").code == 0);
  CHECK(read(folder / "out/series.csv") == read(folder / "again/series.csv"));
  // elements start from values and rates in any case
  summary_of(folder, run + " --scheme.method=cgvi");
  CHECK(error() < 0.02);
  // recorded rows go on at their own step; the key makes a start of them too
  summary_of(folder, run);
  const std::string next =
      "kink.ini --lattice.length=40 --lattice.sites=256 --lattice.time_step=0.025 --run.until=2 --initial.frame=40 "
      "--initial.file=out/fields.h5 --output.figures=off --out next";
  check_refused(delf_program(folder, "run " + next), {"apart", "initial.time_step = 0.05"});
  check_refused(delf_program(folder, "run " + next + " --initial.time_step=0.1"),
                {"initial.time_step", "are 0.05 apart"});
  const Ran ran = delf_program(folder, "run " + next + " --initial.time_step=0.05");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const auto there = last_row(folder, "next");
  double worst = 0;
  for (std::size_t i = 0; i < there.size(); ++i)
    worst = std::max(worst, std::abs(there[i] - kink(4, static_cast<double>(i) * k)));
  CHECK(worst < 0.02);
  // a row has one time, and later rows later ones
  folder.write("rows.csv", "row,site,t,phi\n0,0,0,1\n0,1,0.5,1\n");
  check_refused(delf_program(folder, "run kink.ini --lattice.sites=2"), {"line 3", "a row has one time"});
}

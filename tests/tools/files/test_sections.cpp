// SPDX-License-Identifier: MIT
#include <hdf5.h>
#include <hdf5_hl.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/files/hdf5_handle.hpp"
#include "tools/files/rows_table.hpp"

using namespace delf::testing;
using delf::Hdf5Handle;

namespace {

/// The extents of a dataset; empty if there is none.
std::vector<hsize_t> shape(const std::filesystem::path& file, const char* name) {
  delf::quiet_hdf5();
  const Hdf5Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle dataset(H5Dopen2(h5, name, H5P_DEFAULT), H5Dclose);
  if (!dataset) return {};
  const Hdf5Handle space(H5Dget_space(dataset), H5Sclose);
  std::vector<hsize_t> extent(H5Sget_simple_extent_ndims(space));
  H5Sget_simple_extent_dims(space, extent.data(), nullptr);
  return extent;
}

/// The attribute `components` of a dataset; empty if there is none.
std::string components(const std::filesystem::path& file, const char* name) {
  const Hdf5Handle h5(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle attribute(H5Aopen_by_name(h5, name, "components", H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!attribute) return {};
  const Hdf5Handle type(H5Aget_type(attribute), H5Tclose);
  std::string text(H5Tget_size(type), ' ');
  H5Aread(attribute, type, text.data());
  return text;
}

nlohmann::json summary(const Folder& folder) { return nlohmann::json::parse(read(folder / "out/summary.json")); }

using Shape = std::vector<hsize_t>;

}  // namespace

TEST_CASE("fields, nodes inside cells and multipliers are recorded with their names, and the series with theirs") {
  struct Case {
    const char *scene, *names, *further;
    hsize_t sites, fields, inner, multipliers;
  };
  const Case c = GENERATE(values<Case>({
      {"pendulum", "", "", 1, 1, 0, 0},
      {"kepler", "phi1,phi2", ",angular_momentum", 1, 2, 0, 0},
      {"coupled-sine-gordon", "phi1,phi2", "", 320, 2, 0, 0},
      {"complex-klein-gordon", "phi1,phi2", ",charge_u1", 320, 2, 0, 0},
      {"wave-map", "phi1,phi2,phi3", ",constraint,rotation_x,rotation_y,rotation_z", 128, 3, 0, 1},
      {"spacetime-element", "phi", "", 80, 1, 3, 0},
      {"r-adaptive", "phi,X", ",constraint,mesh_min_spacing,mesh_margin,step_over_limit,multiplier_max", 17, 2, 0, 1},
      {"breather", "", "", 512, 1, 0, 0},
  }));
  const Folder folder;
  const Ran ran = delf_program(
      folder, std::string("run ") + c.scene + " --run.steps=6 --output.every=2 --output.figures=off --out out");
  INFO(c.scene << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  CHECK(complaints(ran) == "");

  const auto file = folder / "out/fields.h5";
  CHECK(shape(file, "time") == Shape{4});
  CHECK(shape(file, "space") == Shape{c.sites});
  CHECK(shape(file, "field") == Shape{4, c.sites, c.fields});
  CHECK(shape(file, "inner") == (c.inner > 0 ? Shape{4, c.sites, c.inner} : Shape{}));
  CHECK(shape(file, "multiplier") == (c.multipliers > 0 ? Shape{4, c.sites, c.multipliers} : Shape{}));
  CHECK(shape(file, "mesh") == (std::string(c.scene) == "r-adaptive" ? Shape{4, c.sites} : Shape{}));
  CHECK(components(file, "field") == c.names);

  const auto series = lines(read(folder / "out/series.csv"));
  REQUIRE(series.size() == 5);
  CHECK(series[0] == std::string("step,time,energy,energy_error,momentum,charge,iterations,residual") + c.further);
  for (const std::string& line : series)
    CHECK(std::count(line.begin(), line.end(), ',') == std::count(series[0].begin(), series[0].end(), ','));

  const auto json = summary(folder);
  CHECK(json["status"] == "done");
  CHECK(json["constraint_max"].is_null() == (c.multipliers == 0));
  if (c.multipliers > 0) CHECK(json["constraint_max"] < 1e-11);
  for (const auto& conserved : json["conserved"]) CHECK(conserved["error_max"] < 1e-10);
  if (c.fields == 2 && std::string(c.scene) != "coupled-sine-gordon" && std::string(c.scene) != "r-adaptive")
    CHECK(json["conserved"].size() == 1);
}

TEST_CASE("runs of several fields, of elements and on a point run again to the same bits") {
  const auto scene = GENERATE(as<std::string>(), "pendulum", "kepler", "wave-map", "spacetime-element", "r-adaptive",
                              "complex-klein-gordon");
  const Folder folder;
  INFO(scene);
  REQUIRE(delf_program(folder, "run " + scene + " --run.steps=9 --output.figures=off --out first").code == 0);
  const Ran again = delf_program(folder, "run first/scene.ini --out second");
  INFO(again.err);
  REQUIRE(again.code == 0);
  CHECK(complaints(again) == "");
  for (const char* name : {"scene.ini", "series.csv", "fields.h5"})
    CHECK(read(folder / (std::string("first/") + name)) == read(folder / (std::string("second/") + name)));
}

TEST_CASE("a run of two fields goes on from the rows of another") {
  const Folder folder;
  const std::string run = "run coupled-sine-gordon --output.every=1 --output.figures=off ";
  REQUIRE(delf_program(folder, run + "--run.steps=30 --out whole").code == 0);
  const Ran part = delf_program(folder, run +
                                            "--run.steps=10 --initial.state=file --initial.file=whole/fields.h5 "
                                            "--initial.frame=20 --out part");
  INFO(part.err);
  REQUIRE(part.code == 0);
  const auto a = delf::FieldsReader(folder / "whole/fields.h5").row(30);
  const auto b = delf::FieldsReader(folder / "part/fields.h5").row(10);
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) CHECK(std::abs(a[i] - b[i]) < 1e-11);
}

TEST_CASE("the errors of exact states are small, in all fields") {
  const auto scene =
      GENERATE(as<std::string>(), "pendulum --run.until=5", "kepler --run.until=5 --lattice.time_step=0.005",
               "coupled-sine-gordon --initial.separation=0 --run.until=5", "wave-map --run.until=2",
               "complex-klein-gordon --initial.state=charged-wave --run.until=5",
               "complex-klein-gordon --initial.state=charged-wave --initial.start=centred --run.until=5",
               "spacetime-element --run.until=5", "spacetime-element --initial.start=legendre --run.until=5");
  const Folder folder;
  const Ran ran = delf_program(folder, "run " + scene + " --output.figures=off --out out");
  INFO(scene << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  CHECK(summary(folder)["error_linf"] < 0.02);
  CHECK(summary(folder)["error_l2"] > 0);
}

TEST_CASE("on a point a Courant number is a time step, and sites and length have no effect") {
  const Folder folder;
  const std::string scene =
      "[theory]\nname = pendulum\n[lattice]\nspace = point\nstencil = midpoint\ncourant = 0.1\n"
      "[initial]\nstate = pendulum-swing\n[run]\nsteps = 10\n[output]\nfigures = off\n";
  folder.write("point.ini", scene);
  const Ran ran = delf_program(folder, "run point.ini --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(complaints(ran) == "");
  CHECK(summary(folder)["time_step"] == 0.1);
  CHECK(summary(folder)["space"] == "point");
  CHECK(delf_program(folder, "plan point.ini").code == 0);
  folder.write("point.ini", scene + "[lattice]\nsites = 5\nlength = 2\n[boundary]\nwinding = 1\n");
  const Ran warned = delf_program(folder, "run point.ini --out out");
  CHECK(warned.code == 0);
  REQUIRE(lines(warned.err).size() == 3);
  CHECK(contains(warned.err, "lattice.sites = 5: warning: a point has neither length nor sites"));
}

TEST_CASE("incompatible keys are refused in one line") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    INFO(arguments);
    check_refused(delf_program(folder, "run " + arguments + " --run.steps=2"), {part});
    CHECK_FALSE(std::filesystem::exists(folder / "results"));
  };
  refused("coupled-sine-gordon --lattice.stencil=midpoint", "lattice.stencil = midpoint");
  refused("kepler --lattice.stencil=rectangle", "lattice.stencil = rectangle");
  refused("wave-map --initial.state=noise", "initial.state = noise");
  refused("kepler --initial.eccentricity=1", "initial.eccentricity = 1");
  refused("breather --initial.start=legendre",
          "needs scheme.method = radau-iia or r-adaptive or cgvi or spacetime or processed or composition");
  refused("breather --scheme.method=r-adaptive", "");
  refused("breather --scheme.method=r-adaptive --lattice.space=interval --scheme.time=gauss2",
          "or scheme.strategy = control");
  refused("r-adaptive --initial.start=legendre", "initial.start = legendre");
  refused("r-adaptive --initial.frame=1", "row 2 is needed, and the file has 2");
  refused("spacetime-element --scheme.degree_time=0", "must be at least 1");
  refused("spacetime-element --scheme.degree_space=13", "must be at most 12");
  refused("spacetime-element --scheme.quadrature=gaus", "did you mean gauss?");
  refused("r-adaptive --mesh.alpha=-1", "must be at least 0");
  refused("lotka-volterra --initial.v=1,1", "starts from values alone; leave initial.v out");
  refused("lotka-volterra --initial.start=centred", "use values");
  refused("lotka-volterra --scheme.flux=one-sided", "choose such a theory.gauge, or use gauss2");
  refused("pendulum --scheme.method=dgvi", "not linear in phi_t; use scheme.method = cgvi");
}

TEST_CASE("keys of another method or command are warned of") {
  const Folder folder;
  const auto warned = [&](const std::string& arguments, const std::string& part) {
    const Ran ran = delf_program(folder, "run " + arguments + " --run.steps=2 --output.figures=off --out out");
    INFO(ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(ran.err, part));
  };
  warned("breather --scheme.degree_time=3", "only scheme.method = spacetime reads it");
  warned("breather --scheme.quadrature=lobatto", "only scheme.method = spacetime or cgvi or dgvi reads it");
  warned("breather --mesh.alpha=3", "only scheme.method = r-adaptive reads it");
  warned("breather --initial.eccentricity=0.3", "the state breather does not read it");
  warned("breather --verify.regions=hole", "--verify.regions = hole: warning: only `delf verify` reads it");
}

TEST_CASE("a table of rows is read in any order, and its errors are reported with their line") {
  const Folder folder;
  const std::string good = "# two rows\nrow,site,phi,X\n1,0,5,6\n0,1,3,4\n0,0,1,2\n\n1,1,7, 8\r\n";
  const delf::RowsTable table(folder.write("rows.csv", good));
  CHECK(table.frames() == 2);
  CHECK(table.sites() == 2);
  CHECK(table.components() == 2);
  CHECK(table.row(0) == std::vector<double>{1, 2, 3, 4});
  CHECK(table.row(1) == std::vector<double>{5, 6, 7, 8});

  const auto refused = [&](const std::string& text, const std::string& part) {
    folder.write("bad.csv", text);
    folder.write("scene.ini",
                 "[lattice]\nspace = interval\nlength = 1\nsites = 3\ntime_step = 0.1\n[scheme]\nmethod = r-adaptive\n"
                 "[initial]\nstate = file\nfile = bad.csv\n[run]\nsteps = 2\n");
    check_refused(delf_program(folder, "run scene.ini"), {part});
    check_refused(delf_program(folder, "run scene.ini"), {"scene.ini:10: initial.file = bad.csv: "});
  };
  refused("", "holds no rows");
  refused("row,site,phi,X\n", "holds no rows");
  refused("a,b,c\n", "line 1: is no header");
  refused("row,site\n0,0\n", "line 1: is no header");
  refused("row,site,phi,X\n0,0,1\n", "line 2: has 3 columns, and the header has 4");
  refused("row,site,phi,X\n0,0,1,two\n", "line 2: \"two\" is not a finite number");
  refused("row,site,phi,X\n0,0,1,nan\n", "line 2: \"nan\" is not a finite number");
  refused("row,site,phi,X\n0,-1,1,1\n", "line 2: row and site are integers");
  refused("row,site,phi,X\n0,0,1,1\n0,0,1,1\n", "line 3: row 0, site 0 is given twice");
  refused("row,site,phi,X\n0,0,1,1\n0,2,1,1\n", "line 3: row 0, site 2 is given, but not row 0, site 1");
  refused("row,site,phi,X\n0,0,1,1\n0,1,1,1\n1,0,1,1\n", "row 1 ends at site 1 of 2");
  refused("row,site,phi,X\n1,0,1,1\n", "line 2: row 1, site 0 is given, but not row 0, site 0");
  refused("row,site,phi\n0,0,1\n0,1,1\n0,2,1\n1,0,1\n1,1,1\n1,2,1\n",
          "has 1 field, and the scheme has 2 fields (phi, X)");
}

TEST_CASE("figures of a point are a trajectory, and of two coordinates an orbit") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  struct Case {
    const char* scene;
    std::vector<std::string> drawn, not_drawn;
  };
  const Case c = GENERATE(values<Case>({{"pendulum", {"trajectory", "energy"}, {"orbit", "spacetime", "waveforms"}},
                                        {"kepler", {"trajectory", "orbit", "energy"}, {"spacetime", "waveforms"}},
                                        {"r-adaptive", {"spacetime", "waveforms", "energy"}, {"orbit", "trajectory"}},
                                        {"wave-map", {"spacetime", "waveforms", "energy"}, {"orbit", "trajectory"}}}));
  const Folder folder;
  const Ran ran = delf_program(folder, std::string("run ") + c.scene + " --run.steps=40 --output.every=1 --out out");
  INFO(c.scene << ran.err);
  REQUIRE(ran.code == 0);
  CHECK(complaints(ran) == "");
  for (const std::string& name : c.drawn)
    for (const char* ending : {".png", ".svg"})
      CHECK(std::filesystem::file_size(folder / ("out/figures/" + name + ending)) > 1000);
  for (const std::string& name : c.not_drawn)
    CHECK_FALSE(std::filesystem::exists(folder / ("out/figures/" + name + ".png")));
}

TEST_CASE("axes of fields.h5 have the names of their dimension scales") {
  delf::quiet_hdf5();
  const auto names = [](const std::filesystem::path& path, const char* dataset) {
    const Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    const Hdf5Handle rows(H5Dopen2(file, dataset, H5P_DEFAULT), H5Dclose);
    const Hdf5Handle space(H5Dget_space(rows), H5Sclose);
    std::string text;
    for (int axis = 0; axis < H5Sget_simple_extent_ndims(space); ++axis) {
      char label[64] = "";
      H5DSget_label(rows, static_cast<unsigned>(axis), label, sizeof(label));
      text += std::string(axis == 0 ? "" : " ") + label + (H5DSget_num_scales(rows, axis) == 1 ? "" : "?");
    }
    return text;
  };
  const Folder folder;
  REQUIRE(delf_program(folder, "run wave-map --run.steps=4 --output.figures=off --out out").code == 0);
  CHECK(names(folder / "out/fields.h5", "field") == "time space field_component");
  CHECK(names(folder / "out/fields.h5", "multiplier") == "time space multiplier_component");
  REQUIRE(delf_program(folder, "run sphere --run.steps=4 --output.figures=off --out mesh").code == 0);
  CHECK(names(folder / "mesh/fields.h5", "field") == "time site field_component");
  CHECK(names(folder / "mesh/fields.h5", "space") == "site coordinate");
  CHECK(names(folder / "mesh/fields.h5", "cells") == "cell corner");
}

TEST_CASE("every frame of a mesh is a whole data set for the readers of XDMF") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run sphere --run.steps=6 --output.every=2 --output.figures=off --out out").code == 0);
  const std::string xdmf = read(folder / "out/fields.xdmf");
  CHECK(contains(xdmf, "Format=\"HDF\">frames.h5:/phi/3</DataItem>"));
  CHECK_FALSE(contains(xdmf, "HyperSlab"));
  const delf::FieldsReader rows(folder / "out/fields.h5");
  const Hdf5Handle file(H5Fopen((folder / "out/frames.h5").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  for (const int frame : {0, 3}) {
    const Hdf5Handle phi(H5Dopen2(file, ("phi/" + std::to_string(frame)).c_str(), H5P_DEFAULT), H5Dclose);
    std::vector<double> values(static_cast<std::size_t>(rows.sites()));
    REQUIRE(H5Dread(phi, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
    CHECK(values == rows.row(frame));
  }
}

TEST_CASE("a file of another program without /field names what it has, and --dataset") {
  delf::quiet_hdf5();
  const Folder folder;
  {
    const Hdf5Handle file(H5Fcreate((folder / "other.h5").c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    const hsize_t extent[2] = {3, 64};
    const Hdf5Handle space(H5Screate_simple(2, extent, nullptr), H5Sclose);
    const Hdf5Handle u(H5Dcreate2(file, "u", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    REQUIRE(u);
  }
  const std::string scene = "'" + folder.write("small.ini", small_scene()) + "'";
  check_refused(delf_program(folder, "verify " + scene + " --fields other.h5 --out out"),
                {"has no dataset /field", "--dataset u"});
}

namespace {

/// The data items of an XDMF file that read HDF5: the shape and the place of each.
struct SharedItem {
  std::vector<std::size_t> shape;
  std::string file, data_set;
};
std::vector<SharedItem> shared_items(const std::string& xdmf) {
  const std::regex item("<DataItem Dimensions=\"([0-9 ]+)\"[^>]*Format=\"HDF\">([^:<]+):([^<]+)</DataItem>");
  std::vector<SharedItem> items;
  for (std::sregex_iterator found(xdmf.begin(), xdmf.end(), item), end; found != end; ++found) {
    items.push_back({{}, (*found)[2], (*found)[3]});
    std::istringstream shape((*found)[1]);
    for (std::size_t n = 0; shape >> n;) items.back().shape.push_back(n);
  }
  return items;
}

/// All of the data set of an item, as the readers of XDMF take it.
std::vector<double> values_of(const std::filesystem::path& folder, const SharedItem& item) {
  std::size_t count = 1;
  for (const std::size_t n : item.shape) count *= n;
  const Hdf5Handle file(H5Fopen((folder / item.file).c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  const Hdf5Handle set(H5Dopen2(file, item.data_set.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  INFO(item.file << ":" << item.data_set);
  REQUIRE(H5Sget_simple_extent_npoints(space) == static_cast<hssize_t>(count));
  std::vector<double> values(count);
  REQUIRE(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0);
  return values;
}

}  // namespace

TEST_CASE("the XDMF of a lattice points into fields.h5, and has its values") {
  const Folder folder;
  const std::string scene = GENERATE(as<std::string>(), "kink --run.until=1", "coupled-sine-gordon --run.until=1",
                                     "gauss-kink --run.until=1", "r-adaptive --run.steps=8");
  INFO(scene);
  REQUIRE(
      delf_program(folder, "run " + scene + " --output.every=2 --output.xdmf=on --output.figures=off --out out").code ==
      0);
  const delf::FieldsReader rows(folder / "out/fields.h5");
  const auto frames = static_cast<std::size_t>(rows.frames()), sites = static_cast<std::size_t>(rows.sites()),
             d = static_cast<std::size_t>(rows.components());
  const std::string xdmf = read(folder / "out/fields.xdmf") + read(folder / "out/surface.xdmf");
  const std::vector<SharedItem> items = shared_items(xdmf);
  std::map<std::string, std::vector<double>> values;
  for (const SharedItem& item : items) values[item.data_set] = values_of(folder / "out", item);
  const std::vector<std::string> names = rows.names();
  for (std::size_t c = 0; c < d; ++c) {
    const std::string name = names.empty() ? "phi" : names[c];
    CHECK(contains(xdmf, "<Attribute Name=\"" + name + "\""));
    for (std::size_t n = 0; n < frames; ++n) {
      const std::vector<double> row = rows.row(static_cast<int>(n));
      for (std::size_t i = 0; i < sites; ++i) {
        CHECK(values.at("/" + name + "/" + std::to_string(n)).at(i) == row.at(i * d + c));
        CHECK(values.at("/" + name + "/all").at(n * sites + i) == row.at(i * d + c));
      }
    }
  }
  if (scene.starts_with("gauss-kink")) {
    CHECK(contains(xdmf, "<Attribute Name=\"phi at (0, 0.5)\""));
    CHECK(values.at("/inner2/3").at(5) == rows.values(delf::Role::inner, 3).at(5 * 3 + 2));
  }
  if (scene.starts_with("r-adaptive")) {  // each site at its place, beside the time of its frame
    const std::vector<double>& places = values.at("/places");
    for (std::size_t n = 0; n < frames; ++n)
      for (std::size_t i = 0; i < sites; ++i) {
        CHECK(places.at(2 * (n * sites + i)) == values.at("/places_of_sites/" + std::to_string(n)).at(i));
        CHECK(places.at(2 * (n * sites + i) + 1) == rows.time(static_cast<int>(n)).value());
      }
    CHECK(places[2 * (sites / 2)] != places[2 * ((frames - 1) * sites + sites / 2)]);  // they have moved
  } else {
    CHECK(values.at("/space") == rows.positions().value());
    CHECK(values.at("/time").at(frames - 1) == rows.time(static_cast<int>(frames) - 1).value());
  }
  // nothing is copied
  CHECK(std::filesystem::file_size(folder / "out/frames.h5") < 4000 * (frames + 2) * (d + 4));
}

TEST_CASE("XDMF is written where it is asked for and there is a space to show") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --out off").code == 0);
  CHECK_FALSE(std::filesystem::exists(folder / "off/fields.xdmf"));
  const Ran point =
      delf_program(folder, "run pendulum --run.until=1 --output.xdmf=on --output.figures=off --out point");
  CHECK(point.code == 0);
  CHECK(contains(point.err, "a point has no space to show"));
  CHECK_FALSE(std::filesystem::exists(folder / "point/fields.xdmf"));
}

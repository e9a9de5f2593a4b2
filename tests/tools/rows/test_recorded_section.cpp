// SPDX-License-Identifier: MIT
#include <cmath>
#include <limits>

#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/recorded_section.hpp"

using namespace delf::testing;
using delf::RecordedSection;

namespace {

constexpr double h = 0.25;

delf::Simulation simulation(const std::string& method, delf::Lattice lattice) {
  delf::Problem problem;
  problem.method = method;
  problem.lattice = lattice;
  problem.time_step = h;
  return delf::Simulation(problem);
}

// sine-Gordon on four sites: one field and nothing else
const delf::Simulation& plain() {
  static const delf::Simulation made = simulation("multisymplectic", delf::Lattice::circle(4, 4));
  return made;
}

// phi, X and a multiplier on four sites
const delf::Simulation& with_multiplier() {
  static const delf::Simulation made = simulation("r-adaptive", delf::Lattice::interval(4, 3));
  return made;
}

const delf::LatticeSystem& system_of(const delf::Simulation& s) { return s.evolution().system(); }

// row, site and component of a value, to be told from the value
double mark(int row, int site, int component) { return 100 * row + 10 * site + component; }

std::vector<double> marks(int row, int sites, int first, int components) {
  std::vector<double> values;
  for (int i = 0; i < sites; ++i)
    for (int c = 0; c < components; ++c) values.push_back(mark(row, i, first + c));
  return values;
}

struct Layout {
  int frames = 4, sites = 4, fields = 1, inner = 0, multipliers = 0;
  double step = h;
  std::vector<double> times = {};
};

delf::RowNames names_of(const Layout& layout) {
  delf::RowNames names;
  names.of[delf::Role::field].assign(layout.fields, "phi");
  names.of[delf::Role::inner].assign(layout.inner, "inner");
  names.of[delf::Role::multiplier].assign(layout.multipliers, "lambda");
  return names;
}

std::filesystem::path write(const Folder& folder, const Layout& layout, double (*change)(int, int) = nullptr) {
  const auto path = folder / "rows.h5";
  const std::vector<double> space(layout.sites);
  delf::FieldsFile file(path, space, layout.frames, "", 0, names_of(layout));
  for (int j = 0; j < layout.frames; ++j) {
    auto field = marks(j, layout.sites, 0, layout.fields);
    for (int i = 0; change && i < layout.sites; ++i) field[i] += change(j, i);
    const auto inner = marks(j, layout.sites, layout.fields, layout.inner);
    const auto multiplier = marks(j, layout.sites, layout.fields + layout.inner, layout.multipliers);
    const double time = layout.times.empty() ? 7 + j * layout.step : layout.times[j];
    file.append(time, {{field, inner, multiplier}});
  }
  file.close();
  return path;
}

// datasets of zeros, of whatever shape; or of no values at all, which read as zeros
std::filesystem::path write_raw(const Folder& folder,
                                const std::vector<std::pair<const char*, std::vector<hsize_t>>>& datasets,
                                bool values = true) {
  const auto path = folder / "raw.h5";
  delf::quiet_hdf5();
  const delf::Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
  for (const auto& [name, shape] : datasets) {
    const delf::Hdf5Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
    const delf::Hdf5Handle dataset(
        H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    REQUIRE(dataset);
    const std::vector<double> zeros(H5Sget_simple_extent_npoints(space));
    if (values) REQUIRE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, zeros.data()) >= 0);
  }
  return path;
}

// One line that names option and file, and holds all the parts.
void check_refused(const std::filesystem::path& path, const delf::Simulation& s, const std::vector<std::string>& parts,
                   int row = 0) {
  const std::vector<int> back(s.components().size(), 0);
  try {
    RecordedSection(path, system_of(s), back, h, "--nearby").row(row);
    FAIL("nothing was found wrong");
  } catch (const delf::BadScene& bad) {
    const std::string line = delf::error_line(bad);
    INFO(line);
    CHECK(delf::exit_code(bad) == delf::ExitCode::bad_input);
    CHECK(lines(line).size() == 1);
    CHECK(line.starts_with("command line: --nearby " + path.string() + ": "));
    CHECK(contains(line, "; "));
    for (const std::string& part : parts) {
      INFO(part);
      CHECK(contains(line, part));
    }
  }
}

}  // namespace

TEST_CASE("recorded rows are read as a section") {
  const Folder folder;
  const RecordedSection section(write(folder, {}), system_of(plain()), {0}, h, "--fields");
  CHECK(section.rows() == 4);
  CHECK(section.winding() == 0);
  for (const int row : {2, 0, 3, 1}) CHECK(section.row(row) == marks(row, 4, 0, 1));
}

TEST_CASE("recorded multipliers go to the rows that they belong to") {
  const Folder folder;
  const auto path = write(folder, {.fields = 2, .multipliers = 1});
  const RecordedSection same(path, system_of(with_multiplier()), {0, 0, 0}, h, "--fields");
  CHECK(same.row(2) == marks(2, 4, 0, 3));
  const RecordedSection later(path, system_of(with_multiplier()), {0, 0, 1}, h, "--fields");
  for (const int row : {0, 1, 2, 3}) {
    const auto values = later.row(row);
    REQUIRE(values.size() == 12);
    for (int i = 0; i < 4; ++i) {
      const std::size_t at = 3 * i;
      CHECK(values[at] == mark(row, i, 0));
      CHECK(values[at + 1] == mark(row, i, 1));
      CHECK(values[at + 2] == (row < 3 ? mark(row + 1, i, 2) : 0));  // there is no frame 4
    }
  }
}

TEST_CASE("recorded inner nodes may belong to several rows") {
  const Folder folder;
  const delf::Simulation elements = simulation("spacetime", delf::Lattice::circle(4, 4));
  const int inner = elements.count(delf::Role::inner);
  REQUIRE(inner == 3);
  const auto path = write(folder, {.inner = inner});
  const RecordedSection section(path, system_of(elements), {0, 1, 0, 2}, h, "--fields");
  const auto values = section.row(1);
  for (int i = 0; i < 4; ++i) {
    const std::size_t at = 4 * i;
    CHECK(values[at] == mark(1, i, 0));
    CHECK(values[at + 1] == mark(2, i, 1));
    CHECK(values[at + 2] == mark(1, i, 2));
    CHECK(values[at + 3] == mark(3, i, 3));
  }
}

TEST_CASE("what a scheme does not have may be in a file of recorded rows") {
  const Folder folder;
  const RecordedSection section(write(folder, {.inner = 2}), system_of(plain()), {0}, h, "--fields");
  CHECK(section.row(1) == marks(1, 4, 0, 1));
}

TEST_CASE("a file without recorded rows is refused") {
  const Folder folder;
  check_refused(folder / "nowhere.h5", plain(), {"no such file"});
  check_refused(folder.write("text.h5", "this is no HDF5\n"), plain(),
                {"is not an HDF5 file", "or a file of the same"});
  check_refused(write_raw(folder, {}), plain(), {"has no dataset /field"});
  check_refused(write_raw(folder, {{"field", {4, 4}}}), plain(), {"/field is not frames x sites x components"});
  check_refused(write_raw(folder, {{"field", {4, 4, 1}}}), plain(), {"has no dataset /time"});
  check_refused(write_raw(folder, {{"field", {4, 4, 1}}}, false), plain(), {"not all of that was ever written"});
  check_refused(write_raw(folder, {{"field", {4, 4, 1}}, {"time", {3}}}), plain(), {"apart"});
  check_refused(write_raw(folder, {{"field", {2, 4, 1}}, {"time", {1}}}), plain(), {"/time has no frame 1"});
  check_refused(write_raw(folder, {{"field", {4, 4, 1}}, {"time", {4, 1}}}), plain(), {"/time has no frame 0"});
}

TEST_CASE("recorded rows of another shape than the scheme's are refused") {
  const Folder folder;
  check_refused(write(folder, {.sites = 3}), plain(), {"has 3 sites, and the lattice has 4", "lattice.sites = 3"});
  check_refused(write(folder, {.fields = 2}), plain(), {"has 2 fields, and the scheme has 1 (phi)"});
  check_refused(write(folder, {}), with_multiplier(), {"has 1 field, and the scheme has 2 (phi, X)"});
  check_refused(write(folder, {.fields = 2}), with_multiplier(),
                {"has no dataset /multiplier", "frames x sites x components = 4 x 4 x 1 (lambda)"});
  check_refused(write(folder, {.fields = 2, .multipliers = 3}), with_multiplier(),
                {"/multiplier is 4 x 4 x 3", "= 4 x 4 x 1 (lambda)"});
  check_refused(write_raw(folder, {{"field", {4, 4, 2}}, {"time", {4}}, {"multiplier", {3, 4, 1}}}), with_multiplier(),
                {"/multiplier is 3 x 4 x 1", "= 4 x 4 x 1 (lambda)"});
  const delf::Simulation elements = simulation("spacetime", delf::Lattice::circle(4, 4));
  check_refused(write(folder, {}), elements, {"has no dataset /inner", "= 4 x 4 x 3 (phi at"});
}

TEST_CASE("recorded rows must follow each other by one time step") {
  const Folder folder;
  check_refused(write(folder, {.frames = 6, .times = {0, 0.25, 0.5, 0.75, 1.25, 1.5}}), plain(),
                {"frames 3 and 4 are 0.5 apart, and the time step is 0.25", "output.every = 1"});
  check_refused(write(folder, {.step = h * (1 + 1e-7)}), plain(), {"frames 0 and 1", "apart"});
  check_refused(write(folder, {.times = {0, 0.25, std::nan(""), 0.75}}), plain(), {"frames 1 and 2 are nan apart"});
  // times far from zero are rounded
  const double far = 1e9 / 3;
  CHECK_NOTHROW(RecordedSection(write(folder, {.times = {far, far + h, far + 2 * h, far + 3 * h}}), system_of(plain()),
                                {0}, h, "--fields"));
}

TEST_CASE("recorded rows that are not finite, or not there, are refused") {
  const Folder folder;
  const auto path =
      write(folder, {}, [](int j, int i) { return j == 2 && i == 3 ? std::numeric_limits<double>::infinity() : 0; });
  CHECK_NOTHROW(RecordedSection(path, system_of(plain()), {0}, h, "--fields").row(1));
  check_refused(path, plain(), {"/field is not finite in frame 2 at site 3"}, 2);
  check_refused(path, plain(), {"row 4 is needed, and the file has 4 frames"}, 4);
  check_refused(path, plain(), {"row -1 is needed"}, -1);
}

namespace {

delf::Simulation built(const std::filesystem::path& scene, double& time_step) {
  const delf::Scene read = delf::read_scene(scene, {});
  time_step = read.problem.time_step;
  return delf::build(read, 0);
}

// The largest |E| over the largest Σ |terms|, of rows first … last of a section.
double largest_residual(const RecordedSection& section, const delf::LatticeSystem& system, int first, int last) {
  double worst = 0, size = 0;
  std::vector<delf::LatticeSystem::Value> values;
  for (int j = first; j <= last; ++j) {
    const auto window = system.window(j - 1, {section.row(j - 1), section.row(j), section.row(j + 1)}, 0);
    system.equations(window, j, values);
    for (std::size_t n = 0; n < values.size(); ++n) {
      const std::size_t components = system.components();
      const int site = static_cast<int>(n / components), component = static_cast<int>(n % components);
      if (system.component(component).role != delf::Role::field || system.lattice().is_fixed(site)) continue;
      worst = std::max(worst, std::abs(values[n].sum));
      size = std::max(size, values[n].absolute);
    }
  }
  return worst / size;
}

}  // namespace

TEST_CASE("the rows of runs, read as sections, solve their equations") {
  struct Case {
    const char* scene;
    std::vector<int> back;
  };
  const Case c = GENERATE(values<Case>({{"breather --lattice.sites=32", {0}},
                                        {"r-adaptive", {0, 0, 1}},
                                        {"spacetime-element --lattice.sites=32", {0, 0, 1, 1}}}));
  const Folder folder;
  const Ran ran = delf_program(
      folder, std::string("run ") + c.scene + " --run.steps=20 --output.every=1 --output.figures=off --out out");
  INFO(c.scene << ": " << ran.err);
  REQUIRE(ran.code == 0);
  double step = 0;
  const delf::Simulation simulation = built(folder / "out/scene.ini", step);
  const RecordedSection section(folder / "out/fields.h5", system_of(simulation), c.back, step, "--fields");
  CHECK(section.rows() == 21);
  CHECK(largest_residual(section, system_of(simulation), 2, 18) < 1e-12);
}

TEST_CASE("the NumPy example solves the equations of its scene, and by Runge and Kutta it does not") {
  const Folder folder;
  const std::string with = python(folder);
  const std::string examples = scenes_folder() + "/../examples/";
  double step = 0;
  const delf::Simulation simulation = built(examples + "leapfrog.ini", step);
  const auto largest = [&](const std::string& method) {
    const Ran ran = shell(folder, with + " '" + examples + "leapfrog.py' " + method + " " + method);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    double worst = 0;
    for (const char* name : {"fields", "nearby-a", "nearby-b", "nearby-a2", "nearby-b2"}) {
      const RecordedSection section(folder / (method + "/" + name + ".h5"), system_of(simulation), {0}, step,
                                    "--fields");
      REQUIRE(section.rows() == 200);
      worst = std::max(worst, largest_residual(section, system_of(simulation), 1, 198));
    }
    return worst;
  };
  const double symplectic = largest("symplectic"), runge_kutta = largest("runge-kutta");
  INFO(symplectic << " " << runge_kutta);
  CHECK(symplectic < 1e-14);
  CHECK(runge_kutta > 1e-4);
}

TEST_CASE("files of recorded rows are given by options, and only to what reads them") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& part) {
    check_refused(delf_program(folder, arguments), {part});
  };
  refused("run breather --fields a.h5", "--fields: `run` reads no recorded rows");
  refused("plan breather --nearby=a.h5", "--nearby: `plan` reads no recorded rows");
  refused("list --fields=a.h5", "--fields: `list` reads no recorded rows");
  refused("help run --nearby a.h5", "--nearby: `help` reads no recorded rows");
  refused("run breather --fields a.h5 --fields b.h5", "--fields: give one file of rows");
  refused("run breather --fields ''", "--fields");
  refused("run breather --nearby ''", "--nearby");
  refused("run breather --fields", "--fields");
}

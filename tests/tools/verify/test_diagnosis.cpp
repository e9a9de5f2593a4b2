// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <random>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

std::string scene(const std::string& space = "circle") {
  return "[theory]\nname = sine-gordon\n[lattice]\nstencil = triangle-vertex\nspace = " + space +
         "\nlength = 20\nsites = 32\ntime_step = 0.3\n[initial]\nstate = breather\n[run]\nsteps = 30\n"
         "[output]\nfigures = off\nevery = 1\n";
}

Json verified(const Folder& folder, const std::string& arguments, int code) {
  const Ran ran = delf_program(folder, "verify small.ini --out out " + arguments);
  INFO(arguments << "\n" << ran.out << ran.err);
  CHECK(ran.code == code);
  return Json::parse(read(folder / "out/verify.json"));
}
bool says(const Json& json, const std::string& words) {
  for (const Json& finding : json["diagnosis"])
    if (contains(finding["words"].get<std::string>(), words)) return true;
  return false;
}

// A copy of recorded rows, changed.
template <class Change>
void copy(const std::filesystem::path& from, const std::filesystem::path& to, const Change& change) {
  const delf::FieldsReader rows(from);
  const std::vector<double> space(rows.sites());
  delf::FieldsFile file(to, space, rows.frames(), "", 0);
  for (int j = 0; j < rows.frames(); ++j) {
    auto values = rows.row(j);
    change(j, values);
    file.append(*rows.time(j), {values, {}, {}});
  }
  file.close();
}

}  // namespace

TEST_CASE("verify says what rows are that fail, and whose they are if asked") {
  const Folder folder;
  folder.write("small.ini", scene());
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  const std::string fields = "--fields run/fields.h5 ";
  CHECK(verified(folder, fields, 0)["diagnosis"].empty());
  CHECK(says(verified(folder, fields + "--verify.identify=on", 0), "the equations of triangle-vertex."));
  copy(folder / "run/fields.h5", folder / "nowhere.h5", [](int, std::vector<double>&) {});  // without positions
  const Json longer = verified(folder, "--fields nowhere.h5 --lattice.length=40", 1);
  CHECK(longer["diagnosis"][0]["kind"] == "coefficients");
  CHECK(says(longer, "try lattice.length = 20,"));
  CHECK(longer["measured"][0]["name"] == "equations: |E| beside the largest force");
  CHECK(longer["measured"][0]["value"] > 0.1);
  CHECK(says(verified(folder, fields + "--lattice.stencil=hexagon", 1), "lattice.stencil = triangle-vertex"));
}

TEST_CASE("every report on rows says how large a residual is beside the force, and beside that of its site") {
  const Folder folder;
  folder.write("small.ini", scene());
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  constexpr const char* whole = "equations: |E| beside the largest force";
  constexpr const char* of_site = "equations: |E| of a site beside its force";
  const auto value = [](const Json& json, const std::string& name) {
    for (const Json& measured : json["measured"])
      if (measured["name"] == name) return measured["value"].get<double>();
    return -1.0;
  };
  const Json right = verified(folder, "--fields run/fields.h5", 0);
  CHECK(value(right, whole) >= 0);
  CHECK(value(right, whole) < 1e-11);
  CHECK(value(right, of_site) == -1);  // no site is accused of its rounding
  // In the tail a value is wrong by 1e-7: nothing beside the front, and more than all there is at its site.
  copy(folder / "run/fields.h5", folder / "tail.h5", [](int j, std::vector<double>& row) {
    if (j == 15) row[0] += 1e-7;
  });
  const Json tail = verified(folder, "--fields tail.h5", 1);
  CHECK(value(tail, whole) > 1e-8);
  CHECK(value(tail, whole) < 1e-4);
  CHECK(value(tail, of_site) > 10 * value(tail, whole));
}

TEST_CASE("a tail that is wrong by less than the tolerance is seen beside the force of its own sites") {
  const Folder folder;
  folder.write("small.ini", scene());
  const std::string wide = " --lattice.length=60 --lattice.sites=96 --initial.frequency=0.6 ";
  REQUIRE(delf_program(folder, "run small.ini --out run" + wide).code == 0);
  CHECK(verified(folder, "--fields run/fields.h5" + wide, 0)["severity"].empty());
  copy(folder / "run/fields.h5", folder / "tail.h5", [](int j, std::vector<double>& row) {
    if (j > 15)
      for (int i = 0; i < 2; ++i) row[i] *= 1.0002;
  });
  const Json wrong = verified(folder, "--fields tail.h5" + wide, 0);
  REQUIRE(!wrong["severity"].empty());
  const Json& worst = wrong["severity"][0];
  CHECK(worst["site"] < 8);
  CHECK(worst["row"].get<int>() >= 15);
  CHECK(worst["row"].get<int>() <= 16);
  CHECK(worst["share"] > 1e-3);
  CHECK(contains(read(folder / "out/severity.csv"), "site,field,row,error,force,share\n0,phi,"));
  for (const Json& measured : wrong["measured"])
    if (measured["name"] == "equations: |E| of a site beside its force")
      CHECK(measured["remark"] == "more than rounding, and below the tolerance of the checks");
}

TEST_CASE("a mass that the terms hide is found beside the force, and rows that are right to rounding are not accused") {
  const Folder folder;
  folder.write("small.ini", scene());
  const auto check = [](const Json& json, const std::string& name) {
    for (const Json& one : json["checks"])
      if (one["name"] == name) return one;
    return Json();
  };
  struct Case {
    const char *h, *mass;
    double share;  // of the force: E = (m'^2 - m^2) sin φ
  };
  for (const Case& c : {Case{"0.01", "1", 0}, {"1e-4", "1.00003", 6e-5}, {"1e-5", "1.0003", 6e-4}}) {
    const std::string step = std::string("--lattice.time_step=") + c.h + " ";
    CAPTURE(c.h, c.mass);
    REQUIRE(delf_program(folder, "run small.ini --out run " + step).code == 0);
    copy(folder / "run/fields.h5", folder / "rows.h5", [](int, std::vector<double>&) {});
    const Json right = verified(folder, "--fields rows.h5 " + step, 0);
    CHECK(check(right, "field equations, beside the force")["passed"] == true);
    CHECK(check(right, "field equations, on average")["passed"] == true);
    if (c.share == 0) continue;
    // relative to the terms it is below the tolerance
    const Json wrong = verified(folder, "--fields rows.h5 --theory.mass=" + std::string(c.mass) + " " + step, 1);
    CHECK(check(wrong, "field equations")["passed"] == true);
    const Json beside = check(wrong, "field equations, beside the force");
    CHECK(beside["passed"] == false);
    CHECK(beside["value"].get<double>() > 0.1 * c.share);
    CHECK(beside["value"].get<double>() < 10 * c.share);
    CHECK(!wrong["diagnosis"].empty());
  }
}

TEST_CASE("rows in single precision are measured by what they have, and where that is nothing the verdict says so") {
  const Folder folder;
  folder.write("small.ini", scene());
  const auto single = [&](const std::string& step) {
    REQUIRE(delf_program(folder, "run small.ini --out run " + step).code == 0);
    copy(folder / "run/fields.h5", folder / "rows.h5", [](int, std::vector<double>& row) {
      for (double& y : row) y = static_cast<float>(y);
    });
  };
  single("");
  CHECK(contains(verified(folder, "--fields rows.h5", 0)["subject"].get<std::string>(), "single precision"));
  verified(folder, "--fields rows.h5 --theory.mass=1.001", 1);
  // Rounding to six digits is ten times what a mass off by 1e-4 makes of one equation, and averages to nothing.
  const auto digits = [&](const std::string& mass, int code) {
    const std::string rows = " --run.steps=200 ";
    REQUIRE(delf_program(folder, "run small.ini --out run" + rows).code == 0);
    copy(folder / "run/fields.h5", folder / "digits.h5", [](int, std::vector<double>& row) {
      for (double& y : row) y = std::stod(fmt::format("{:.6g}", y));
    });
    return verified(folder, "--fields digits.h5 --theory.mass=" + mass + rows, code);
  };
  CHECK(digits("1", 0)["passed"] == true);
  CHECK(digits("1.0002", 1)["passed"] == false);
  // ε φ/h² is a hundred times the force: any mass would do
  single("--lattice.time_step=1e-4 ");
  for (const char* mass : {"1", "1.1"}) {
    const Json json =
        verified(folder, std::string("--fields rows.h5 --lattice.time_step=1e-4 --theory.mass=") + mass, 1);
    CHECK(json["passed"] == false);
    for (const Json& check : json["checks"]) {
      CHECK(check["failure"].is_null());
      if (check["name"] != "field equations") CHECK(check["unmeasurable"].is_string());
    }
  }
  const Ran ran = delf_program(folder, "verify small.ini --fields rows.h5 --lattice.time_step=1e-4 --out out");
  CHECK(contains(ran.out, "not measurable: 1 of 2 checks"));
  CHECK_FALSE(contains(ran.out, "FAILED"));
}

TEST_CASE("run and verify report the energy that rows have for themselves, where there is one") {
  const Folder folder;
  folder.write("small.ini", scene());
  const auto conserved = [&](const std::string& arguments) {
    REQUIRE(delf_program(folder, "run small.ini --out run --run.steps=60 " + arguments).code == 0);
    return Json::parse(read(folder / "run/summary.json"))["conserved"];
  };
  struct Case {
    std::string arguments, name;
    double most, least_of_all_schemes;
  };
  for (const Case& c : std::vector<Case>{
           {"--theory.name=klein-gordon --initial.state=noise --lattice.stencil=triangle", "quadratic invariant", 1e-13,
            1e-6},
           {"--scheme.method=guo", "energy of (5.15)", 1e-13, 1e-6},
           {"--scheme.method=composition --scheme.order=6 --lattice.space_order=12", "H(q, p) of the composition", 1e-5,
            1e-4},
       }) {
    INFO(c.arguments);
    const Json own = conserved(c.arguments);
    REQUIRE(own.size() == 1);
    CHECK(own[0]["name"] == "energy_own, " + c.name);
    CHECK(own[0]["error_max"] < c.most);
    CHECK(Json::parse(read(folder / "run/summary.json"))["energy_error_max"] > c.least_of_all_schemes);
    CHECK(contains(read(folder / "run/series.csv"), ",residual,energy_own\n"));
    const Json verdict = verified(folder, "--fields run/fields.h5 " + c.arguments, 0);
    CHECK(verdict["energy_own"]["name"] == c.name);
    CHECK(verdict["energy_own"]["first"].get<double>() == Approx(own[0]["initial"].get<double>()).epsilon(1e-12));
    CHECK(contains(read(folder / "out/energy_own.csv"), "time,energy_own\n0.3,"));
  }
  CHECK(conserved("").empty());  // none of leapfrog's for sine-Gordon
  CHECK(verified(folder, "--fields run/fields.h5", 0)["energy_own"].is_null());
  CHECK(!std::filesystem::exists(folder / "out/energy_own.csv"));
}

TEST_CASE("values modulo 2π are found, and verified with verify.unwrap") {
  const Folder folder;
  folder.write("small.ini", scene());
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  copy(folder / "run/fields.h5", folder / "modulo.h5", [](int, std::vector<double>& row) {
    for (double& y : row) y -= 2 * std::numbers::pi * std::floor(y / (2 * std::numbers::pi));
  });
  CHECK(says(verified(folder, "--fields modulo.h5", 1), "Use verify.unwrap = on"));
  const Json unwrapped = verified(folder, "--fields modulo.h5 --verify.unwrap=on --verify.identify=on", 0);
  CHECK(says(unwrapped, "the equations of triangle-vertex."));
  CHECK(verified(folder, "--fields modulo.h5 --theory.fibre=S1", 0)["passed"] == true);
  CHECK(says(verified(folder, "--fields modulo.h5 --theory.fibre=S1 --lattice.length=40", 1), "lattice.length = 20"));
  check_refused(delf_program(folder,
                             "verify small.ini --fields run/fields.h5 --nearby modulo.h5 --nearby run/fields.h5 "
                             "--verify.unwrap=on --out refused"),
                {"unwraps the rows of --fields alone"});
}

TEST_CASE("walls that a scene has fixed are fixed in its rows") {
  const Folder folder;
  folder.write("small.ini", scene("interval"));
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  const auto walls = [&](const std::string& file, int code) {
    const Json json = verified(folder, "--fields " + file, code);
    for (const Json& check : json["checks"])
      if (check["name"] == "fixed walls") return check;
    return Json();
  };
  CHECK(walls("run/fields.h5", 0)["value"] == 0);
  copy(folder / "run/fields.h5", folder / "moving.h5", [](int j, std::vector<double>& row) {
    if (j == 30) row[31] += 1e-6;
  });
  const Json moving = walls("moving.h5", 1);
  CHECK(contains(moving["failure"].get<std::string>(), "The wall at site 31 is fixed in the scene"));
}

TEST_CASE("rows that mix 1e6 and 1e-6 are not accused, and a wrong variation on them is") {
  const Folder folder;
  folder.write(
      "small.ini",
      "[theory]\ndensity = (phi_t^2 - phi_x^2)/2 - phi^4/4\n[lattice]\nstencil = triangle-vertex\nlength = 8\n"
      "sites = 16\ntime_step = 0.3\n[initial]\nstate = formula\nphi = 0\n[run]\nsteps = 9\n[output]\nfigures = off\n");
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  std::string rows;
  for (int j = 0; j < 24; ++j)
    for (int i = 0; i < 16; ++i)
      rows += fmt::format("{:.17g}{}", (random() % 2 == 0 ? 1e6 : 1e-6) * normal(random), i < 15 ? ' ' : '\n');
  folder.write("rows.txt", rows);
  const std::string forms = "--fields rows.txt --verify.checks=forms --verify.moments=2 ";
  CHECK(verified(folder, forms, 0)["checks"].size() > 4);
  CHECK(contains(verified(folder, forms + "--verify.fault=variation", 1).dump(), "is no first variation"));
}

TEST_CASE("rows in other units are verified as they are, by a scene that has no start") {
  const Folder folder;
  const std::string units =
      "[theory]\nname = sine-gordon\n[lattice]\nstencil = leapfrog\nlength = 40\nsites = 64\n"
      "time_step = 0.15625\n[output]\nfigures = off\n";
  folder.write("small.ini", units);
  // φ_tt = 4 φ_xx − 3 sin(φ/3): waves of speed 2, and the field is three times that of sine-Gordon
  constexpr int N = 64;
  constexpr double k = 40.0 / N, h = 0.15625;
  std::vector<std::vector<double>> rows(2, std::vector<double>(N));
  for (int j = 0; j < 2; ++j)
    for (int i = 0; i < N; ++i) rows[j][i] = 9 / std::cosh(0.3 * (i * k - 18) - 0.1 * j * h);
  while (rows.size() < 30) {
    const auto &y = rows.back(), &before = rows[rows.size() - 2];
    std::vector<double> next(N);
    for (int i = 0; i < N; ++i)
      next[i] = 2 * y[i] - before[i] +
                h * h * (4 * (y[(i + N - 1) % N] - 2 * y[i] + y[(i + 1) % N]) / (k * k) - 3 * std::sin(y[i] / 3));
    rows.push_back(next);
  }
  std::string text, table = "row,site,phi\n";
  for (std::size_t j = 0; j < rows.size(); ++j)
    for (int i = 0; i < N; ++i) {
      text += fmt::format("{:.17g}{}", rows[j][i], i < N - 1 ? ' ' : '\n');
      table += fmt::format("{},{},{:.17g}\n", j, i, rows[j][i]);
    }
  folder.write("rows.txt", text);
  CHECK(verified(folder, "--fields rows.txt --theory.speed=2 --theory.scale=3", 0)["passed"] == true);
  CHECK(says(verified(folder, "--fields rows.txt --theory.scale=3", 1), "theory.speed = 2"));
  CHECK(says(verified(folder, "--fields rows.txt --theory.speed=2", 1), "No time step, length or coefficient"));
  // Its Hessian is that of its gradient.
  folder.write("table.csv", table);
  const std::string from_file = "--theory.speed=2 --theory.scale=3 --initial.state=file --initial.file=table.csv ";
  const Json whole = verified(folder, from_file + "--run.steps=20 --verify.checks=derivatives,newton,forms", 0);
  CHECK(whole["checks"].size() > 6);
  check_refused(delf_program(folder, "run small.ini --theory.speed=2 --initial.state=breather --run.steps=9"),
                {"--theory.speed = 2", "is of rows of a file"});
  check_refused(delf_program(folder, "run small.ini"), {"neither run.until nor run.steps is given"});
}

TEST_CASE("a pendulum's g and L, and a planet's GM, are keys") {
  const Folder folder;
  // velocity Verlet; of the pendulum modulo 2π
  constexpr double h = 0.02, g = 9.81, arm = 0.7, GM = 3.986;
  double q = 1.2, p = 6.5, x = 1, y = 0, u = 0, v = 1.9;
  std::string pendulum, planet;
  for (int j = 0; j < 120; ++j) {
    pendulum += fmt::format("{:.17g}\n", q - 2 * std::numbers::pi * std::floor(q / (2 * std::numbers::pi)));
    planet += fmt::format("{:.17g},{:.17g}\n", x, y);
    p -= h / 2 * g / arm * std::sin(q), q += h * p, p -= h / 2 * g / arm * std::sin(q);
    const auto kick = [&] {
      const double r = std::hypot(x, y), by = h / 2 * GM / (r * r * r);
      u -= by * x, v -= by * y;
    };
    kick(), x += h * u, y += h * v, kick();
  }
  folder.write("pendulum.csv", pendulum);
  folder.write("planet.csv", planet);
  const auto passes = [&](const std::string& theory, const std::string& file, const std::string& keys, int code) {
    folder.write("small.ini", "[theory]\nname = " + theory +
                                  "\n[lattice]\nspace = point\nstencil = vertex\ntime_step = "
                                  "0.02\n[output]\nfigures = off\n");
    CHECK(verified(folder, "--fields " + file + keys, code)["passed"] == (code == 0));
  };
  passes("pendulum", "pendulum.csv", " --theory.gravity=9.81 --theory.arm=0.7 --theory.fibre=S1", 0);
  passes("pendulum", "pendulum.csv", " --theory.gravity=9.81 --theory.arm=0.7", 1);
  passes("pendulum", "pendulum.csv", " --theory.gravity=9.8 --theory.arm=0.7 --verify.unwrap=on", 1);
  passes("kepler", "planet.csv", " --theory.gm=3.986", 0);
  passes("kepler", "planet.csv", "", 1);
}

TEST_CASE("parameters that a file of rows was made with, and a thinned one, are refused with both values") {
  const Folder folder;
  folder.write("small.ini", scene());
  REQUIRE(delf_program(folder, "run small.ini --out run --theory.mass=1.25").code == 0);
  CHECK(verified(folder, "--fields run/fields.h5 --theory.mass=1.25", 0)["passed"] == true);
  check_refused(delf_program(folder, "verify small.ini --fields run/fields.h5 --out refused"),
                {"was made with theory.mass = 1.25, and the scene has 1"});
  folder.write(
      "no-start.ini",
      "[theory]\nname = sine-gordon\n[lattice]\nstencil = triangle-vertex\nlength = 20\nsites = 32\ntime_step = 0.3\n");
  check_refused(
      delf_program(folder, "verify no-start.ini --fields run/fields.h5 --theory.mass=1.25 --boundary.winding=1"),
      {"was made with boundary.winding = 0, and the scene has 1"});
  REQUIRE(delf_program(folder, "run small.ini --out walls --lattice.space=interval --boundary.left=natural").code == 0);
  check_refused(delf_program(folder, "verify small.ini --fields walls/fields.h5 --lattice.space=interval"),
                {"was made with boundary.left = natural, and the scene has fixed"});
  check_refused(delf_program(folder, "verify small.ini --fields walls/fields.h5 --lattice.length=20.64516129032258"),
                {"was made with lattice.space = interval, and the scene has circle"});
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  const Ran other = delf_program(folder, "verify small.ini --fields run/fields.h5 --lattice.stencil=triangle");
  CHECK(contains(other.out, "recorded with lattice.stencil = triangle-vertex"));
  REQUIRE(delf_program(folder, "run small.ini --out thin --output.every=3").code == 0);
  check_refused(delf_program(folder, "verify small.ini --fields thin/fields.h5 --out refused"),
                {"of 3 rows one was recorded", "output.every = 1"});
}

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
  const std::vector<double> space(static_cast<std::size_t>(rows.sites()));
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
  CHECK(says(longer, "try lattice.length = 20."));
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

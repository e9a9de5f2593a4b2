// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_file.hpp"
#include "tools/files/fields_reader.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/scene/keys.hpp"

using namespace delf::testing;
using Json = nlohmann::json;

namespace {

// 40 steps of the symmetric rectangle on 32 sites
std::string scene(const std::string& more = "") {
  return "[theory]\nname = sine-gordon\n[lattice]\nlength = 20\nsites = 32\ncourant = 0.5\n"
         "[initial]\nstate = breather\n[run]\nsteps = 40\n[output]\nfigures = off\n" +
         more;
}

struct Verified : Ran {
  Json json;

  bool has(const std::string& name) const {
    return std::ranges::any_of(json["checks"], [&](const Json& c) { return c["name"] == name; });
  }
  const Json& check(const std::string& name) const {
    for (const Json& c : json["checks"])
      if (c["name"] == name) return c;
    FAIL("there is no check " << name << " in\n" << out);
    return json;
  }
  std::vector<std::string> failed() const {
    std::vector<std::string> names;
    for (const Json& c : json["checks"])
      if (!c["passed"]) names.push_back(c["name"]);
    return names;
  }
};

// Of a file, or a shipped scene; verify.json must be there, and agree with the exit code.
Verified verified(const Folder& folder, const std::string& arguments, int code) {
  std::filesystem::remove_all(folder / "out");
  Verified v{delf_program(folder, "verify " + arguments + " --output.figures=off --out out"), {}};
  INFO(arguments << "\n" << v.out << v.err);
  CHECK(v.code == code);
  REQUIRE(std::filesystem::exists(folder / "out/verify.json"));
  v.json = Json::parse(read(folder / "out/verify.json"));
  CHECK(v.json["passed"] == (code == 0));
  CHECK_FALSE(contains(v.out, "nan"));
  return v;
}

Verified verified_text(const Folder& folder, const std::string& text, const std::string& arguments, int code) {
  folder.write("small.ini", text);
  return verified(folder, "small.ini " + arguments, code);
}

void refused(const Folder& folder, const std::string& arguments, const std::string& reason) {
  const Ran ran = delf_program(folder, "verify " + arguments + " --output.figures=off --out refused");
  INFO(arguments);
  check_refused(ran, {reason});
  CHECK_FALSE(std::filesystem::exists(folder / "refused"));
}

// The first "row J, site I" of a text is no further than a row and a site from this.
void check_near(const std::string& text, int row, int site) {
  INFO(text);
  int j = -1, i = -1;
  const std::size_t at = text.find("row ");
  REQUIRE(at != std::string::npos);
  REQUIRE(std::sscanf(text.c_str() + at, "row %d, site %d", &j, &i) == 2);
  CHECK(std::abs(j - row) <= 1);
  CHECK(std::abs(i - site) <= 1);
}

bool all_forms(const std::vector<std::string>& names) {
  return !names.empty() && std::ranges::all_of(names, [](const auto& n) { return n.starts_with("form formula, "); });
}

std::string without_seconds(const std::string& json) {
  std::string text;
  for (const std::string& line : lines(json))
    if (!contains(line, "\"seconds\"")) text += line + "\n";
  return text;
}

// A copy of recorded rows in which one value is another.
void edit(const std::filesystem::path& from, const std::filesystem::path& to, int row, int site, double by) {
  const delf::FieldsReader rows(from);
  const std::vector<double> space(rows.sites());
  delf::FieldsFile file(to, space, rows.frames(), "", rows.winding().value_or(0));
  for (int j = 0; j < rows.frames(); ++j) {
    auto values = rows.row(j);
    if (j == row) values[site] += by;
    file.append(*rows.time(j), {values, {}, {}});
  }
  file.close();
}

}  // namespace

TEST_CASE("verify passes every stencil, and says so on stdout and in verify.json") {
  const Folder folder;
  const auto stencil = GENERATE(as<std::string>(), "triangle", "triangle-vertex", "rectangle", "rectangle-symmetric",
                                "hexagon", "six-tuple", "nine-tuple");
  const Verified v = verified_text(folder, scene(), "--run.steps=20 --lattice.stencil=" + stencil, 0);
  INFO(v.out);
  CHECK(complaints(v) == "");
  CHECK(v.failed().empty());
  CHECK(contains(v.out, "passed: "));
  CHECK(contains(v.out, "out: verify.json\n"));
  for (const char* name :
       {"field equations", "form formula, rectangle", "form formula, staircase", "form formula, hole",
        "form formula, slab", "form formula, random", "local identity of the forms", "symplectic form, slab to slab",
        "derivatives: gradient", "derivatives: Jacobian"})
    CHECK(v.check(name)["passed"] == true);
  CHECK(v.check("form formula, hole")["value"] <= 1e-13);
  CHECK_FALSE(std::filesystem::exists(folder / "out/figures"));
}

TEST_CASE("verify passes on intervals, points, elements, moving meshes and constraints") {
  const Folder folder;
  const auto arguments =
      GENERATE(as<std::string>(), "interval --lattice.sites=33 --run.steps=20",
               "interval --lattice.sites=33 --run.steps=20 --boundary.left=natural --lattice.stencil=rectangle",
               "interval --lattice.sites=33 --run.steps=20 --boundary.left=natural --lattice.stencil=triangle",
               "interval --lattice.sites=32 --run.steps=20 --lattice.stencil=triangle-vertex",
               "interval --lattice.sites=32 --run.steps=20 --boundary.right=fixed",
               "kink --theory.fibre=S1 --lattice.sites=65 --run.steps=20",
               "kink-train --lattice.length=30 --lattice.sites=60 --boundary.winding=3 --run.steps=20",
               "kepler --run.until=2", "pendulum --run.until=3 --lattice.stencil=vertex", "r-adaptive --run.steps=20",
               "spacetime-element --lattice.sites=20 --run.steps=10",
               "breather --scheme.method=composition --lattice.sites=40 --run.steps=12",
               "kink --scheme.method=composition --scheme.order=2 --lattice.sites=40 --run.steps=12",
               "wave-map --lattice.sites=12 --run.steps=12");
  CHECK(verified(folder, arguments, 0).failed().empty());
}

TEST_CASE("kernels with nodes between rows are reversed without their processor, and their own rows verified") {
  const Folder folder;
  const std::string b6 =
      "breather --scheme.method=processed --lattice.sites=40 --lattice.space_order=6 --run.steps=12 ";
  CHECK(verified(folder, b6, 0).check("time reversal")["value"] < 1e-13);
  REQUIRE(delf_program(folder, "run " + b6 + "--scheme.processor=off --output.every=1 --output.figures=off --out run")
              .code == 0);
  const std::string rows = " --fields run/fields.h5 ";
  CHECK(verified(folder, b6 + "--scheme.processor=off" + rows, 0).failed().empty());
  CHECK(verified(folder, b6 + "--scheme.processor=off --lattice.pairs=suited" + rows, 1).failed().size() == 1);
  refused(folder, b6 + rows, "have its processor undone");
}

TEST_CASE("verify.json has fixed fields for each check, and is the same to the byte but for the seconds") {
  const Folder folder;
  const Verified v = verified_text(folder, scene(), "", 0);
  for (const char* key : {"version", "scene", "theory", "stencil", "method", "sites", "time_step", "seed", "subject",
                          "status", "seconds", "stencils", "passed", "checks", "measured", "left_out", "regions"}) {
    INFO(key);
    CHECK(v.json.contains(key));
  }
  CHECK(v.json["status"] == "done");
  CHECK(v.json["seed"] == 1);
  CHECK(v.json["subject"] == "rows computed here");
  REQUIRE(v.json["checks"].size() > 8);
  for (const Json& check : v.json["checks"]) {
    INFO(check.dump());
    for (const char* key : {"name", "region"}) CHECK(check[key].is_string());
    for (const char* key : {"value", "tolerance", "normaliser"}) CHECK(check[key].is_number());
    CHECK(check["count"].is_number_integer());
    CHECK(check["passed"].is_boolean());
    CHECK(check["failure"].is_null());
  }

  const std::string first = read(folder / "out/verify.json");
  verified(folder, "small.ini", 0);
  CHECK(without_seconds(read(folder / "out/verify.json")) == without_seconds(first));
  CHECK(contains(first, "\"seconds\""));

  const Verified other = verified(folder, "small.ini --run.seed=2", 0);
  CHECK(other.json["seed"] == 2);
  CHECK(other.json["regions"] != v.json["regions"]);
}

TEST_CASE("schemes that come from no Lagrangian fail the form formula on every kind of region, in words") {
  const Folder folder;
  const auto method = GENERATE(as<std::string>(), "vu-quoc-li", "guo", "damped");
  INFO(method);
  const Verified v = verified_text(folder, scene(), "--scheme.method=" + method, 1);
  CHECK(v.check("field equations")["passed"] == true);
  for (const char* kind : {"rectangle", "staircase", "hole", "slab", "random"}) {
    const Json& check = v.check(std::string("form formula, ") + kind);
    CHECK(check["passed"] == false);
    CHECK(check["value"] > 1e-6);
    const std::string words = check["failure"];
    INFO(words);
    CHECK(contains(words, "The equations are not those of an action: the equation at row "));
    CHECK(contains(words, "comes from no Lagrangian"));
    CHECK(contains(check["region"].get<std::string>(), "rows "));
  }
  // the report says it once, for all of them
  CHECK(contains(v.out, "FAILED: form formula, slab\n"));
  const std::size_t once = v.out.find("The equations are not those of an action");
  REQUIRE(once != std::string::npos);
  CHECK(v.out.find("The equations are not those of an action", once + 1) == std::string::npos);
  CHECK_FALSE(v.has("local identity of the forms"));
  // What damps knows the direction of time; the two that conserve an energy do not.
  CHECK(v.check("time reversal")["passed"] == (method != "damped"));
}

TEST_CASE("faults planted in a composition are found, between its sub-steps too") {
  const Folder folder;
  const std::string composition = "breather --scheme.method=composition --lattice.sites=40 --run.steps=12 ";
  CHECK(all_forms(verified(folder, composition + "--verify.fault=variation", 1).failed()));
  CHECK(verified(folder, composition + "--verify.fault=field", 1).failed() ==
        std::vector<std::string>{"field equations"});
  CHECK(verified(folder, composition + "--verify.fault=sign", 1).check("derivatives: gradient")["passed"] == false);
}

TEST_CASE("a planted wrong variation fails the form formula alone, and is located") {
  const Folder folder;
  const Verified v = verified_text(folder, scene(), "--verify.fault=variation", 1);
  CHECK(all_forms(v.failed()));
  for (const std::string& name : v.failed()) {
    const std::string words = v.check(name)["failure"];
    INFO(words);
    CHECK(words.starts_with("V is no first variation: at row "));
    int row = -1, site = -1, first = 0, last = 0;
    CHECK(std::sscanf(words.c_str(), "V is no first variation: at row %d, site %d", &row, &site) == 2);
    REQUIRE(std::sscanf(v.check(name)["region"].get<std::string>().c_str(), "rows %d to %d", &first, &last) == 2);
    CHECK(first <= row);
    CHECK(row <= last);
  }
}

TEST_CASE("a planted wrong sign in the derivatives is distinguished from other faults") {
  const Folder folder;
  const Verified v = verified_text(folder, scene(), "--verify.fault=sign", 1);
  const auto says = [&](const std::string& name, const std::string& words) {
    INFO(name);
    CHECK(v.check(name)["passed"] == false);
    CHECK(contains(v.check(name)["failure"].get<std::string>(), words));
  };
  says("field equations", "rows 1 to 39, sites 0 to 31");
  says("form formula, rectangle", "look at the derivatives of its Lagrangian");
  says("local identity of the forms", "not symmetric");
  says("derivatives: gradient", "differ by a factor -1");
  CHECK(contains(v.check("derivatives: gradient")["region"].get<std::string>(), "value 0 (vertex {0, 0}"));
}

TEST_CASE("a field edited at one site is found there, and the scheme still passes") {
  const Folder folder;
  const Verified v = verified_text(folder, scene(), "--verify.fault=field", 1);
  CHECK(v.failed() == std::vector<std::string>{"field equations"});
  const Json& check = v.check("field equations");
  check_near(check["region"], 20, 16);
  CHECK(contains(check["failure"].get<std::string>(), "rows 19 to 21, sites 15 to 17"));
  CHECK(contains(v.out, "FAILED: 1 of "));
}

TEST_CASE("a fault planted where no check looks does not pass") {
  const Folder folder;
  const Verified v = verified_text(folder, scene(), "--verify.fault=variation --verify.checks=equations", 1);
  CHECK(v.failed() == std::vector<std::string>{"planted fault: variation"});
  CHECK(contains(v.out, "no check that was made looks for it"));
}

TEST_CASE("rows of a file edited at one site fail there, and the original rows pass") {
  const Folder folder;
  folder.write("small.ini", scene("every = 1\n"));
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  const Verified good = verified(folder, "small.ini --fields run/fields.h5", 0);
  CHECK(good.json["subject"] == "rows of run/fields.h5");
  CHECK(contains(good.out, "left out"));

  struct Edit {
    int row, site;
  };
  const Edit e = GENERATE(values<Edit>({{17, 9}, {1, 0}, {38, 31}}));
  edit(folder / "run/fields.h5", folder / "edited.h5", e.row, e.site, 1e-7);
  const Verified v = verified(folder, "small.ini --fields edited.h5", 1);
  CHECK(v.failed() == std::vector<std::string>{"field equations"});
  check_near(v.check("field equations")["region"], e.row, e.site);
}

TEST_CASE("recorded runs of all kinds of schemes are verified from their files") {
  const Folder folder;
  const auto scene = GENERATE(as<std::string>(), "collision --lattice.sites=51",
                              "collision --lattice.sites=50 --lattice.stencil=hexagon", "wave-map --lattice.sites=12",
                              "r-adaptive", "spacetime-element --lattice.sites=20", "kepler",
                              "breather --scheme.method=composition --lattice.sites=40",
                              "kink --theory.fibre=S1 --lattice.sites=51", "interval --lattice.sites=33");
  const std::string arguments = scene + " --run.steps=20";
  const Ran ran = delf_program(folder, "run " + arguments + " --output.every=1 --output.figures=off --out run");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  const Verified v = verified(folder, arguments + " --fields run/fields.h5", 0);
  CHECK(v.check("field equations")["passed"] == true);
}

TEST_CASE("files of rows that cannot be verified are refused in one line") {
  const Folder folder;
  folder.write("small.ini", scene("every = 1\n"));
  folder.write("text.h5", "rows\n");
  REQUIRE(delf_program(folder, "run small.ini --out run").code == 0);
  REQUIRE(delf_program(folder, "run small.ini --run.steps=1 --out short").code == 0);
  REQUIRE(delf_program(folder, "run small.ini --run.steps=30 --out shorter").code == 0);
  edit(folder / "run/fields.h5", folder / "nan.h5", 20, 3, std::nan(""));
  const std::string fields = "small.ini --fields run/fields.h5 ";
  refused(folder, "small.ini --fields missing.h5", "--fields missing.h5: no such file");
  folder.write("no-start.ini", "[theory]\nname = wave\n[lattice]\nlength = 9\nsites = 9\ntime_step = 0.1\n");
  refused(folder, "no-start.ini --fields missing.h5", "command line: --fields missing.h5: no such file");
  folder.write("rows.csv.gz", "\x1f\x8b");
  refused(folder, "small.ini --fields rows.csv.gz", "is compressed; unpack it by gunzip");
  refused(folder, "small.ini --fields text.h5", "--fields text.h5: is not an HDF5 file");
  refused(folder, "small.ini --fields short/fields.h5", "has 2 whole rows, and an equation reads 3");
  refused(folder, fields + "--lattice.sites=33", "has 32 sites, and the lattice has 33");
  refused(folder, fields + "--lattice.courant=0.25", "apart, and the time step is");
  refused(folder, fields + "--nearby nan.h5", "give them in pairs");
  refused(folder, fields + "--nearby shorter/fields.h5 --nearby nan.h5", "has 31 rows");
  refused(folder, fields + "--nearby run/fields.h5 --nearby nan.h5", "is given twice");
  refused(folder, "small.ini --nearby nan.h5 --nearby nan.h5", "near to which rows?");

  // seen only when its row is read
  const Ran ran = delf_program(folder, "verify small.ini --fields nan.h5");
  CHECK(ran.code == 2);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, "--fields nan.h5: /field is not finite in frame 20 at site 3"));
}

TEST_CASE("Noether: a shift is a symmetry of the wave equation, and none of sine-Gordon") {
  const Folder folder;
  const Verified wave =
      verified_text(folder, scene(), "--theory.name=wave --initial.state=noise --verify.generator=1", 0);
  CHECK(wave.check("Noether, generator (1)")["value"] <= 1e-13);
  CHECK(wave.check("Noether, generator (1)")["samples"] > 10);
  CHECK(wave.check("symmetry of L, generator (1)")["value"] <= 1e-13);

  const Verified none = verified(folder, "small.ini --verify.generator=1", 1);
  CHECK(none.failed() == std::vector<std::string>{"symmetry of L, generator (1)"});
  CHECK_FALSE(none.has("Noether, generator (1)"));
  CHECK(contains(none.out, "generator (1) is not a symmetry"));

  const Verified forced = verified(folder, "small.ini --verify.generator=1 --verify.force=on", 1);
  CHECK(forced.check("Noether, generator (1)")["value"] >= 1e-4);
  CHECK(forced.failed().size() == 2);
}

TEST_CASE("Noether: symmetries that theories declare are found without being asked for") {
  const Folder folder;
  struct Case {
    const char* arguments;
    std::vector<const char*> names;
  };
  const Case c = GENERATE(
      values<Case>({{"complex-klein-gordon --lattice.length=10 --lattice.sites=40 --lattice.stencil=triangle-vertex "
                     "--run.steps=20 --initial.wavenumber=1",
                     {"charge_u1"}},
                    {"kepler --run.until=2", {"angular_momentum"}},
                    {"wave-map --lattice.sites=12 --run.steps=12", {"rotation_x", "rotation_y", "rotation_z"}}}));
  const Verified v = verified(folder, c.arguments, 0);
  for (const std::string name : c.names) {
    CHECK(v.check("symmetry of L, " + name)["passed"] == true);
    CHECK(v.check("Noether, " + name)["value"] <= 1e-13);
  }
}

TEST_CASE("Noether: generators of several fields, and those that say nothing") {
  const Folder folder;
  const std::string charged =
      "complex-klein-gordon --lattice.length=10 --lattice.sites=20 --run.steps=12 "
      "--lattice.stencil=triangle-vertex --initial.wavenumber=1 --verify.checks=noether --verify.generator=";
  verified(folder, charged + "'-2.5E-1*phi2, phi1*0.25'", 0);
  CHECK(contains(verified(folder, charged + "'phi2, phi1'", 1).out, "generator (phi2, phi1) is not a symmetry"));
  refused(folder, charged + "1", "has 1 part; give one for each of phi1, phi2");
  refused(folder, charged + "'0, -0*phi1'", "changes no field");
  refused(folder, charged + "'phi1*phi2, 0'", "is not linear in phi1");
  for (const char* unreadable : {"'phi1+, 0'", "'psi, 0'", "'1e300*1e300, 0'"}) {
    const Ran ran = delf_program(folder, "verify " + charged + unreadable);
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "verify.generator: character "));
  }
}

TEST_CASE("regions and checks are those of the scene") {
  const Folder folder;
  const Verified v = verified_text(
      folder, scene("[verify]\nregions = slab, 0:4x3:9+5:8x6:12-2:2x5:5\nchecks = forms\nvariations = 3\n"), "", 0);
  CHECK(v.json["checks"].size() == 4);
  CHECK(v.has("form formula, slab"));
  CHECK(v.has("form formula, given 0:4x3:9+5:8x6:12-2:2x5:5"));
  CHECK_FALSE(v.has("field equations"));
  CHECK_FALSE(v.has("form formula, hole"));
  CHECK(verified(folder, "small.ini --verify.checks=newton", 0).json["checks"].size() == 1);

  refused(folder, "small.ini --verify.regions=hol", "hol is no kind of region; did you mean hole?");
  refused(folder, "small.ini --verify.regions=0:4x30:64", "\"0:4x30:64\" is no region");
  refused(folder, "small.ini --verify.regions=-0:4x3:9", "\"-0:4x3:9\" is no region");
  refused(folder, "small.ini --verify.checks=form", "form is no check; did you mean forms?");
  refused(folder, "small.ini --verify.fault=feild", "--verify.fault = feild");
  refused(folder, "small.ini --verify.tolerance=0", "must be above 0");
  refused(folder, "small.ini --verify.moments=0", "must be at least 1");
}

TEST_CASE("tolerance, variations and moments do what they say") {
  const Folder folder;
  const Verified strict = verified_text(folder, scene(), "--verify.tolerance=1e-20", 1);
  CHECK(strict.check("form formula, hole")["tolerance"] == 1e-20);
  const auto samples = [&](const std::string& arguments) {
    return verified(folder, "small.ini --verify.checks=forms --verify.regions=slab " + arguments, 0)
        .check("form formula, slab")["samples"]
        .get<int>();
  };
  CHECK(samples("--verify.moments=1 --verify.variations=1") < samples("--verify.moments=1 --verify.variations=4"));
  CHECK(samples("--verify.moments=1") < samples("--verify.moments=5"));
  CHECK(samples("--verify.moments=2147483647") > 0);  // as many as there are
}

TEST_CASE("scenes of few steps are verified over as many rows as regions take") {
  const Folder folder;
  const int steps = GENERATE(0, 1, 2, 5);
  verified_text(folder, scene(), "--run.steps=" + std::to_string(steps), 0);
}

TEST_CASE("help verify lists every key of its section") {
  const auto in_one_line = [](const std::string& text) {
    std::string line;
    for (const std::string& part : delf::wrapped(text, text.size())) line += part;
    return line;
  };
  const Folder folder;
  const Ran ran = delf_program(folder, "help verify");
  CHECK(ran.code == 0);
  int keys = 0;
  for (const auto& key : delf::keys())
    if (key.key.starts_with("verify.")) {
      ++keys;
      CHECK(contains(ran.out, std::string(key.key)));
      CHECK(contains(in_one_line(ran.out), std::string(key.help)));
    }
  CHECK(keys == 10);
}

TEST_CASE("an interrupted verification writes what it has found, and ends with exit code 130") {
  const Folder folder;
  const auto signal = GENERATE(as<std::string>(), "INT", "TERM");
  const Ran ran = shell(folder, "'" + program_path() +
                                    "' verify collision --run.until=1e7 --output.figures=off --out cut & p=$!; "
                                    "while [ ! -d cut ]; do sleep 0.05; done; sleep 0.3; kill -" +
                                    signal + " $p; wait $p");
  INFO(ran.err);
  CHECK(ran.code == 130);
  CHECK(contains(ran.out, "not finished (interrupted)"));
  const auto json = Json::parse(read(folder / "cut/verify.json"));
  CHECK(json["status"] == "interrupted");
  CHECK(json["passed"] == false);
  CHECK_FALSE(json["checks"].empty());
}

TEST_CASE("numerics that fail end with exit code 3, and verify.json has what was found before") {
  const Folder folder;
  const Verified v = verified(folder,
                              "collision --lattice.sites=40 --lattice.stencil=triangle-vertex --lattice.courant=1.5 "
                              "--run.steps=600",
                              3);
  CHECK(v.json["status"] == "not-finite");
  CHECK(v.failed().empty());
  CHECK(lines(v.err).size() == 1);
  CHECK(contains(v.err, "the field is no longer finite"));
  CHECK(contains(v.out, "not finished (not-finite)"));

  const Verified hard = verified_text(folder, scene(),
                                      "--initial.state=noise --initial.amplitude=3 --theory.mass=40 "
                                      "--lattice.stencil=rectangle --scheme.max_iterations=1",
                                      3);
  CHECK(hard.json["status"] == "no-convergence");
  CHECK(lines(hard.err).size() == 1);
}

TEST_CASE("results of verify that cannot be put anywhere end with exit code 4") {
  const Folder folder;
  folder.write("small.ini", scene());
  folder.write("file", "");
  for (const char* out : {"file", "file/below", "/dev/null/below"}) {
    const Ran ran = delf_program(folder, std::string("verify small.ini --run.steps=3 --out ") + out);
    INFO(ran.err);
    CHECK(ran.code == 4);
    CHECK(lines(ran.err).size() == 1);
  }
  const Ran full = delf_program(folder, "verify small.ini --out full", "ulimit -f 1;");
  CHECK(full.code == 4);
  CHECK(contains(full.err, "full/verify.json"));
}

TEST_CASE("verify draws figures, and takes away those of an earlier time") {
  const Folder folder;
  folder.write("small.ini", scene());
  const std::vector<std::string> names{"residual-map", "residual-region", "worst-region", "time-reversal"};
  const Ran drawn = delf_program(folder, "verify small.ini --output.figures=on --out out");
  INFO(drawn.err);
  REQUIRE(drawn.code == 0);
  CHECK(contains(drawn.out, "out: verify.json figures\n"));
  for (const std::string& name : names) CHECK(read(folder / ("out/figures/" + name + ".png")).starts_with("\x89PNG"));
  REQUIRE(delf_program(folder, "verify small.ini --out out").code == 0);
  for (const std::string& name : names) CHECK_FALSE(std::filesystem::exists(folder / ("out/figures/" + name + ".png")));

  const Ran without = delf_program(folder, "verify small.ini --output.figures=on --out out", "PATH=/nowhere");
  CHECK(without.code == 0);
  CHECK(contains(without.err, "gnuplot"));
}

TEST_CASE("rows of a NumPy program are verified from outside, and another method is found out") {
  const Folder folder;
  const std::string with = python(folder), examples = scenes_folder() + "/../examples/";
  const auto method = GENERATE(as<std::string>(), "symplectic", "runge-kutta");
  INFO(method);
  REQUIRE(shell(folder, with + " '" + examples + "leapfrog.py' " + method + " x").code == 0);
  const int code = method == "symplectic" ? 0 : 1;
  const std::string fields = "'" + examples + "leapfrog.ini' --fields x/fields.h5 ";

  const Verified alone = verified(folder, fields, code);
  // those that fail are not judged a second time, beside the force
  CHECK(alone.json["checks"].size() == (code == 0 ? 3 : 1));
  CHECK(alone.check("field equations")["passed"] == (code == 0));
  if (code == 1) CHECK(contains(alone.out, "12672 of 12672 equations do not hold"));

  const std::string pair = "--nearby x/nearby-a.h5 --nearby x/nearby-b.h5 ";
  const Verified near = verified(folder, fields + pair, code);
  const Verified nearer = verified(folder, fields + pair + "--nearby x/nearby-a2.h5 --nearby x/nearby-b2.h5", code);
  const char* slab = "form formula by differences, slab";
  CHECK(nearer.check(slab)["passed"] == (code == 0));
  CHECK(nearer.check(slab)["tolerance"] < 0.01 * near.check(slab)["tolerance"].get<double>());
  CHECK(contains(nearer.check(slab)["region"].get<std::string>(), "extrapolated"));
  if (code == 1) {
    CHECK(near.failed().size() > 2);
    CHECK(nearer.failed().size() == nearer.json["checks"].size());
  }
}

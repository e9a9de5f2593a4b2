// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;

namespace {

const std::string rest =
    "[lattice]\nlength = 20\nsites = 63\ncourant = 0.5\n[run]\nsteps = 60\n[output]\nfigures = off\nevery = 20\n";
std::string scene(const std::string& theory, const std::string& initial = "state = noise") {
  return "[theory]\n" + theory + "\n[initial]\n" + initial + "\n" + rest;
}
const std::string two_fields =
    "fields = u, v\nparameters = m = 1, g = 0.3\n"
    "density = 0.5*(u_t^2 - u_x^2 + v_t^2 - v_x^2) + m^2*(cos(u) + cos(v) - 2) + g*(cos(u - v) - 1)";

}  // namespace

TEST_CASE("every command works on a theory that is given as text") {
  const Folder folder;
  folder.write("own.ini", scene("density = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.025*m*phi^4\nparameters = m = 2"));
  folder.write("two.ini", scene(two_fields));
  for (const char* arguments :
       {"run own.ini", "plan own.ini", "verify own.ini", "run two.ini", "verify two.ini --run.steps=10",
        "run own.ini --lattice.stencil=triangle-vertex", "run own.ini --scheme.method=composition",
        "verify own.ini --scheme.method=spacetime --run.steps=10", "run two.ini --lattice.space=interval"}) {
    const Ran ran = delf_program(folder, arguments);
    INFO(arguments << "\n" << ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK(complaints(ran) == "");
  }
  CHECK(nlohmann::json::parse(read(folder / "results/two/summary.json"))["theory"] == "text");
}

TEST_CASE("parameters of a text are keys, and the scene of a run gives the same rows to the bit") {
  const Folder folder;
  folder.write("two.ini", scene(two_fields, "u = sin(2*pi*x/L)\nv = 0.1*g\nu_t = cos(2*pi*x/L)"));
  REQUIRE(delf_program(folder, "run two.ini --theory.g=0.7 --out first").code == 0);
  REQUIRE(delf_program(folder, "run first/scene.ini --out again").code == 0);
  REQUIRE(delf_program(folder, "run two.ini --out other").code == 0);
  const auto last = [&](const char* name) {
    const delf::FieldsReader fields(folder / (std::string(name) + "/fields.h5"));
    return fields.row(fields.frames() - 1);
  };
  CHECK(last("first") == last("again"));
  CHECK(last("first") != last("other"));
  CHECK(read(folder / "first/scene.ini") == read(folder / "again/scene.ini"));
  CHECK(contains(read(folder / "first/scene.ini"), "\ng = 0.7\n"));
}

TEST_CASE("a solution as text is what errors are measured against") {
  const Folder folder;
  const auto error = [&](const std::string& keys) {
    const Ran ran = delf_program(folder, "run sine-gordon-text --run.until=10 --output.figures=off --out out " + keys);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    return nlohmann::json::parse(read(folder / "out/summary.json"))["error_linf"].get<double>();
  };
  const double coarse = error(""), fine = error("--lattice.sites=765");
  CHECK(coarse < 1e-2);
  CHECK(coarse / fine > 3.8);  // second order
  CHECK(error("--theory.v=0.2 --theory.x0=30") < 1e-2);
  CHECK(error("--exact.phi='4*atan(exp((x - x0 - 0.4*t)/sqrt(0.84)))'") < 1e-2);
}

TEST_CASE("a formula winds around a circle as often as it says") {
  const Folder folder;
  folder.write("kink.ini", scene("name = sine-gordon", "phi = 4*atan(exp(x - L/2))"));
  const Ran ran = delf_program(folder, "run kink.ini --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(nlohmann::json::parse(read(folder / "out/summary.json"))["winding"] == 1);
}

TEST_CASE("bad texts in a scene are refused in one line with the place") {
  const Folder folder;
  const auto run = [&](const std::string& theory, const std::string& initial = "state = noise",
                       const std::string& keys = "") {
    folder.write("bad.ini", scene(theory, initial));
    return delf_program(folder, "run bad.ini " + keys);
  };
  check_refused(run("density = 0.5*phi_t^2 + * 3"),
                {"bad.ini:2: theory.density: character 15, at \"* 3\": expected a number, a name or (, found \"*\""});
  check_refused(run("density = 0.5*ph_t^2"),
                {"bad.ini:2: theory.density: character 5, at \"ph_t^2\": unknown name ph_t; did you mean phi_t?"});
  check_refused(run("density = 0.5*phi_t^2", "phi = sin(y)"),
                {"bad.ini:4: initial.phi: character 5, at \"y)\": unknown name y"});
  check_refused(run("density = 0.5*phi_t^2", "state = noise", "--theory.density='abs(phi)'"),
                {"command line: theory.density: character 1, at \"abs(phi)\": abs is not differentiable"});
  check_refused(run("density = 0.5*phi_x^2"), {"bad.ini:2: theory.density: does not determine the field phi: phi_t"});
  check_refused(run("density = 0.5*u_t^2\nfields = u, v"), {"does not determine the field v"});
  check_refused(run("density = 0.5*phi_t^2\nparameters = m"), {"bad.ini:3: theory.parameters", "is not NAME = NUMBER"});
  check_refused(run("density = 0.5*phi_t^2\nparameters = x = 1"),
                {"bad.ini:3: theory.parameters", "has a meaning already"});
  check_refused(run("density = 0.5*phi_t^2\nparameters = name = 1"), {"theory.name has a meaning already"});
  check_refused(run("density = 0.5*phi_t^2\nparameters = mu = 1\nmo = 2"),
                {"bad.ini:4: theory.mo: unknown key; did you mean theory.mu?"});
  check_refused(run("density = 0.5*phi_t^2\nparameters = mu = 1", "state = noise", "--theory.mu=abc"),
                {"command line: --theory.mu = abc: is not a number"});
  check_refused(run("density = 0.5*phi_t^2\nname = phi4"), {"theory.density is given too; keep one of them"});
  check_refused(run("name = text"), {"theory.density: must be given"});
  check_refused(run("density = 0.5*phi_t^2", "phi_t = 1"), {"initial.phi: must be given"});
  check_refused(run("density = 0.5*phi_t^2", "state = kink"), {"not a state of text"});
  std::string deep = "density = ";
  deep.append(100'000, '(');
  check_refused(run(deep), {"bad.ini:2: theory.density", "100000 characters, more than"});
}

TEST_CASE("the command line chooses between a density and the name of a theory") {
  const Folder folder;
  folder.write("own.ini", scene("density = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.025*m*phi^4\nparameters = m = 2"));
  folder.write("named.ini", scene("name = phi4"));
  const auto theory = [&](const std::string& arguments) {
    const Ran ran = delf_program(folder, "run " + arguments + " --out out");
    INFO(ran.err);
    CHECK(ran.code == 0);
    return nlohmann::json::parse(read(folder / "out/summary.json"))["theory"].get<std::string>();
  };
  CHECK(theory("own.ini --theory.name=wave") == "wave");
  CHECK(theory("named.ini --theory.density='0.5*phi_t^2 - phi_x^2'") == "text");
}

TEST_CASE("a density without a value there ends a run with exit code 3, step, time and site") {
  const Folder folder;
  folder.write("log.ini", scene("density = 0.5*phi_t^2 - 0.5*phi_x^2 - phi*log(phi)", "phi = 1\nphi_t = -1"));
  const Ran ran = delf_program(folder, "run log.ini --lattice.stencil=triangle-vertex --out out");
  INFO(ran.err);
  CHECK(ran.code == 3);
  REQUIRE(lines(ran.err).size() == 1);
  for (const char* part : {"step ", "t = ", "site "}) CHECK(contains(ran.err, part));
}

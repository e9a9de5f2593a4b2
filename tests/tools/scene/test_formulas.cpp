// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;

namespace {

const std::string rest = "[run]\nsteps = 60\n[output]\nfigures = off\nevery = 20\n";
const std::string circle = "[lattice]\nlength = 20\nsites = 63\ncourant = 0.5\n" + rest;
const std::string text_theory = "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - 0.025*m*phi^4\nparameters = m = 2\n";

std::vector<double> last_row(const Folder& folder, const std::string& out) {
  const delf::FieldsReader fields(folder / (out + "/fields.h5"));
  return fields.row(fields.frames() - 1);
}
nlohmann::json summary(const Folder& folder, const std::string& arguments, const std::string& out = "out") {
  const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out " + out);
  INFO(arguments << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / (out + "/summary.json")));
}

}  // namespace

TEST_CASE("numbers of a scene may be formulas, with the parameters of its theory") {
  const Folder folder;
  folder.write("own.ini",
               text_theory +
                   "[lattice]\nlength = 2*pi*m\nsites = 2^6 - 1\ncourant = 1/m\n[initial]\nphi = sin(2*pi*x/L)\n" +
                   rest);
  folder.write(
      "plain.ini",
      text_theory +
          "[lattice]\nlength = 12.566370614359172\nsites = 63\ncourant = 0.5\n[initial]\nphi = sin(2*pi*x/L)\n" + rest);
  const auto formulas = summary(folder, "own.ini", "own"), numbers = summary(folder, "plain.ini", "plain");
  CHECK(formulas["length"] == numbers["length"]);
  CHECK(last_row(folder, "own") == last_row(folder, "plain"));
  summary(folder, "own/scene.ini", "again");  // to the bit
  CHECK(last_row(folder, "own") == last_row(folder, "again"));
  CHECK(read(folder / "own/scene.ini") == read(folder / "again/scene.ini"));
  CHECK(summary(folder, "own.ini --theory.m=4/2 --run.steps=3*20", "other")["time"] == formulas["time"]);
  CHECK(last_row(folder, "other") == last_row(folder, "own"));
  CHECK(summary(folder, "own.ini --theory.m=3")["length"] == 2 * std::numbers::pi * 3);
  // of built-in theories, and of their states
  CHECK(summary(folder, "kink --run.until='sqrt(2)/2' --initial.speed='1/sqrt(4)'")["status"] == "done");
}

TEST_CASE("a formula that is no number is refused in one line with the place") {
  const Folder folder;
  folder.write("own.ini", text_theory + circle);
  const auto refused = [&](const std::string& keys, const std::string& place, const std::string& wrong) {
    check_refused(delf_program(folder, "plan own.ini " + keys), {"command line: " + place + ": " + wrong});
  };
  refused("--lattice.length=2*pj", "lattice.length: character 3, at \"pj\"", "unknown name pj; did you mean pi?");
  refused("--lattice.length='20*(1 + m'", "lattice.length: character 10, after \"20*(1 + m\"",
          "expected an operator or )");
  refused("--lattice.length=phi*2", "lattice.length: character 1, at \"phi*2\"", "unknown name phi");
  refused("--lattice.length=1/0", "lattice.length: character 4, after \"1/0\"", "division by zero");
  refused("--theory.m=2*m", "theory.m: character 3, at \"m\"", "unknown name m");  // of itself
  check_refused(delf_program(folder, "plan own.ini --lattice.length=2-3"), {"--lattice.length = 2-3: must be above 0"});
  check_refused(delf_program(folder, "plan own.ini --lattice.sites=63/2"),
                {"--lattice.sites = 63/2: is not an integer"});
  check_refused(delf_program(folder, "plan own.ini --lattice.length=m2"),
                {"is not a number; write one like 0.125 or 1e-6, or a formula"});
}

TEST_CASE("delf plan prints the density and its equations, and LaTeX of them alone") {
  const Folder folder;
  folder.write("own.ini", text_theory + circle);
  const Ran plan = delf_program(folder, "plan own.ini --initial.phi=0 --lattice.stencil=triangle-vertex");
  CHECK(plan.code == 0);
  for (const char* part :
       {"density    0.5*phi_t^2 - 0.5*phi_x^2 - 0.025*m*phi^4", "equations  phi_tt - phi_xx + m*phi^3/10 = 0",
        "(phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 - (phi(j,i-1) - 2*phi(j,i) + phi(j,i+1))/k^2",
        "m*phi(j,i)^3/10 = 0"})
    CHECK(contains(plan.out, part));
  const Ran latex = delf_program(folder, "plan own.ini --initial.phi=0 --latex");
  CHECK(latex.code == 0);
  CHECK(latex.out.starts_with("\\[\n  \\ell = "));
  CHECK(contains(latex.out, "\\varphi_{tt} - \\varphi_{xx} + \\frac{m\\,\\varphi^{3}}{10} = 0"));
  CHECK(latex.out.ends_with("\\]\n"));
  CHECK(contains(delf_program(folder, "plan collision").out, "equations  φ_tt − φ_xx + m² sin φ = 0"));
  const std::string collision = delf_program(folder, "plan collision --latex").out;
  CHECK(contains(collision, "\\varphi_{tt} - \\varphi_{xx} + m^{2}\\,"));
  // what is long is in lines, broken between terms
  CHECK(contains(collision, "\\begin{aligned}\n  &\\frac{1}{4\\,h^{2}}"));
  CHECK(contains(collision, " \\\\\n  &\\quad - \\frac{1}{4\\,k^{2}}"));
  check_refused(delf_program(folder, "plan solar-system --latex"), {"theory.name = solar-system: is compiled"});
  check_refused(delf_program(folder, "run own.ini --latex"), {"--latex: `run` prints no formulas"});
}

TEST_CASE("a stencil of the scene's own steps like the built-in one, under every command") {
  const Folder folder;
  const std::string stencil =
      "[stencil]\nsites = (0,0) (1,0) (1,1)\npoint = 1; phi: 1/3 1/3 1/3; phi_t: -1 1 0; phi_x: 0 -1 1\n";
  folder.write("own.ini", text_theory + stencil + circle);
  const std::string start = " --initial.phi='sin(2*pi*x/L)'";
  CHECK(summary(folder, "own.ini" + start, "own")["stencil"] == "text");
  summary(folder, "own.ini --lattice.stencil=triangle --initial.phi='sin(2*pi*x/L)'", "triangle");
  CHECK(last_row(folder, "own") == last_row(folder, "triangle"));
  summary(folder, "own/scene.ini", "again");
  CHECK(last_row(folder, "own") == last_row(folder, "again"));
  summary(folder, "own.ini" + start + " --lattice.space=interval --boundary.left=natural", "own");
  summary(folder, "own.ini" + start + " --lattice.space=interval --boundary.left=natural --lattice.stencil=triangle",
          "triangle");
  CHECK(last_row(folder, "own") == last_row(folder, "triangle"));
  CHECK(delf_program(folder, "verify own.ini" + start).code == 0);
  CHECK(contains(delf_program(folder, "plan own.ini" + start).out, "3 sites, 1 point; consistent, of order 2"));

  // two points on two lines, and a theory that is compiled
  folder.write("two.ini",
               "[theory]\nname = sine-gordon\n[initial]\nstate = kink\n[stencil]\nsites = (0,0) (1,0) (0,1) (1,1)\n"
               "point = 1/2; phi: 1 0 0 0; phi_t: -1 1 0 0; phi_x: -1 0 1 0\n"
               "point = 1/2; phi: 0 0 0 1; phi_t: 0 0 -1 1; phi_x: 0 -1 0 1\n" +
                   circle);
  CHECK(summary(folder, "two.ini", "two")["error_linf"] < 0.1);
  summary(folder, "two/scene.ini", "again");
  CHECK(last_row(folder, "two") == last_row(folder, "again"));

  check_refused(
      delf_program(folder, "plan own.ini --stencil.point='1; phi: 1 0 0; phi_t: -1 1 0; phi_x: 0 1 -1'" + start),
      {"command line: stencil.point: is not consistent: of the field x, phi_x finds -1, not 1"});
  check_refused(delf_program(folder, "plan collision --lattice.stencil=text"), {"stencil.sites: must be given"});
}

TEST_CASE("a Lagrangian on values, without jets, steps like the stencil whose action it is, and is verified") {
  const Folder folder;
  // leapfrog: one cell's share of each edge and corner
  folder.write("own.ini",
               "[theory]\nname = sine-gordon\nmass = 1.5\nlagrangian = h*k*(0.25*((y2 - y1)^2 + (y4 - y3)^2)/h^2 - "
               "0.25*((y3 - y1)^2 + (y4 - y2)^2)/k^2 + 0.25*mass^2*(cos(y1) + cos(y2) + cos(y3) + cos(y4) - 4))\n"
               "[initial]\nstate = kink\n[stencil]\nsites = (0,0) (1,0) (0,1) (1,1)\n" +
                   circle);
  summary(folder, "own.ini", "own");
  summary(folder, "own.ini --lattice.stencil=triangle-vertex", "leapfrog");
  const auto own = last_row(folder, "own"), leapfrog = last_row(folder, "leapfrog");
  REQUIRE(own.size() == leapfrog.size());
  double distance = 0;
  for (std::size_t i = 0; i < own.size(); ++i) distance = std::max(distance, std::abs(own[i] - leapfrog[i]));
  CHECK(distance < 1e-11);
  CHECK(delf_program(folder, "verify own.ini").code == 0);
  CHECK(delf_program(folder, "verify own.ini --verify.fault=sign").code == 1);
  CHECK(delf_program(folder, "plan own.ini").code == 0);

  const Ran unknown = delf_program(folder, "plan own.ini --theory.lagrangian='h*k*(y2 - y5)'");
  CHECK(unknown.code == 2);
  CHECK(contains(unknown.err, "theory.lagrangian: character 11, at \"y5)\": unknown name y5"));
  check_refused(delf_program(folder, "plan own.ini --stencil.point='1; phi: 1 0 0 0'"),
                {"theory.lagrangian: is an action by itself"});
}

TEST_CASE("a Lagrangian on values that has other equations than the density is refused") {
  const Folder folder;
  const std::string sites = "[stencil]\nsites = (0,0) (1,0) (0,1) (1,1)\n[initial]\nphi = sin(2*pi*x/L)\n";
  const std::string action = "0.25*((y2 - y1)^2 + (y4 - y3)^2)/h^2 - 0.25*((y3 - y1)^2 + (y4 - y2)^2)/k^2 + ";
  const auto write = [&](const std::string& lagrangian) {
    folder.write("own.ini", "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 + cos(phi) - 1\nlagrangian = " + lagrangian +
                                "\n" + sites + circle);
    return delf_program(folder, "plan own.ini");
  };
  const std::string potential = "0.25*(cos(y1) + cos(y2) + cos(y3) + cos(y4))";
  CHECK(write("h*k*(" + action + potential + " - 1)").code == 0);
  CHECK(write("h*k*(" + action + potential + ")").code == 0);                    // a constant less
  CHECK(write("h*k*(" + action + potential + ") + k*(y2^2 - y1^2)").code == 0);  // a divergence more
  CHECK(write("h*k*(" + action + "cos(y1))").code == 0);                         // of order 1
  CHECK(write("h*k*(" + action + "cos(0.25*(y1 + y2 + y3 + y4)))").code == 0);
  const std::string refused = "theory.lagrangian: is no action of the density";
  check_refused(write("h*k*(" + action + "0.99*" + potential + ")"), {refused});
  check_refused(write("2*h*k*(" + action + potential + ")"), {refused});
  check_refused(write("h*k*(" + action + "cos(y1) - 0.01*y1^4)"), {refused});
  check_refused(
      write("h*k*(0.25*((y2 - y1)^2 + (y4 - y3)^2)/k^2 - 0.25*((y3 - y1)^2 + (y4 - y2)^2)/h^2 + " + potential + ")"),
      {refused});
  check_refused(write("-h*k*(" + action + potential + ")"), {refused});
  // a chain, whose sites are no points of a field, and mechanics
  folder.write(
      "chain.ini",
      "[theory]\ndensity = 0.5*phi_t^2 - (exp(phi_x) - phi_x - 1)\nlagrangian = h*(0.5*((y2 - y1)/h)^2 - "
      "(exp(y3 - y1) - (y3 - y1) - 1))\n[stencil]\nsites = (0,0) (1,0) (0,1)\n[initial]\nphi = 0.1*sin(2*pi*x/L)\n"
      "[lattice]\nlength = 63\nsites = 63\ntime_step = 0.05\n" +
          rest);
  const Ran chain = delf_program(folder, "plan chain.ini");
  INFO(chain.err);
  CHECK(chain.code == 0);
}

TEST_CASE("a parameter that formulas would read as something else is refused") {
  const Folder folder;
  for (const char* name : {"L", "y", "z", "X", "h", "k", "t", "x", "phi", "phi_t", "sin", "pi"}) {
    INFO(name);
    folder.write("own.ini", std::string("[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2\nparameters = a = 1, ") + name +
                                " = 5\n[initial]\nphi = 0\n" + circle);
    const Ran ran = delf_program(folder, "plan own.ini");
    check_refused(ran, {"own.ini:3: theory.parameters", std::string("\"") + name + "\"", "choose another name"});
  }
}

TEST_CASE("a derivative that no stencil of the scheme has in its jets is refused, not left out") {
  const Folder folder;
  const std::string initial = "[initial]\nstate = noise\n";
  folder.write("beam.ini", "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_xx^2\n" + initial + circle);
  for (const char* method : {"multisymplectic", "cgvi", "spacetime", "composition"})
    check_refused(delf_program(folder, std::string("plan beam.ini --scheme.method=") + method),
                  {"the density has phi_xx"});
  const Ran without = delf_program(folder, "plan beam.ini --theory.density='0.5*phi_t^2 - 0.5*phi_x^2'");
  INFO(without.err);
  CHECK(without.code == 0);
}

TEST_CASE("a symmetry of a text is verified, up to a divergence too, and refused if it is none") {
  const Folder folder;
  const auto write = [&](const std::string& density, const std::string& symmetry) {
    folder.write("two.ini", "[theory]\nfields = u, v\ndensity = 0.5*(u_t^2 + v_t^2 - u_x^2 - v_x^2)" + density +
                                "\nsymmetry = " + symmetry + "\n[initial]\nu = cos(2*pi*x/L)\nv = sin(2*pi*x/L)\n" +
                                circle);
  };
  const auto check = [&](const std::string& name) {
    const Ran ran = delf_program(folder, "verify two.ini --run.steps=30 --verify.checks=noether --out out");
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    const auto json = nlohmann::json::parse(read(folder / "out/verify.json"));
    return std::ranges::any_of(json["checks"], [&](const auto& c) { return c["name"] == name && c["passed"] == true; });
  };
  write(" - 0.1*(u^2 + v^2)^2", "-v, u");
  CHECK(check("symmetry of L, symmetry"));
  CHECK(check("Noether, symmetry"));
  CHECK(contains(read(folder / "out/verify.json"), "Noether, symmetry"));
  CHECK(std::abs(summary(folder, "two.ini")["conserved"][0]["error_max"].get<double>()) < 1e-13);
  // δℓ = −0.2, the divergence of −0.2 t: conserved is what no row alone has
  write(" - 0.2*u - 0.1*v^4", "1, 0");
  CHECK(check("symmetry of L up to a divergence, symmetry"));
  CHECK(check("Noether, symmetry"));
  CHECK(summary(folder, "two.ini")["conserved"].empty());
  write(" - 0.2*u^2", "1, 0");
  check_refused(delf_program(folder, "run two.ini"),
                {"two.ini:4: theory.symmetry: is no symmetry: the density changes along it"});
  write(" - 0.2*u^2", "1, w");
  CHECK(delf_program(folder, "run two.ini").code == 2);
}

TEST_CASE("a density without a value says where, and which part of it") {
  const Folder folder;
  folder.write("log.ini",
               "[theory]\ndensity = 0.5*phi_t^2 - 0.5*phi_x^2 - a*phi*log(phi)\nparameters = a = 1\n"
               "[initial]\nphi = 1\nphi_t = -1\n" +
                   circle);
  const Ran ran = delf_program(folder, "run log.ini --out out --lattice.stencil=triangle-vertex");
  INFO(ran.err);
  CHECK(ran.code == 3);
  CHECK(contains(ran.err, "step 6, t = 0.952381: the energy is not finite"));
  CHECK(contains(ran.err, "near site 0 at t = 0.952381 log(phi) has no value, where phi = -0.104106"));
  CHECK(lines(ran.err).size() == 1);
}

TEST_CASE("hostile texts are refused within a second") {
  const Folder folder;
  const auto refused = [&](const std::string& density, const std::string& part) {
    folder.write("bad.ini", "[theory]\ndensity = " + density + "\n" + circle);
    const auto begin = std::chrono::steady_clock::now();
    const Ran ran = delf_program(folder, "run bad.ini");
    INFO(ran.err.substr(0, 300));
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, part));
    CHECK(ran.err.size() < 1000);
    CHECK(std::chrono::steady_clock::now() - begin <
          std::chrono::seconds(5));  // a twentieth of a second on a free core
  };
  refused("0.5*phi_t^2 + " + std::string(1 << 20, '1'), "");
  refused(std::string(100'000, '('), "");
  refused(std::string("0.5*phi_t^2 ") + '\0' + " + phi", "");
  refused("0.5*phi_t^2 + " + std::string(50'000, '('), "nested more than 200 deep");
  refused("0.5*phi_t^2 + 1e99999", "outside the range of double precision");
}

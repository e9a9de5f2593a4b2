// SPDX-License-Identifier: MIT
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf::testing;

namespace {

const std::string kdv =
    "[theory]\ndensity = 0.5*phi_x*phi_t + phi_x^3 - 0.5*phi_xx^2\n[lattice]\nstencil = six-tuple\nspace = circle\n"
    "length = 30\nsites = 65\ncourant = 0.1\n[boundary]\ngain = 2\n[initial]\nphi = tanh(0.5*(x - 15)) + 1\n"
    "[run]\nuntil = 1\n[output]\nfigures = off\n";
const std::string chain =
    "[theory]\nname = sine-gordon\n[lattice]\nstencil = rectangle-symmetric\nspace = interval\nlength = 20\nsites = 101\n"
    "courant = 0.5\n[initial]\nphi = 0\nphi_t = 0\n[run]\nuntil = 5\n[output]\nfigures = off\n";

}  // namespace

TEST_CASE("verify measures Newton's order where the mean of a row is a gauge") {
  const Folder folder;
  folder.write("kdv.ini", kdv);
  const Ran right = delf_program(folder, "verify kdv.ini --out right");
  INFO(right.out << right.err);
  CHECK(right.code == 0);
  CHECK(contains(right.out, "Newton: quadratic convergence"));
}

TEST_CASE("an end whose formula has no value is refused by its key and time") {
  const Folder folder;
  folder.write("chain.ini", chain);
  for (const std::string formula : {"log(-t)", "sqrt(t - 1)", "1/t"}) {
    const Ran ran = delf_program(folder, "run chain.ini --out out '--boundary.left=" + formula + "'");
    INFO(formula << ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "--boundary.left = " + formula + ": has no finite value at t = "));
  }
}

TEST_CASE("an end that moves from rest does not make the first step doubtful") {
  const Folder folder;
  folder.write("chain.ini", chain);
  for (const std::string courant : {"0.5", "0.1"}) {
    const Ran ran =
        delf_program(folder, "run chain.ini --out out '--boundary.left=1.8*sin(0.9*t)' --lattice.courant=" + courant);
    INFO(ran.out << ran.err);
    CHECK(ran.code == 0);
    CHECK_FALSE(contains(ran.out + ran.err, "leaves the motion"));
  }
}

TEST_CASE("rows of a run backward are verified from their file") {
  const Folder folder;
  folder.write("chain.ini", chain);
  REQUIRE(delf_program(folder, "run chain.ini '--initial.phi=0.1*sin(pi*x/10)' --output.every=1 --out forward").code ==
          0);
  folder.write("back.ini",
               "[theory]\nname = sine-gordon\n[lattice]\nstencil = rectangle-symmetric\nspace = interval\nlength = 20\n"
               "sites = 101\ntime_step = -0.1\n[initial]\nstate = file\nfile = forward/fields.h5\n[run]\nuntil = -2\n"
               "[output]\nevery = 1\nfigures = off\n");
  REQUIRE(delf_program(folder, "run back.ini --out back").code == 0);
  const Ran verified = delf_program(folder, "verify back/scene.ini --fields back/fields.h5 --out verified");
  INFO(verified.out << verified.err);
  CHECK(verified.code == 0);
}

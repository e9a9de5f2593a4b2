// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf;
using namespace delf::testing;

namespace {

/// A column of series.csv without its first record.
std::vector<double> recorded(const std::filesystem::path& series, const std::string& name) {
  const std::vector<std::string> all = lines(read(series));
  const auto cells = [](const std::string& line) {
    std::vector<std::string> parts;
    std::istringstream in(line);
    for (std::string part; std::getline(in, part, ',');) parts.push_back(part);
    return parts;
  };
  const std::vector<std::string> names = cells(all[0]);
  const auto place = std::ranges::find(names, name);
  REQUIRE(place != names.end());
  std::vector<double> values;
  for (std::size_t n = 2; n < all.size(); ++n) values.push_back(std::stod(cells(all[n])[at(place - names.begin())]));
  return values;
}
double spread(const std::vector<double>& values) {
  const auto [least, most] = std::ranges::minmax(values);
  return most - least;
}

}  // namespace

TEST_CASE("the plan prints the modified Lagrangian of a scene") {
  const Folder folder;
  const Ran ran = delf_program(folder, "plan --modified=2 collision");
  CHECK(ran.code == 0);
  CHECK(contains(ran.out,
                 "  modified   phi_t^2/2 - phi_x^2/2 + m^2*cos(phi) - m^2\n"
                 "             + h^2/24*(phi_tx^2 + phi_xx^2 + m^2*phi_t^2*cos(phi) + 2*m^2*phi_x^2*cos(phi)"));
  CHECK(contains(ran.out, "             + k^2/24*(-3*phi_tx^2 + phi_xx^2 + 3*m^2*phi_x^2*cos(phi))\n"));
  CHECK_FALSE(contains(ran.out, "h^4"));
  const Ran bricks = delf_program(folder, "plan collision --lattice.sites=256 --lattice.stencil=hexagon --modified");
  CHECK(contains(bricks.out, "h^2*k^2/864*("));
  CHECK(contains(bricks.out, "d = h^3/24*(m^2*phi_t*cos(phi))"));
  const Ran latex = delf_program(folder, "plan pendulum --modified --latex --lattice.stencil=trapezoidal");
  CHECK(latex.out.starts_with("\\[\n  \\begin{aligned}\n  &\\tilde\\ell = "));
  CHECK(contains(latex.out, "\\frac{h^{2}}{24}\\bigl("));
  CHECK(latex.out.ends_with("\\]\n"));
}

TEST_CASE("what has no modified Lagrangian is refused in one line") {
  const Folder folder;
  const auto refused = [&](const std::string& arguments, const std::string& reason) {
    INFO(arguments);
    check_refused(delf_program(folder, arguments), {reason});
  };
  refused("plan collision --modified=3", "--modified=3: is the order in h and k of its last terms, 2, 4 or 6");
  refused("run collision --modified", "--modified: `run` prints no modified Lagrangian");
  refused("plan sphere --modified", "is for lattices");
  refused("plan collision --modified --scheme.method=guo", "has no modified Lagrangian");
  refused("plan nls --modified", "has other parts beside the density, such as multipliers");
  for (const char* scene : {"wave-map", "spherical-pendulum"})
    refused(std::string("plan --modified ") + scene, "theory.constraint: fields that multipliers hold");
  refused("plan kdv --modified", "not of second order in the time derivatives");
  refused("plan solar-system --modified", "theory.name = solar-system: is compiled");
  refused("run collision --output.modified=3 --run.steps=2", "output.modified = 3: is an even order");
}

TEST_CASE("a run records the energy and the momentum of the modified Lagrangian") {
  const Folder folder;
  const auto run = [&](int sites, int order) {
    const std::string out = std::to_string(sites) + "of" + std::to_string(order);
    const Ran ran = delf_program(
        folder,
        "run breather --output.figures=off --output.fields=off --run.until=4 --output.every=2 --output.modified=" +
            std::to_string(order) + " --lattice.sites=" + std::to_string(sites) + " --out " + out);
    INFO(ran.err);
    REQUIRE(ran.code == 0);
    CHECK(contains(ran.out, "  conserved  energy_modified = 12.80"));
    return folder / out / "series.csv";
  };
  for (const int order : {2, 4}) {
    const auto coarse = run(200, order), fine = run(300, order);
    const double fell = spread(recorded(coarse, "energy_modified")) / spread(recorded(fine, "energy_modified"));
    INFO(order);
    CHECK(std::log(fell) / std::log(1.5) == Approx(order + 2).margin(0.3));
    CHECK(spread(recorded(fine, "energy")) > 100 * spread(recorded(fine, "energy_modified")));
    CHECK(spread(recorded(fine, "momentum_modified")) < 1e-13);  // zero by symmetry
  }
}

TEST_CASE("energies of modified Lagrangians are for spaces without walls") {
  const Folder folder;
  const Ran ran = delf_program(folder, "run interval --output.modified=2 --run.steps=2 --output.figures=off --out out");
  CHECK(ran.code == 0);
  CHECK(contains(ran.err,
                 "output.modified = 2: warning: an interval has walls, where sums over sites are no integrals; "
                 "its columns are left out"));
  CHECK_FALSE(contains(read(folder / "out/series.csv"), "energy_modified"));
  const Ran point = delf_program(folder, "run kepler --output.modified=4 --run.steps=20 --output.figures=off --out p");
  CHECK(point.code == 0);
  CHECK(contains(read(folder / "p/series.csv"), ",energy_modified\n"));
  CHECK_FALSE(contains(read(folder / "p/series.csv"), "momentum_modified"));
}

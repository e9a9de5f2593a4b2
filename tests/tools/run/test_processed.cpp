// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;

namespace {

const std::string breather =
    "workprecision-breather --scheme.method=processed --output.figures=off --lattice.sites=256 ";
const std::string ti4 = breather + "--lattice.courant=0.35 --scheme.kernel=ti4 --lattice.space_order=10 ";
const std::string b6 = breather + "--lattice.courant=1 --lattice.space_order=16 ";

nlohmann::json summary_of(const std::string& command) {
  const Folder folder;
  const Ran ran = delf_program(folder, "run " + command + "--run.until=20 --out out");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(contains(ran.out, "rows of a kernel"));
  return nlohmann::json::parse(read(folder / "out" / "summary.json"));
}

}  // namespace

TEST_CASE("recorded rows of kernels have the processor undone") {
  // The kernels' own rows are off by some 1e-2 of this.
  CHECK(summary_of(ti4)["error_linf"].get<double>() < 4e-6);
  const double maximal = summary_of(b6)["error_linf"].get<double>();
  CHECK(maximal < 5e-7);
  CHECK(summary_of(b6 + "--lattice.pairs=suited ")["error_linf"].get<double>() < 0.9 * maximal);
}

TEST_CASE("the energy left of the end, measured on rows of kernels, is the energy") {
  const auto s = summary_of(ti4 + "'--measure.all=energy_left(L)' ");
  CHECK(s["measures"]["all"].get<double>() == Approx(s["energy_final"].get<double>()).epsilon(1e-3));
}

TEST_CASE("the kernel's own rows are verified, and recorded ones refused") {
  const Folder folder;
  const Ran ran = delf_program(folder, "verify " + ti4 + "--run.steps=20 --verify.moments=1 --out out");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
  CHECK(contains(ran.out, "rows of the kernel"));
  REQUIRE(delf_program(folder, "run " + ti4 + "--output.every=1 --run.steps=20 --out rows").code == 0);
  check_refused(delf_program(folder, "verify " + ti4 + "--fields rows/fields.h5 --out out"),
                {"scheme.method", "leave --fields out"});
  const Ran from_file =
      delf_program(folder, "run " + ti4 + "--initial.state=file --initial.file=rows/fields.h5 --out out");
  CHECK(from_file.code == 2);
  CHECK(contains(from_file.err, "a file has no rates, which a kernel starts from"));
}

TEST_CASE("kernels say which pairs and densities they do not take") {
  const Folder folder;
  check_refused(delf_program(folder, "run " + b6 + "--lattice.space_order=9"), {"lattice.space_order"});
  check_refused(delf_program(folder, "run " + ti4 + "--lattice.gradient_order=12"),
                {"lattice.gradient_order", "lower it"});
  check_refused(delf_program(folder, "run " + b6 + "--scheme.kernel=b7"), {"scheme.kernel", "not known"});
  check_refused(delf_program(folder, "run phi4-kink --scheme.method=processed"), {"boundary.left", "not even about"});
}

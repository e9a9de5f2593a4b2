// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

using namespace delf::testing;

namespace {

bool is_there(const std::filesystem::path& path) { return std::filesystem::exists(path); }

}  // namespace

TEST_CASE("another run of a scene keeps what was there, and the same run takes its place") {
  const Folder folder;
  folder.write("small.ini", small_scene());
  const auto run = [&](const std::string& more) {
    return delf_program(folder, "run small.ini --output.figures=off " + more);
  };
  REQUIRE(run("").code == 0);
  const std::string first = read(folder / "results/small/series.csv");
  folder.write("results/small/verify.json", "{}");
  CHECK_FALSE(contains(run("").out, "kept"));
  CHECK_FALSE(is_there(folder / "results/small~1"));
  CHECK(is_there(folder / "results/small/verify.json"));

  const Ran other = run("--run.steps=7");
  REQUIRE(other.code == 0);
  CHECK(contains(other.out, "results/small~1: the earlier run, kept"));
  CHECK(read(folder / "results/small~1/series.csv") == first);
  CHECK(is_there(folder / "results/small~1/verify.json"));
  CHECK(lines(read(folder / "results/small/series.csv")).size() == 9);
  REQUIRE(run("--run.steps=8").code == 0);
  CHECK(is_there(folder / "results/small~2"));

  CHECK_FALSE(contains(run("--run.steps=9 --overwrite").out, "kept"));
  CHECK_FALSE(contains(run("--run.steps=9 --out results/small").out, "kept"));
  CHECK_FALSE(is_there(folder / "results/small~3"));
  // a run that is refused leaves the earlier one where it was
  CHECK(run("--run.steps=5 --initial.start=exact --scheme.method=cgvi").code == 2);
  CHECK(lines(read(folder / "results/small/series.csv")).size() == 11);
  CHECK_FALSE(is_there(folder / "results/small~3"));
  CHECK(contains(delf_program(folder, "verify small.ini --overwrite").err, "`verify` keeps nothing"));
}

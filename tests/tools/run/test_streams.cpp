// SPDX-License-Identifier: MIT
#include <cstdlib>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/figures/gnuplot_limit.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;
namespace fs = std::filesystem;

namespace {

const std::string small = "run kink --run.steps=40 --output.every=1 --output.figures=off --out out";

}  // namespace

TEST_CASE("standard streams that are closed or full lose nothing that a run writes") {
  const Folder folder;
  REQUIRE(delf_program(folder, small).code == 0);
  const std::string series = read(folder / "out/series.csv");
  // what is redirected to, and the exit code
  const auto [streams, code] = GENERATE(table<std::string, int>(
      {{"0<&- 1>&- 2>&-", 0}, {"> /dev/full", 4}, {"> /dev/full 2> /dev/full", 4}, {"2> /dev/full", 0}}));
  const Ran ran = delf_program(folder, small + " " + streams);
  INFO(streams << ": " << ran.err);
  CHECK(ran.code == code);
  CHECK(lines(ran.err).size() == (streams == "> /dev/full" ? 1 : 0));
  CHECK(read(folder / "out/series.csv") == series);
  CHECK(delf::FieldsReader(folder / "out/fields.h5").frames() == 41);
  CHECK(contains(read(folder / "out/summary.json"), "\"status\": \"done\""));
}

TEST_CASE("a full standard output is named as such, however much is printed") {
  const Folder folder;
  for (const char* arguments : {"list > /dev/full", "help run > /dev/full", "--version > /dev/full"}) {
    const Ran ran = delf_program(folder, arguments);
    CHECK(ran.code == 4);
    CHECK(ran.err == "delf: standard output cannot be written to\n");
  }
}

TEST_CASE("a gnuplot that fails, leaves no file, or hangs costs a run its figures and no more") {
  const Folder folder;
  fs::create_directory(folder / "bin");
  const fs::path fake = folder.write("bin/gnuplot", "#!/bin/sh\nexec $FAKE\n");
  fs::permissions(fake, fs::perms::owner_all);
  const std::string path = "PATH='" + (folder / "bin").string() + "':$PATH FAKE=";
  const auto [does, line] = GENERATE(table<std::string, std::string>(
      {{"true", "gnuplot ended well, and left no spacetime.png"}, {"false", "could not draw"}}));
  const Ran ran = delf_program(folder, "run kink --run.steps=4 --out out", "export " + path + does + ";");
  INFO(ran.err);
  CHECK(ran.code == 0);
  CHECK(lines(ran.err).size() == 1);
  CHECK(contains(ran.err, line));
  CHECK(fs::exists(folder / "out/summary.json"));

  const std::string before = std::getenv("PATH");
  setenv("PATH", ((folder / "bin").string() + ":" + before).c_str(), 1);
  setenv("FAKE", "sleep 60", 1);
  folder.write("script", "");
  const std::string why = delf::run_gnuplot_within(std::chrono::milliseconds(50), folder.path(), "script");
  setenv("PATH", before.c_str(), 1);
  unsetenv("FAKE");
  CHECK(contains(why, "it took longer than 0.05 s"));
}

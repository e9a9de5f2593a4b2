// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdlib>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;
namespace fs = std::filesystem;

namespace {

bool has_ffmpeg() {
  if (std::system("command -v ffmpeg > /dev/null") == 0) return true;
  WARN("ffmpeg is not installed: no MP4 is tested");
  return false;
}

/// A PATH with gnuplot and a shell, and without ffmpeg.
std::string without_ffmpeg(const Folder& folder) {
  fs::create_directory(folder / "bin");
  REQUIRE(shell(folder, "for p in gnuplot sh; do ln -s \"$(command -v $p)\" bin/$p; done").code == 0);
  return "PATH=$PWD/bin";
}

/// The frames of a GIF: its graphic control extensions.
std::size_t frames_of_gif(const std::string& bytes) {
  const std::string begin("\x21\xf9\x04", 3);
  std::size_t count = 0;
  for (std::size_t at = bytes.find(begin); at != std::string::npos; at = bytes.find(begin, at + 1)) ++count;
  return count;
}

void check_nothing_is_left(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator(folder))
    CHECK_FALSE(entry.path().filename().string().starts_with("."));
}

}  // namespace

TEST_CASE("a film of a run is made with it, and its page shows a frame with a link") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  if (!has_ffmpeg()) return;
  const Folder folder;
  const Ran ran = delf_program(
      folder,
      "run kink --run.until=2 --output.film=on --film.seconds=0.4 --output.report=on --output.figures=off --out 'a b'");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(ran.err.empty());
  CHECK(contains(ran.out, "a b/film.mp4: 10 frames in 0.4 s, "));
  CHECK(read(folder / "a b/film.mp4").substr(4, 4) == "ftyp");
  CHECK(read(folder / "a b/figures/film.png").starts_with("\x89PNG"));
  check_nothing_is_left(folder / "a b");
  const std::string page = read(folder / "a b/report.html");
  CHECK(contains(page, "<a href=\"film.mp4\">Watch the film, film.mp4</a>"));
  CHECK(contains(page, "The film goes from t = 0 to t = "));
  // of a page elsewhere the link leads there
  REQUIRE(delf_program(folder, "report 'a b' --out page.html").code == 0);
  CHECK(contains(read(folder / "page.html"), "<a href=\"a%20b/film.mp4\">"));
  // another run in the folder takes its film away
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --out 'a b'").code == 0);
  CHECK_FALSE(fs::exists(folder / "a b/film.mp4"));
  CHECK_FALSE(fs::exists(folder / "a b/figures/film.png"));
}

TEST_CASE("without ffmpeg a film is a GIF of all kinds of rows") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const std::string path = without_ffmpeg(folder);
  const auto [run, words] = GENERATE(table<std::string, std::string>({
      {"soliton-bounce --run.until=0.2 --output.every=1", "5 frames"},
      {"kepler --run.until=1", "5 frames"},
      {"pendulum --run.until=1", "5 frames"},
      {"solar-system --run.until=2000", "5 frames"},
      {"sphere --run.until=1", "5 frames"},
      {"phi4-moving-mesh --run.until=0.5 --output.every=1", "5 frames"},
      {"asynchronous --run.until=1", "5 frames"},
      {"kink --run.until=1 --output.every=100000", "2 frames"},  // the first row and the last
  }));
  INFO(run);
  REQUIRE(delf_program(folder, "run " + run + " --output.figures=off --out out").code == 0);
  const Ran ran = delf_program(folder, "film out --film.seconds=0.2", path);
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(contains(ran.out, "out/film.gif: " + words + " in 0.2 s, "));
  CHECK(contains(ran.out, "ffmpeg, which is missing"));
  const std::string gif = read(folder / "out/film.gif");
  CHECK(gif.starts_with("GIF89a"));
  CHECK(frames_of_gif(gif) == static_cast<std::size_t>(words[0] - '0'));
  CHECK(read(folder / "out/figures/film.png").starts_with("\x89PNG"));
  check_nothing_is_left(folder / "out");
}

TEST_CASE("a film needs rows one after the other, and says what is missing") {
  const Folder folder;
  check_refused(delf_program(folder, "film"), {"film what?"});
  check_refused(delf_program(folder, "film nowhere"), {"nowhere", "no such folder"});
  check_refused(delf_program(folder, "film . --out there"), {"--out"});
  check_refused(delf_program(folder, "film . --run.until=3"), {"--run.until", "recorded already"});
  check_refused(delf_program(folder, "film ."), {"scene.ini"});
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --output.fields=off --out none").code == 0);
  check_refused(delf_program(folder, "film none"), {"no fields.h5", "output.fields = on"});
  REQUIRE(delf_program(folder, "run kink --run.steps=0 --output.figures=off --out one").code == 0);
  check_refused(delf_program(folder, "film one"), {"one/fields.h5", "one row"});
  check_refused(delf_program(folder, "film one --film.seconds=0"), {"film.seconds"});
  REQUIRE(delf_program(folder, "run refined-kink --output.figures=off --out still").code == 0);
  check_refused(delf_program(folder, "film still"), {"solved at once"});
  folder.write("one/fields.h5", "nothing");
  check_refused(delf_program(folder, "film one"), {"one/fields.h5", "not an HDF5 file"});
  const Ran off = delf_program(
      folder, "run kink --run.until=1 --output.figures=off --output.fields=off --output.film=on --out off");
  CHECK(off.code == 0);
  CHECK(contains(off.err, "output.fields = off is in force"));
}

TEST_CASE("a program that fails, a full disk and an interruption leave the film that was there") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  REQUIRE(delf_program(folder, "run kink --run.until=2 --output.figures=off --out out").code == 0);
  folder.write("out/film.gif", "the film before");
  SECTION("without gnuplot") {
    const Ran ran = delf_program(folder, "film out", "PATH=/nowhere");
    CHECK(ran.code == 4);
    CHECK(lines(ran.err).size() == 1);
    CHECK(contains(ran.err, "gnuplot-nox"));
    // a run does not fail by its film
    const Ran run = delf_program(folder, "run kink --run.until=1 --output.figures=off --output.film=on --out other",
                                 "PATH=/nowhere");
    CHECK(run.code == 0);
    CHECK(contains(run.err, "no film: gnuplot is missing"));
  }
  SECTION("on a full disk") {
    const Ran ran = delf_program(folder, "film out --film.seconds=1", "ulimit -f 4;");
    CHECK(ran.code == 4);
    CHECK(lines(ran.err).size() == 1);
  }
  SECTION("interrupted") {
    REQUIRE(delf_program(folder, "run kink --run.until=40 --output.every=1 --output.figures=off --out long").code == 0);
    fs::rename(folder / "long/fields.h5", folder / "out/fields.h5");
    const Ran ran =
        shell(folder, "'" + program_path() +
                          "' film out --film.seconds=60 & p=$!; while ! ls out/.drawing-*/f*.png; do sleep 0.05; "
                          "done > looks 2>&1; kill -INT $p; wait $p");
    CHECK(ran.code == 130);
    CHECK(contains(ran.err, "interrupted: there is no new film in out"));
  }
  CHECK(read(folder / "out/film.gif") == "the film before");
  CHECK_FALSE(fs::exists(folder / "out/film.mp4"));
  CHECK_FALSE(fs::exists(folder / "out/figures/film.png"));
  check_nothing_is_left(folder / "out");
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>

#include "tests/catch.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/python.hpp"
#include "tools/page/markup.hpp"
#include "tools/page/page_figures.hpp"

using namespace delf::testing;

namespace {

namespace fs = std::filesystem;

/// The complaint about a page; empty if there is none.
std::string complaint(const Folder& folder, const std::string& page) {
  const std::string script = (fs::path(scenes_folder()) / "../../tests/tools/page/check_page.py").string();
  const Ran ran = shell(folder, python(folder) + " '" + script + "' '" + page + "'");
  return ran.code == 0 ? "" : ran.err + ran.out;
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t n = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++n;
  return n;
}

bool is_good(const std::string& page) { return contains(page, "class=\"verdict good\""); }

/// The page of a folder that has this one result of delf, made by hand.
std::string page_of_result(const Folder& folder, const std::string& file, const std::string& members) {
  fs::create_directories(folder / "by-hand");
  folder.write("by-hand/" + file, "{\"version\": \"0.1.0\", \"scene\": \"kink\", " + members + "}");
  const Ran ran = delf_program(folder, "report by-hand");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(complaint(folder, "by-hand/report.html") == "");
  return read(folder / "by-hand/report.html");
}

}  // namespace

TEST_CASE("text in a page is escaped, and bytes that are no UTF-8 are replaced") {
  CHECK(delf::escaped("a < b & \"c\" > φ") == "a &lt; b &amp; &quot;c&quot; &gt; φ");
  CHECK(delf::escaped("\xff|\xc0\xaf|\xed\xa0\x80|\x01|\xcf") ==
        "\uFFFD|\uFFFD\uFFFD|\uFFFD\uFFFD\uFFFD|\uFFFD|\uFFFD");
  CHECK(contains(delf::paragraph("<script>alert(1)</script>"), "&lt;script&gt;"));
  CHECK(contains(delf::code_block("\" onload=\"x", "</code>"),
                 "aria-label=\"&quot; onload=&quot;x\"><code>&lt;/code&gt;"));
  CHECK(contains(delf::table({"t", {"name", "value"}, {{"x", "1.5e-3"}, {"y", "a 1"}}}),
                 "<td class=\"number\">1.5e-3</td>"));
  CHECK(delf::table({"t", {"name"}, {}}).empty());
}

TEST_CASE("data URLs hold what their files hold") {
  CHECK(delf::data_url("png", "Man") == "data:image/png;base64,TWFu");
  CHECK(delf::data_url("png", "Ma") == "data:image/png;base64,TWE=");
  CHECK(delf::data_url("png", "M") == "data:image/png;base64,TQ==");
  CHECK(delf::data_url("png", "\xff\xfe\xfd") == "data:image/png;base64,//79");
  CHECK(delf::data_url("svg+xml", "<a b=\"#%\">\n&lt;</a>") ==
        "data:image/svg+xml,%3Ca b=%22%23%25%22%3E %26lt;%3C/a%3E");
}

TEST_CASE("the page of a run has its verdict, equations, numbers and figures in one small file") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const Ran ran = delf_program(folder, "run collision --output.report=on --out here");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(complaint(folder, "here/report.html") == "");
  const std::string page = read(folder / "here/report.html");
  CHECK(page.size() <= 300000);
  CHECK(contains(page, "The run ended well after 5100 steps, at t = 100, without a warning."));
  CHECK(contains(page, "sine-gordon: φ_tt − φ_xx + m² sin φ = 0"));
  CHECK(count(page, "<math ") == 3);  // density, field equation, discrete equation
  CHECK(count(page, "<img ") == 3);
  CHECK(count(page, "data:image/svg+xml,") == 3);
  CHECK(count(page, "<details>") == 5);  // the numbers of each figure, the series, and the references
  CHECK(contains(page, "The field over space and time. φ is between"));
  CHECK(contains(page, "delf run scene.ini"));
  CHECK(contains(page, "stencil = rectangle-symmetric"));
  CHECK(contains(page, "about the field 0: none grows exponentially"));
  CHECK(contains(page, "These rows have not been verified here."));
  CHECK(contains(page, "doi: 10.1007/s002200050505"));
  const std::string sum = shell(folder, "sha256sum here/fields.h5").out.substr(0, 64);
  CHECK(contains(page, sum));
  // it is the same when it is made again, and no file of its own is in its list
  const Ran again = delf_program(folder, "report here --out again.html");
  CHECK(again.code == 0);
  CHECK(read(folder / "again.html") == page);
  CHECK_FALSE(contains(page, ">report.html<"));
}

TEST_CASE("a page of what a verification found begins with the fault") {
  const Folder folder;
  const Ran ran =
      delf_program(folder, "verify collision --run.until=3 --verify.fault=sign --output.report=on --out here");
  CHECK(ran.code == 1);
  CHECK(complaint(folder, "here/report.html") == "");
  const std::string page = read(folder / "here/report.html");
  const std::size_t verdict = page.find("Verification failed"), cause = page.find("is not the derivative of L"),
                    first_section = page.find("<section id=\"solved\"");
  CHECK(verdict < cause);
  CHECK(cause < first_section);
  CHECK(count(page, "<math ") == 3);  // scene.ini is written for it
}

TEST_CASE("the page of a run that failed, was interrupted or killed says so and what is missing") {
  const Folder folder;
  SECTION("failed") {
    const Ran ran =
        delf_program(folder,
                     "run collision --lattice.stencil=triangle-vertex --lattice.courant=1.5 --output.figures=off "
                     "--output.report=on --out here");
    CHECK(ran.code == 3);
    CHECK(contains(read(folder / "here/report.html"), ": a value became infinite, or not a number."));
  }
  SECTION("killed") {
    REQUIRE(delf_program(folder, "run collision --run.until=2 --output.figures=off --out here").code == 0);
    fs::remove(folder / "here/summary.json");
    fs::resize_file(folder / "here/series.csv", fs::file_size(folder / "here/series.csv") - 30);
    REQUIRE(delf_program(folder, "report here").code == 0);
    const std::string page = read(folder / "here/report.html");
    CHECK(contains(page, "The run has not ended, or was killed"));
    CHECK(contains(page, "There is no summary.json"));
    CHECK(contains(page, "There are no figures"));
    CHECK(complaint(folder, "here/report.html") == "");
  }
  SECTION("killed before its first checkpoint") {
    REQUIRE(delf_program(folder, "run collision --run.until=2 --output.figures=off --out here").code == 0);
    fs::remove(folder / "here/summary.json");
    REQUIRE(delf_program(folder, "report here").code == 0);
    CHECK(contains(read(folder / "here/report.html"), "goes on with it from its last checkpoint"));
    for (const char* name : {"checkpoint", "checkpoint.previous"}) fs::remove(folder / "here" / name);
    REQUIRE(delf_program(folder, "report here").code == 0);
    CHECK(contains(read(folder / "here/report.html"), "It has no checkpoint to go on from: run it anew."));
  }
  SECTION("damaged summary") {
    fs::create_directory(folder / "here");
    folder.write("here/summary.json", "{\"version\": \"0.1.0\", \"sta");
    folder.write("here/series.csv", "row,time,energy\n0,0,1\n1,0.5,1\n");
    REQUIRE(delf_program(folder, "report here").code == 0);
    const std::string page = read(folder / "here/report.html");
    CHECK(contains(page, "summary.json is damaged, and its results are not known."));
    CHECK_FALSE(contains(page, "was killed"));
    CHECK(count(page, "summary.json is damaged, and is not used.") == 1);
    CHECK_FALSE(is_good(page));
  }
  SECTION("damaged") {
    REQUIRE(delf_program(folder, "run collision --run.until=2 --out here").code == 0);
    folder.write(
        "here/summary.json",
        "{\"version\": \"0.1.0\", \"status\": \"done\", \"warnings\": 7, \"conserved\": [3], \"time\": \"x\"}");
    folder.write("here/verify.json", "{\"checks\": [");
    folder.write("here/fields.h5", "nothing");
    folder.write("here/scene.ini", "[theory]\nname = <b>\xff & no theory\n");
    REQUIRE(delf_program(folder, "report here").code == 0);
    const std::string page = read(folder / "here/report.html");
    CHECK(contains(page, "verify.json is damaged, and its results are not known."));
    CHECK(contains(page, "No equations are printed here"));
    CHECK_FALSE(contains(page, "<b>"));
    CHECK(complaint(folder, "here/report.html") == "");
  }
}

TEST_CASE("a page has a million bytes at most: PNG in place of SVG, and then no figure") {
  const Folder folder;
  fs::create_directories(folder / "here/figures");
  folder.write("here/summary.json", "{\"version\": \"0.1.0\", \"status\": \"done\"}");
  const std::string rest(600000, ' ');
  folder.write("here/figures/energy.svg", "<svg xmlns='http://www.w3.org/2000/svg'>" + rest + "</svg>");
  folder.write("here/figures/energy.png", "\x89PNG small");
  folder.write("here/figures/waveforms.svg", "<svg xmlns='http://www.w3.org/2000/svg'>" + rest + rest + "</svg>");
  folder.write("here/figures/spacetime.svg", "<svg xmlns='http://www.w3.org/2000/svg'>" + rest + "</svg>");
  REQUIRE(delf_program(folder, "report here").code == 0);
  const std::string page = read(folder / "here/report.html");
  CHECK(page.size() <= 1000000);
  CHECK(contains(page, "figures/waveforms.svg is too large for this page"));
  CHECK(count(page, "<img ") == 2);
  CHECK(count(page, "data:image/png;base64,") + count(page, "data:image/svg+xml,") == 2);
  CHECK(count(page, "data:image/png;base64,") == 1);
}

TEST_CASE("a verification of another scene is not counted") {
  const Folder folder;
  REQUIRE(delf_program(folder, "verify kink --run.until=1 --output.figures=off --out here").code == 0);
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --out here").code == 0);
  REQUIRE(delf_program(folder, "report here").code == 0);
  CHECK(contains(read(folder / "here/report.html"), "Verification passed: all"));
  const auto with = [&](const std::string& key) {
    const std::string until = key.starts_with("--run.until") ? "" : " --run.until=1";
    REQUIRE(delf_program(folder, "run kink --output.figures=off --out here " + key + until).code == 0);
    REQUIRE(delf_program(folder, "report here").code == 0);
    CHECK(complaint(folder, "here/report.html") == "");
    return read(folder / "here/report.html");
  };
  for (const char* key : {"--lattice.stencil=triangle", "--theory.mass=1.5", "--initial.speed=0.25", "--run.until=2"}) {
    INFO(key);
    const std::string page = with(key);
    CHECK(contains(page, "The verification in this folder is of another scene, and is not counted."));
    CHECK_FALSE(contains(page, "Verification passed"));
  }
  CHECK(contains(with("--theory.mass=1.5"), "theory.mass is 1 in verify.json, and 1.5 in scene.ini"));
}

TEST_CASE("a verdict counts what is done, and no more") {
  const Folder folder;
  const std::string check = "{\"name\": \"noether\", \"passed\": true}";
  SECTION("interrupted verification") {
    const std::string page = page_of_result(
        folder, "verify.json",
        "\"subject\": \"rows computed here\", \"status\": \"interrupted\", \"passed\": true, \"checks\": [" + check +
            "]");
    CHECK(
        contains(page, "1 of 1 checks passed so far for rows computed here. It was interrupted, and is not finished."));
    CHECK_FALSE(is_good(page));
  }
  SECTION("verification that contradicts itself, or is empty") {
    CHECK_FALSE(is_good(page_of_result(
        folder, "verify.json",
        R"("status": "done", "passed": true, "checks": [{"name": "noether", "passed": false, "failure": "why"}])")));
    CHECK_FALSE(is_good(page_of_result(folder, "verify.json", R"("status": "done", "passed": true, "checks": [])")));
  }
  SECTION("interrupted convergence") {
    const std::string page = page_of_result(
        folder, "convergence.json",
        R"("status": "interrupted", "order": null, "order_of_scheme": 2, "passed": true, "verdict": "passed", "levels": [{}])");
    CHECK(contains(page, "was not measured, and the scheme"));
    CHECK(contains(page, "It was interrupted after 1 line, and is not finished."));
    CHECK_FALSE(contains(page, ": passed."));
    CHECK_FALSE(is_good(page));
  }
  SECTION("an order below rounding") {
    const std::string page = page_of_result(
        folder, "convergence.json",
        R"("status": "done", "order": null, "order_of_scheme": 2, "passed": true, "verdict": "passed", "levels": [{}, {}])");
    CHECK_FALSE(contains(page, ": passed."));
    CHECK_FALSE(is_good(page));
  }
  SECTION("a sweep with warnings") {
    const std::string page =
        page_of_result(folder, "sweep.json", R"("status": "done", "runs_asked": 2, "keys": ["run.seed"],
      "runs": [{"status": "done", "folder": "runs/a", "settings": {"run.seed": "1"}, "summary": {"warnings": []}},
               {"status": "done", "folder": "runs/b", "settings": {"run.seed": "2"}, "summary": {"warnings": ["too steep"]}}])");
    CHECK(contains(page, "2 of 2 runs ended well. Results of 1 run may be wrong: there are warnings."));
    CHECK(contains(page, "runs/b: too steep"));
    CHECK_FALSE(is_good(page));
  }
  SECTION("interrupted stability") {
    const std::string page = page_of_result(
        folder, "stability.json",
        R"("status": "interrupted", "passed": false, "limits": [{"agrees": true}, {"agrees": true}], "corners": [])");
    CHECK(contains(
        page, "2 of 2 limits passed so far, and 0 stress cases were tried. It was interrupted, and is not finished."));
    CHECK_FALSE(contains(page, "Stability failed"));
    CHECK_FALSE(is_good(page));
  }
}

TEST_CASE("the page of a sweep has all values in its command") {
  const Folder folder;
  REQUIRE(delf_program(folder, "compare kink --run.until=1 --lattice.courant=0.25,0.5 --output.figures=off --out here")
              .code == 0);
  REQUIRE(delf_program(folder, "report here").code == 0);
  const std::string page = read(folder / "here/report.html");
  CHECK(contains(page, "delf compare SCENE --lattice.courant=0.25,0.5"));
  CHECK(contains(page, "SCENE is the scene that the runs were made of"));
}

TEST_CASE("a page goes through a link, and into a pipe") {
  const Folder folder;
  fs::create_directory(folder / "here");
  folder.write("here/scene.ini", "[theory]\nname = sine-gordon\n");
  folder.write("kept.html", "old");
  fs::create_symlink("kept.html", folder / "link.html");
  REQUIRE(delf_program(folder, "report here --out link.html").code == 0);
  CHECK(fs::is_symlink(folder / "link.html"));
  CHECK(contains(read(folder / "kept.html"), "</html>"));
  CHECK(shell(folder, "mkfifo pipe && (cat pipe > piped.html & '" + program_path() + "' report here --out pipe; wait)")
            .code == 0);
  CHECK(fs::is_fifo(folder / "pipe"));
  CHECK(contains(read(folder / "piped.html"), "</html>"));
}

TEST_CASE("files of other programs are no results") {
  const Folder folder;
  fs::create_directory(folder / "here");
  folder.write("here/series.csv", "a,b\n1,2\n3,4\n");
  CHECK(delf_program(folder, "report here").code == 2);
  folder.write("here/summary.json", "{\"status\": \"ok\"}");
  folder.write("here/verify.json", "{\"passed\": true}");
  CHECK(delf_program(folder, "report here").code == 2);
  folder.write("here/scene.ini", "[theory]\nname = sine-gordon\n");
  REQUIRE(delf_program(folder, "report here").code == 0);
  const std::string page = read(folder / "here/report.html");
  CHECK(contains(page, "There are no results here yet, but only a scene."));
  CHECK(contains(page, "verify.json is of another program, and is not used."));
  CHECK_FALSE(is_good(page));
}

TEST_CASE("several folders are shown side by side, with the keys that differ") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.figures=off --out one").code == 0);
  REQUIRE(
      delf_program(folder, "run kink --run.until=1 --output.figures=off --lattice.stencil=triangle --out other").code ==
      0);
  const Ran ran = delf_program(folder, "report one other");
  CHECK(ran.code == 0);
  CHECK(complaint(folder, "report.html") == "");
  const std::string page = read(folder / "report.html");
  CHECK(contains(page, "<th scope=\"row\">lattice.stencil</th><td>rectangle-symmetric</td><td>triangle</td>"));
  CHECK(count(page, "The run ended well") == 2);
}

TEST_CASE("commands other than a run have pages, too") {
  const Folder folder;
  REQUIRE(
      delf_program(folder, "sweep kink --run.until=1 --lattice.courant=0.25,0.5 --output.report=on --out sweep").code ==
      0);
  CHECK(contains(read(folder / "sweep/report.html"), "2 of 2 runs ended well."));
  CHECK(complaint(folder, "sweep/report.html") == "");
  CHECK_FALSE(fs::exists(folder / "sweep/runs/lattice.courant=0.25/report.html"));
  REQUIRE(delf_program(folder, "convergence kink --run.until=2 --convergence.levels=3 --output.report=on --out conv")
              .code == 0);
  CHECK(contains(read(folder / "conv/report.html"), "The order of convergence is"));
  CHECK(complaint(folder, "conv/report.html") == "");
  REQUIRE(
      delf_program(
          folder, "stability kink --stability.schemes=rectangle --stability.corners=none --output.report=on --out stab")
          .code == 0);
  CHECK(contains(read(folder / "stab/report.html"), "Stability passed"));
  CHECK(complaint(folder, "stab/report.html") == "");
}

TEST_CASE("delf report refuses what is no folder of results") {
  const Folder folder;
  fs::create_directory(folder / "empty");
  for (const char* words : {"", " nowhere", " empty", " empty --run.until=3"}) {
    const Ran ran = delf_program(folder, std::string("report") + words);
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, "command line: "));
  }
}

TEST_CASE("the check of pages can fail") {
  const Folder folder;
  REQUIRE(delf_program(folder, "run kink --run.until=1 --output.report=on --out here").code == 0);
  const std::string page = read(folder / "here/report.html");
  const auto with = [&](const std::string& old, const std::string& mended) {
    std::string broken = page;
    const std::size_t at = broken.find(old);
    REQUIRE(at != std::string::npos);
    folder.write("broken.html", broken.replace(at, old.size(), mended));
    return complaint(folder, "broken.html");
  };
  CHECK(contains(with("</main>", ""), "not well-formed"));
  CHECK(contains(with("id=\"numbers\"", "id=\"figures\""), "an id is there twice"));
  CHECK(contains(with("<main>", "<main><script>1</script>"), "script"));
  CHECK(contains(with("href=\"#figures\"", "href=\"https://example.org\""), "links to"));
  CHECK(contains(with("src=\"data:image", "src=\"http:image"), "loads"));
  CHECK(contains(with("img-src data:", "img-src *"), "policy"));
  CHECK(contains(with("--quiet: #555a63", "--quiet: #999999"), "contrast"));
}

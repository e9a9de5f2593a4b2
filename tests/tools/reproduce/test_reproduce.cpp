// SPDX-License-Identifier: MIT
#include <algorithm>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/reproduce/discrete_equation.hpp"
#include "tools/reproduce/published_result.hpp"
#include "tools/reproduce/reproduction.hpp"
#include "tools/reproduce/result_number.hpp"

using namespace delf;
using namespace delf::testing;
using Json = nlohmann::json;
namespace fs = std::filesystem;

namespace {

const std::string head = "reference = Somebody (1900)\nchecked = here\n";

std::string entry(const std::string& id, const std::string& more) {
  return "[" + id + "]\ntitle = t\nwhere = (1)\n" + more;
}

/// `delf reproduce` with these results in place of the shipped ones.
Ran reproduced(const Folder& folder, const std::string& results, const std::string& arguments = "") {
  fs::create_directories(folder / "shipped/results");
  folder.write("shipped/results/paper.ini", results);
  return delf_program(folder, "reproduce --out out " + arguments, "DELF_SCENES=shipped");
}

Json results_of(const Folder& folder) { return Json::parse(read(folder / "out/results.json")); }

std::string shipped(const std::string& name) { return read(fs::path(scenes_folder()) / "results" / name); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  REQUIRE(text.find(from) != text.npos);
  for (auto at = text.find(from); at != text.npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
  return text;
}

const std::string plan =
    "  at (j,i)   (phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2\n              + m^2*sin(phi(j,i)) = 0\n";

}  // namespace

TEST_CASE("at least forty results are printed in their sources, and each has its source, its tolerance and its kind") {
  const auto all = published_results();
  CHECK(std::ranges::count(all, "printed", &PublishedResult::kind) >= 40);
  for (const PublishedResult& r : all) {
    INFO(r.place());
    CHECK_FALSE(r.reference.empty());
    CHECK((r.tolerance.empty() || !r.because.empty()));
    // the source of a derived value is a computation, and that of another one is not
    CHECK(r.checked.starts_with("derived: ") == (r.kind == "derived"));
    if (r.number == "equation") CHECK_NOTHROW(equation_difference(plan, r.expected));
    else CHECK_NOTHROW(numbers_of(r.expected, r.tolerance));
  }
}

TEST_CASE("verdicts are computed: as printed, as corrected, or neither, with a reason and without one") {
  const Folder folder;
  const std::string run =
      "command = run kink --lattice.sites=63 --run.steps=2\nnumber = sites\ntolerance = 0\nbecause = b\n";
  const Ran ran = reproduced(folder, head + entry("same", run + "printed = 60 + 3\n") +
                                         entry("wrong-print", run + "printed = 64\ncorrect = 63\n") +
                                         entry("other", run + "printed = 64\ndiffers = another count\n") +
                                         entry("red", run + "printed = 64\n") +
                                         entry("none", "like = red\nnumber = error_estimate\n") +
                                         entry("refused", "like = red\nkeys = --lattice.sites=-1\n"));
  INFO(ran.out << ran.err);
  CHECK(ran.code == 1);
  const Json json = results_of(folder);
  const char* verdicts[] = {"reproduced", "misprint", "differs", "failed", "failed", "failed"};
  REQUIRE(json["results"].size() == std::size(verdicts));
  for (std::size_t i = 0; i < std::size(verdicts); ++i) CHECK(json["results"][i]["verdict"] == verdicts[i]);
  CHECK(json["results"][2]["reason"] == "another count");
  CHECK(contains(json["results"][5]["reason"], "lattice.sites = -1"));
  CHECK(json["failed"] == 3);
  CHECK(lines(read(folder / "out/results.csv")).size() == 7);
  CHECK(contains(read(folder / "out/report.html"), "another count"));
  CHECK(contains(ran.out, "reproduced 1 of 6 printed; misprinted 1"));
}

TEST_CASE("values that are printed, drawn and derived are told apart") {
  const Folder folder;
  const std::string run =
      "command = run kink --lattice.sites=63 --run.steps=2\nnumber = sites\ntolerance = 0\nbecause = b\n";
  const Ran ran = reproduced(folder, head + entry("one", run + "derived = 63\n") + entry("two", "like = one\n") +
                                         entry("three", "like = one\ndrawn = 64\n") +
                                         entry("four", "like = one\nprinted = 63\nchecked = not checked: lost\n"));
  INFO(ran.out << ran.err);
  CHECK(contains(
      ran.out, "reproduced 1 of 1 printed (1 not checked in the source), 0 of 1 drawn, 2 of 2 derived; misprinted 0"));
  CHECK(contains(ran.out, "is not the drawn number"));
  CHECK(contains(read(folder / "out/report.html"),
                 "reproduced 1 of 1 printed (1 not checked in the source), 0 of 1 drawn, 2 of 2 derived"));
  CHECK(contains(read(folder / "out/results.csv"), "two,paper,(1),derived,63,"));
  const Json json = results_of(folder);
  CHECK(json["kinds"]["derived"]["reproduced"] == 2);
  CHECK(json["kinds"]["drawn"]["results"] == 1);
  CHECK(json["results"][2]["kind"] == "drawn");
  CHECK(json["results"][2]["expected"] == "64");
}

TEST_CASE("keys of the caller are named in reasons, and refused in one line where no command takes them") {
  const Folder folder;
  const std::string more =
      "command = run kink --lattice.sites=63 --run.steps=2\nnumber = sites\ntolerance = 0\nbecause = b\n"
      "printed = 63\n";
  const Ran other = reproduced(folder, head + entry("same", more), "--lattice.sites=65");
  CHECK(other.code == 1);
  CHECK(results_of(folder)["results"][0]["reason"] == "is not the printed number; computed with --lattice.sites=65");
  const Ran refused = reproduced(folder, head + entry("same", more), "--lattice.sites=abc");
  CHECK(refused.code == 2);
  CHECK(complaints(refused) == "command line: --lattice.sites = abc: is not an integer; write one like 255\n");
  CHECK(refused.out.empty());
}

TEST_CASE("a file of the working folder with the name of a shipped scene does not take its place") {
  const Folder folder;
  folder.write("kink", "nonsense\n");
  const Ran ran =
      reproduced(folder, head + entry("same",
                                      "command = run kink --lattice.sites=63 --run.steps=2\nnumber = sites\n"
                                      "tolerance = 0\nbecause = b\nprinted = 63\n"));
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
}

TEST_CASE("folders of an earlier call are gone after the next one") {
  const Folder folder;
  const std::string run =
      "command = run kink --lattice.sites=63 --run.steps=2\nnumber = sites\ntolerance = 0\nbecause = b\n";
  const std::string both =
      head + entry("one", run + "printed = 63\n") + entry("two", run + "keys = --run.steps=3\nprinted = 63\n");
  CHECK(reproduced(folder, both).code == 0);
  fs::create_directories(folder / "out/runs/mine");
  CHECK(fs::exists(folder / "out/runs/two"));
  CHECK(reproduced(folder, both, "one").code == 0);
  CHECK(fs::exists(folder / "out/runs/one"));
  CHECK_FALSE(fs::exists(folder / "out/runs/two"));
  CHECK(fs::exists(folder / "out/runs/mine"));
}

TEST_CASE("an equation that the plan has as a table is compared at the mass of the command") {
  const Folder folder;
  CHECK(delf_program(folder, "reproduce mps-vu-quoc-li mps-guo --theory.mass=3 --out out").code == 0);
  CHECK(results_of(folder)["misprint"] == 1);
}

TEST_CASE("an equation is compared coefficient by coefficient, up to a factor") {
  CHECK(equation_difference(plan, "-3*h^2*k*((phi(j+1,i) + phi(j-1,i) - 2*phi(j,i))/h^2 + m^2*sin(phi(j,i))) = 0")
            .largest < 1e-13);
  const auto off = equation_difference(plan, "(phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 - m^2*sin(phi(j,i)) = 0");
  CHECK(off.largest > 1e-3);
  CHECK(
      equation_difference(plan, "(phi(j+1,i) - 2*phi(j,i) + phi(j-1,i))/h^2 + m^2*sin(phi(j,i)) + 1e-6*phi(j,i+1) = 0")
          .largest > 1e-9);
  CHECK_THROWS(equation_difference("no plan", "phi(j,i) = 0"));
  CHECK_THROWS(equation_difference(plan, "phi(n,i) = 0"));
}

TEST_CASE("numbers are found in results by their names, places in lists, and the largest of all") {
  const Folder folder;
  folder.write("a.json", R"({"x": 2, "list": [{"name": "p q", "v": 3}, {"name": "r", "v": 5}], "ok": true, "none": null,
                             "measures": {"m": 7}})");
  folder.write("section.csv", "time,q1\n0.5,1\n1.5,4\n");
  const auto number = [&](const std::string& formula) { return result_number(formula, folder.path()); };
  CHECK(number("2*x + m") == Approx(11));
  CHECK(number("list[p q].v*list[-1].v") == Approx(15));
  CHECK(number("list[*].v") == Approx(5));
  CHECK(number("ok + section[1].q1 + sqrt(4) + 1e1") == Approx(17));
  CHECK_THROWS(number("list[s].v"));
  CHECK_THROWS(number("none"));
  CHECK_THROWS(number("nobody"));
}

TEST_CASE("a print is a number with a tolerance, a bound, or two bounds") {
  CHECK(numbers_of("3", "0.5").holds(3.5));
  CHECK_FALSE(numbers_of("3", "10%").holds(3.4));
  CHECK(numbers_of("< 1e-3", "").holds(-1));
  CHECK_FALSE(numbers_of("> 2*pi", "").holds(6));
  CHECK(numbers_of("1 to 2", "").holds(1.5));
  CHECK_FALSE(numbers_of("1 to 2", "").holds(NAN));
  CHECK_THROWS(numbers_of("3", ""));
}

TEST_CASE("ids that are none, and files of results that are none, are refused in one line") {
  const Folder folder;
  const Ran unknown = delf_program(folder, "reproduce mps-triangel");
  CHECK(unknown.code == 2);
  CHECK(unknown.err == "command line: reproduce mps-triangel: no such result; did you mean mps-triangle?\n");
  CHECK(delf_program(folder, "reproduce --lattice.sitse=3").code == 2);
  CHECK(delf_program(folder, "reproduce --reproduce.jobs=0").code == 2);
  for (const auto& [text, part] :
       {std::pair<std::string, std::string>{"[a]\nprinted = 1\n", "paper.ini:3: [a]: has no `command`"},
        {"[a]\nprintd = 1\n", "did you mean printed?"},
        {"[a]\n[a]\n", "is there already"},
        {"[a]\nlike = b\n", "no result above"},
        {"[../a]\n", "an id names a folder"},
        {entry("a", "slow = yes\ncommand = run kink\nnumber = sites\nprinted = < 1\n"), "add --reproduce.slow=on"},
        {"nonsense\n", "neither an [id] nor key = value"}}) {
    const Ran ran = reproduced(folder, head + text);
    INFO(ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, part));
    CHECK(lines(ran.err).size() == 1);
  }
}

TEST_CASE("results that have ended are kept after Ctrl-C") {
  const Folder folder;
  const std::string more = "number = sites\ntolerance = 0\nbecause = b\nprinted = 63\n";
  fs::create_directories(folder / "shipped/results");
  folder.write("shipped/results/paper.ini",
               head + entry("short", "command = run kink --lattice.sites=63 --run.steps=2\n" + more) +
                   entry("long", "command = run kink --lattice.sites=63 --run.steps=2000000000\n" + more));
  const Ran ran =
      shell(folder, "DELF_SCENES=shipped '" + program_path() +
                        "' reproduce --reproduce.jobs=2 --out out & while [ ! -s out/runs/short/summary.json ]; "
                        "do sleep 0.1; done; sleep 0.5; kill -INT $!; wait $!");
  CHECK(ran.code == 130);
  const Json json = results_of(folder);
  CHECK(json["status"] == "interrupted");
  REQUIRE(json["results"].size() == 1);
  CHECK(json["results"][0]["verdict"] == "reproduced");
}

TEST_CASE("wrong coefficients and wrong orders turn results red") {
  const Folder folder;
  // the weights of (5.9) with one of a quarter wrong, and half of φ_x
  const std::string wrong =
      "'--stencil.sites=(0,0) (1,0) (1,1) (0,1)' '--stencil.point=1; phi: 0.26 0.24 0.25 0.25; phi_t: -1 1 0 0; phi_x: -0.5 "
      "-0.5 0.5 0.5'";
  const std::string rectangle = "--lattice.stencil=rectangle\n";
  const Ran coefficients =
      reproduced(folder, replaced(shipped("marsden-patrick-shkoller.ini"), rectangle, wrong + "\n"),
                 "mps-rectangle mps-rectangle-iterative mps-rectangle-differences mps-symmetric");
  INFO(coefficients.out << coefficients.err);
  CHECK(coefficients.code == 1);
  CHECK(results_of(folder)["failed"] == 3);
  CHECK(results_of(folder)["reproduced"] == 1);
  const Ran orders = delf_program(folder,
                                  "reproduce gauss2-order lobatto3-order gauss3-order gauss1-order --out out "
                                  "--scheme.tableau=lobatto2");
  CHECK(orders.code == 1);
  CHECK(results_of(folder)["failed"] == 3);
  CHECK(results_of(folder)["reproduced"] == 1);
}

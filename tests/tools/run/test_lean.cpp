// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/solvers/row_layout.hpp"
#include "schemes/stepping/bytes_in_words.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"

#if defined(__GLIBC__) && defined(__GLIBC_PREREQ)
#if __GLIBC_PREREQ(2, 33)
#include <malloc.h>
#define DELF_ALLOCATOR_TELLS
#endif
#endif

using namespace delf;
using namespace delf::testing;

namespace {

const std::string lean_py = scenes_folder() + "/../lean.py", readme = scenes_folder() + "/../bench/README.md";

Ran lean(const Folder& folder, const std::string& arguments) {
  return shell(folder, "python3 -B '" + lean_py + "' --program '" + program_path() + "' " + arguments);
}

std::string with(std::string text, const std::string& part, const std::string& instead) {
  const auto at = text.find(part);
  REQUIRE(at != std::string::npos);
  return text.replace(at, part.size(), instead);
}

Problem problem(const std::string& theory, const std::string& stencil, int sites) {
  Problem p;
  p.theory = theory;
  p.stencil = stencil;
  p.lattice = Lattice::circle(sites, 40);
  p.time_step = 0.5 * p.lattice.space_step();
  return p;
}

std::vector<std::vector<double>> two_rows(int sites) {
  std::vector<double> row(sites);
  for (int i = 0; i < sites; ++i) row[i] = std::sin(2 * std::numbers::pi * i / sites);
  return {row, row};
}

}  // namespace

TEST_CASE("tools/lean.py reads plans, traces and maps, and would notice if it did not") {
  const Folder folder;
  const Ran examples = shell(folder, "python3 -B -m doctest '" + lean_py + "'");
  INFO(examples.out << examples.err);
  CHECK(examples.code == 0);
  // Items are parted at commas, but for the one with a comma of its own.
  folder.write("lean.py", with(read(lean_py), "(?!until )", ""));
  const Ran broken = shell(folder, "python3 -B -m doctest lean.py");
  CHECK(broken.code != 0);
  CHECK(contains(broken.out, "planned(text)"));
}

TEST_CASE("the table of tools/lean.py says what the plan says, and a page that says otherwise is found") {
  const Folder folder;
  folder.write("page.md", "above\n<!-- lean table begins -->\nold\n<!-- lean table ends -->\nbelow\n");
  const std::string scenes = " 'collision --lattice.stencil=triangle-vertex' kepler";
  const Ran made = lean(folder, "--repeats 1 --update page.md" + scenes);
  INFO(made.err);
  REQUIRE(made.code == 0);
  const std::string page = read(folder / "page.md");
  CHECK(page.starts_with("above\n<!-- lean table begins -->\n\n| scene |"));
  CHECK(page.ends_with("\n<!-- lean table ends -->\nbelow\n"));
  CHECK_FALSE(contains(page, "\nold\n"));

  const Simulation explicit_one(problem("sine-gordon", "triangle-vertex", 255));
  const RowLayout& layout = *explicit_one.evolution().stepper().layout();
  const std::size_t index = layout.bytes(), weights = RowBuffer::bytes_of(layout.doubles());
  const std::size_t measured = 4 * weights;  // rows that residual() works in
  CHECK(explicit_one.bytes_of_run({}) == explicit_one.bytes() + weights + measured);
  CHECK(contains(page, fmt::format("| `collision --lattice.stencil=triangle-vertex` | {} | {} |",
                                   explicit_one.bytes() - index, index + weights + measured)));
  for (const std::string& line : lines(page))
    if (line.starts_with("| `")) {
      INFO(line);
      CHECK(std::count(line.begin(), line.end(), '|') == 9);
      CHECK_FALSE(contains(line, "|  |"));
    }

  const auto checked = [&](const std::string& text) {
    folder.write("page.md", text);
    return lean(folder, "--check page.md" + scenes);
  };
  CHECK(checked(page).code == 0);
  const Ran forgotten = checked(with(page, "| `kepler` |", "| kepler |"));
  CHECK(forgotten.code == 1);
  CHECK(contains(forgotten.err, "does not say: `kepler`"));
  const Ran invented = checked(with(page, "Left out by all: ", "Left out by all: rows; "));
  CHECK(invented.code == 1);
  CHECK(contains(invented.err, "it is not so: Left out by all: rows; "));
  CHECK(checked("no table").code == 2);
  CHECK(lean(folder, "--repeats 1 --update page.md kepler").code == 2);
}

TEST_CASE("the table of costs in tools/bench/README.md has every shipped scene, and what it leaves out") {
  if (!contains(read(readme), "<!-- lean table begins -->")) {
    WARN("tools/bench/README.md has no markers of the table");
    return;
  }
  const Folder folder;
  const Ran ran = lean(folder, "--check '" + readme + "'");
  INFO(ran.err << "tools/lean.py --update tools/bench/README.md");
  CHECK(ran.code == 0);
}

TEST_CASE("an explicit step on a circle has no arrays but its rows, and those in which a residual is measured") {
  for (const char* theory : {"wave", "sine-gordon"})
    for (int sites : {255, 256, 1023, 4095}) {
      CAPTURE(theory, sites);
      Simulation simulation(problem(theory, "triangle-vertex", sites));
      // A row is N sites filled up to whole packs, and a pack beyond either end, in whole cache lines; three rows of y and
      // of v each.
      const int packs = (sites + lanes - 1) / lanes;
      const std::size_t row = sizeof(double) * delf::at(((packs + 2) * lanes + 7) / 8 * 8);
      // What does not grow with N: for each slot that repeats a site, where it is, which it repeats, and turns.
      const std::size_t index = 3 * sizeof(int) * delf::at(2 * lanes + packs * lanes - sites);
      CHECK(simulation.bytes() == 6 * row + index);
      // residual() works in rows for the left side, its rounding, the newest values and, if there are any, source terms.
      const std::size_t measured = (theory == std::string("wave") ? 3 : 4) * row;
      const std::string memory = fmt::format(
          "memory       {}, {} bytes: rows of the field and increments {} B, source terms 0 B, matrix 0 B, work space "
          "{} B, "
          "monitors {} B\n",
          bytes_in_words(7 * row + index + measured), 7 * row + index + measured, 6 * row, index + measured, row);
      CHECK(contains(simulation.plan_report(), memory));
      CHECK(contains(simulation.plan_report(), "any matrix"));
      simulation.start(two_rows(sites));
      for (int j = 0; j < 1500; ++j) simulation.step(j % 100 == 0);  // now and then a row is kept
      simulation.step();
      CHECK(simulation.residual() < 1e-14);
      CHECK(simulation.bytes() == 6 * row + index + measured);
      simulation.monitors();  // weigh the cells
      CHECK(simulation.bytes() == 7 * row + index + measured);
      const Simulation implicit_one(problem(theory, "rectangle-symmetric", sites));
      CHECK(implicit_one.bytes() > 6 * row + index);
      CHECK_FALSE(contains(implicit_one.plan_report(), "any matrix"));
    }
}

#ifdef DELF_ALLOCATOR_TELLS
TEST_CASE("the bytes of a plan are those that the allocator has given") {
  constexpr int sites = 8191;
  constexpr double slack = 16384;  // equations, the plan, and the allocator's own; a row is four times that
  const auto in_use = [] {
    const struct mallinfo2 info = mallinfo2();
    return static_cast<double>(info.uordblks) + static_cast<double>(info.hblkhd);
  };
  const auto rows = two_rows(sites);
  if (in_use() == 0) {  // a sanitizer has put its own allocator in the place
    WARN("the allocator says nothing");
    return;
  }
  REQUIRE(mallopt(M_MMAP_THRESHOLD, 1 << 24) == 1);  // nothing by whole pages, whose rounding is as large as the slack
  // What a run does, with everything that it keeps: what is planned before is what is given, and what is told after.
  for (const char* theory : {"wave", "sine-gordon"})
    for (const char* stencil : {"triangle-vertex", "rectangle-symmetric"}) {
      const Problem p = problem(theory, stencil, sites);
      Simulation(p).start(rows);  // what is made once for all stays
      const double before = in_use();
      Simulation simulation(p);
      simulation.start(rows);
      const double planned = static_cast<double>(simulation.bytes_of_run({}));
      for (int j = 0; j < 20; ++j) simulation.step(j > 9);
      CHECK(simulation.residual() < 1e-14);
      simulation.monitors();
      const double given = in_use() - before;
      CHECK(static_cast<double>(simulation.bytes()) == planned);
      CAPTURE(theory, stencil, given, planned);
      CHECK(std::abs(given - planned) < slack);
      const std::vector<double> one_row_more(sites, 1.0);
      CHECK_FALSE(std::abs(in_use() - before - planned) < slack);
      CHECK(one_row_more[0] == 1);
    }
}
#endif

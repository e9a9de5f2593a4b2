// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cstdlib>
#include <sstream>

#include "tests/catch.hpp"
#include "tests/tools/figures/golden_figures.hpp"
#include "tests/tools/figures/has_gnuplot.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;
namespace fs = std::filesystem;

namespace {

constexpr int columns = 30, rows = 20;  // of blocks of 60 x 60 pixels: fonts and hinting do not show

// How dark each block of a PNG is, from a (white) to z, a line for each row of blocks. gnuplot itself reads the file.
std::string coarse(const Folder& folder, const std::string& png) {
  folder.write("read", "set table 'grey'\nplot '" + png +
                           "' binary filetype=png every 6:6 using (0.3*$1+0.6*$2+0.1*$3) with image\n");
  REQUIRE(shell(folder, "gnuplot read").code == 0);
  std::array<double, columns * rows> dark{}, count{};
  for (const std::string& line : lines(read(folder / "grey"))) {
    double x = 0, y = 0, grey = 0;
    if (line.empty() || line[0] == '#' || !(std::istringstream(line) >> x >> y >> grey)) continue;
    const std::size_t block = columns * static_cast<int>((1199 - y) / 60) + static_cast<int>(x / 60);
    REQUIRE(block < dark.size());
    dark[block] += 255 - grey, count[block] += 1;
  }
  std::string image;
  for (std::size_t b = 0; b < dark.size(); ++b) {
    REQUIRE(count[b] == 100);
    image += static_cast<char>('a' + std::min(25, static_cast<int>(dark[b] / count[b] / 4)));
    if ((b + 1) % columns == 0) image += "\n";
  }
  return image;
}

// The mean distance of blocks, in letters.
double distance(const std::string& a, const std::string& b) {
  REQUIRE(a.size() == b.size());
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::abs(a[i] - b[i]);
  return sum / (columns * rows);
}

constexpr double near = 0.2;

}  // namespace

TEST_CASE("the figures of a run look as they did, seen coarsely") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const std::string keys = " --output.format=png --output.titles=off --output.fields=off --out ";
  REQUIRE(delf_program(folder, "run breather --lattice.sites=129 --run.until=40" + keys + "breather").code == 0);
  REQUIRE(delf_program(folder, "run kepler --run.until=13" + keys + "kepler").code == 0);
  std::vector<std::string> seen;
  for (const auto& [name, golden] : golden_figures) {
    seen.push_back(coarse(folder, name));
    INFO(name << "\n" << seen.back());
    CHECK(distance(seen.back(), golden) < near);
  }
  // and it can fail: no two of them are as near to each other
  for (std::size_t a = 0; a < seen.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) CHECK(distance(seen[a], seen[b]) > 2 * near);
}

TEST_CASE("figures have the formats and the titles that are asked for") {
  REQUIRE(has_gnuplot());  // tools/setup installs it
  const Folder folder;
  const std::string run = "run kink --run.until=2 --out here ";
  REQUIRE(delf_program(folder, run).code == 0);
  CHECK(contains(read(folder / "here/figures/energy.svg"), "kink: the energy error"));
  REQUIRE(delf_program(folder, run + "--output.format=svg,pdf --output.titles=off").code == 0);
  CHECK(read(folder / "here/figures/energy.pdf").starts_with("%PDF"));
  CHECK_FALSE(fs::exists(folder / "here/figures/energy.png"));  // of the earlier run
  CHECK_FALSE(contains(read(folder / "here/figures/energy.svg"), "kink"));
  check_refused(delf_program(folder, run + "--output.format=svg,jpeg"),
                {"output.format", "jpeg is none of svg, png, pdf"});
}

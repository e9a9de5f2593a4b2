// SPDX-License-Identifier: MIT
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"

using namespace delf::testing;

TEST_CASE("steps of a file that cannot be read are refused with the file and its line") {
  const Folder folder;
  const auto refused = [&](const std::string& file, const std::string& text, const std::string& why) {
    if (!text.empty()) folder.write(file, text);
    check_refused(delf_program(folder, "plan sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=" + file),
                  {"--lattice.time_steps = " + file + ": " + why});
  };
  refused("steps.txt", "# of the rows\n0.1, 0.2\n\n0.3, 0.x  # no number\n", "line 4: \"0.x\" is no number");
  refused("steps.txt", "0.1\n0.2,,0.3\n", "line 2: \"\" is no number");
  refused("steps.txt", "0.1\n-0.2\n", "line 2: -0.2 is no step: steps must be above 0");
  refused("steps.txt", "# none\n", "is a file without steps");
  refused(".", "", "is no regular file");
  refused("nowhere.txt", "", "\"nowhere.txt\" is no number");
  folder.write("steps.txt", "0.1, # two\n  0.05,\n");
  const Ran plan = delf_program(folder, "plan sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=steps.txt");
  CHECK(plan.code == 0);
  CHECK(contains(plan.out, "2 lengths in turn"));
}

TEST_CASE("a run with steps in turn ends with the first row that is as late as its end") {
  const Folder folder;
  const auto steps_until = [&](const std::string& end) {
    const Ran plan = delf_program(
        folder, "plan sphere --lattice.mesh=icosahedron:1 --lattice.time_steps=0.05,0.1,0.2 --run.until=" + end);
    REQUIRE(plan.code == 0);
    return plan.out.substr(plan.out.find("  steps ") + 13, 2);
  };
  CHECK(steps_until("0.05") == "1 ");
  CHECK(steps_until("0.1") == "2 ");
  CHECK(steps_until("0.35") == "3 ");
  CHECK(steps_until("0.36") == "4 ");
}

// SPDX-License-Identifier: MIT
#include "lattice/nearest_name.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/report/failure.hpp"
#include "tools/scene/keys.hpp"

using namespace delf::testing;

TEST_CASE("help, version and lists go to stdout and succeed") {
  const Folder folder;
  for (const char* arguments : {"help", "--help", "-h", "help run", "run --help", "help plan", "help verify",
                                "help lagrangians", "verify --help", "list", "list theories", "list stencils",
                                "list schemes", "list states", "list scenes", "--version"}) {
    const Ran ran = delf_program(folder, arguments);
    INFO(arguments);
    CHECK(ran.code == 0);
    CHECK(complaints(ran) == "");
    CHECK_FALSE(ran.out.empty());
  }
  CHECK(delf_program(folder, "--version").out == "delf " DELF_VERSION "\n");
  CHECK(contains(delf_program(folder, "list stencils").out, "rectangle-symmetric"));
  CHECK(contains(delf_program(folder, "list scenes").out, "collision"));
}

TEST_CASE("the helps of all commands list every key") {
  const Folder folder;
  std::string help;
  for (const char* command : {"run", "verify", "sweep", "convergence", "stability", "workprecision"})
    help += delf_program(folder, std::string("help ") + command).out;
  for (const auto& key : delf::keys()) CHECK(contains(help, key.key));
}

TEST_CASE("delf help run says what the energy is, and which methods have one of their own") {
  const Folder folder;
  const std::string help = delf_program(folder, "help run").out;
  CHECK(contains(help, "E = k Σ (φ_t ∂ℓ/∂φ_t − ℓ), jets of the symmetric rectangle on the last two rows"));
  CHECK(contains(help, "order 2 in h and k"));
  CHECK(contains(help, "r-adaptive"));
}

TEST_CASE("delf list names the aliases of stencils, and says which rule trapezoidal is not") {
  const Folder folder;
  const std::string listed = delf_program(folder, "list stencils").out;
  CHECK(contains(listed, "not the trapezoidal rule"));
  CHECK(contains(listed, "also found by leapfrog, yee, stormer-verlet"));
}

TEST_CASE("without a command the usage is shown, and that is not success") {
  const Folder folder;
  const Ran ran = delf_program(folder, "");
  CHECK(ran.code == 2);
  CHECK(contains(ran.out, "delf run SCENE"));
  CHECK(contains(ran.out, "delf verify SCENE"));
  CHECK(contains(ran.out, "delf workprecision SCENE"));
  CHECK(contains(ran.out, "delf stability SCENE"));
}

TEST_CASE("a command that is not there is refused in one line") {
  const Folder folder;
  const auto refused = [&](const char* arguments, const char* reason) {
    check_refused(delf_program(folder, arguments), {reason});
  };
  refused("rnu collision", "did you mean run?");
  refused("collision", "did you mean `delf run collision`?");
  refused("run", "Name a scene file");
  refused("list stencil", "did you mean stencils?");
  refused("list --lattice.sites=3", "reads no scene");
  refused("plan collision --out here", "writes no files");
}

TEST_CASE("the plan says how the collision is solved, and what is left out") {
  const Folder folder;
  const Ran ran = delf_program(folder, "plan collision --output.fields=off");
  CHECK(ran.code == 0);
  CHECK(contains(ran.out, "cyclic band"));
  CHECK(contains(ran.out, "HDF5 is not touched"));
  CHECK(contains(delf_program(folder, "plan collision --lattice.stencil=triangle-vertex").out, "explicit"));
  CHECK_FALSE(std::filesystem::exists(folder / "results"));
}

TEST_CASE("the nearest name is found within a few typing errors, and none far away") {
  const std::vector<std::string> names{"triangle", "triangle-vertex", "rectangle", "rectangle-symmetric", "hexagon"};
  CHECK(delf::nearest("hexagn", names) == "hexagon");
  CHECK(delf::nearest("Hexagon", names) == "hexagon");
  CHECK(delf::nearest("recatngle", names) == "rectangle");
  CHECK(delf::nearest("rectangle_symetric", names) == "rectangle-symmetric");
  CHECK(delf::nearest("hex", names) == "hexagon");
  CHECK_FALSE(delf::nearest("banana", names));
  CHECK_FALSE(delf::nearest("", names));
}

TEST_CASE("every kind of failure has its exit code") {
  using namespace delf;
  CHECK(exit_code(BadScene("")) == ExitCode::bad_input);
  CHECK(exit_code(BadInput("", "")) == ExitCode::bad_input);
  CHECK(exit_code(NoConvergence("")) == ExitCode::numerics_failed);
  CHECK(exit_code(NotFinite("")) == ExitCode::numerics_failed);
  CHECK(exit_code(SystemFailure("")) == ExitCode::system_failed);
  CHECK(exit_code(std::bad_alloc()) == ExitCode::system_failed);
  CHECK(lines(error_line(SystemFailure("two\nlines"))).size() == 1);
  CHECK(lines(error_line(BadInput("", "two\n  lines\r\n  more"))).size() == 1);
  CHECK(contains(error_line(SystemFailure("red \033[31m")), "red ?[31m"));
}

TEST_CASE("lines of progress are no complaints, and every other line is one") {
  CHECK(complaints({0, "", "22 %: step 4 of 18 after 14 s, 48 s left\n"}) == "");
  CHECK(complaints({0, "", "warning: 22 %: step 4 of 18\n9 %: run 1 of 9 after 11 s, 2 min left\n"}) ==
        "warning: 22 %: step 4 of 18\n");
}

// SPDX-License-Identifier: MIT
#include "lattice/nearest_name.hpp"
#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tests/tools/refused.hpp"
#include "tools/report/failure.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/scene/keys.hpp"

using namespace delf::testing;

TEST_CASE("help, version and lists go to stdout and succeed") {
  const Folder folder;
  for (const char* arguments : {"help", "--help", "-h", "help run", "run --help", "help plan", "help verify",
                                "help lagrangians", "verify --help", "list", "list theories", "list stencils",
                                "list schemes", "list states", "list scenes", "list results", "--version"}) {
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
  for (const char* command :
       {"run", "verify", "sweep", "convergence", "stability", "workprecision", "reproduce", "film", "cite"})
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

TEST_CASE("help fits on a hundred columns, with keys in groups and the values of each") {
  const Folder folder;
  for (const char* of : {"run", "resume", "plan", "verify", "sweep", "compare", "convergence", "workprecision",
                         "stability", "lagrangians", "measures", ""})
    for (const std::string& line : lines(delf_program(folder, std::string("help ") + of).out)) {
      INFO(line);
      CHECK(delf::columns_of(line) <= 100);
    }
  const std::string run = delf_program(folder, "help run").out;
  CHECK(contains(run, "[scheme]  the method, and how it solves a step"));
  CHECK(run.find("scheme.tolerance") < run.find("  with scheme.method = composition:"));
  CHECK(run.find("  with scheme.method = composition:") < run.find("scheme.splitting"));
  const std::string space = delf_program(folder, "help lattice.space").out;
  CHECK(contains(space, "\n  circle\n  interval\n  point\n  complex\n"));
  CHECK(contains(delf_program(folder, "help output.figures").out, "\n  on\n  off\n"));
}

TEST_CASE("bash completes commands, scenes, keys, their values and files of rows") {
  const Folder folder;
  folder.write("rows.csv", "1\n");
  const std::string script = std::filesystem::path(scenes_folder()).parent_path() / "completion/delf.bash";
  // breaks: of COMP_WORDBREAKS, which the script leaves as they are
  const auto complete = [&](const std::string& line, const std::string& words, bool breaks) {
    const std::string set = breaks ? "COMP_WORDBREAKS=$' \\t\\n=:'" : "COMP_WORDBREAKS=$' \\t\\n'";
    folder.write("complete.sh",
                 set + "; before=$COMP_WORDBREAKS; compopt() { :; }\n. '" + script + "'\n" +
                     "[ \"$before\" = \"$COMP_WORDBREAKS\" ] || echo changed\n" + "delf() { '" + program_path() +
                     "' \"$@\"; }\nCOMP_LINE='" + line + "'; COMP_POINT=${#COMP_LINE}\n" + "COMP_WORDS=(" + words +
                     "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n" + "_delf; printf '%s\\n' \"${COMPREPLY[@]}\"\n");
    return shell(folder, "bash complete.sh").out;
  };
  CHECK(complete("delf com", "delf com", true) == "compare\n");
  CHECK(contains(complete("delf run col", "delf run col", true), "collision\n"));
  CHECK(complete("delf run kink --lattice.cour", "delf run kink --lattice.cour", true) == "--lattice.courant=\n");
  CHECK(complete("delf run kink --lattice.space=c", "delf run kink --lattice.space = c", true) == "circle\ncomplex\n");
  CHECK(complete("delf run kink --lattice.space=i", "delf run kink --lattice.space=i", false) ==
        "--lattice.space=interval\n");
  CHECK(complete("delf compare kink --lattice.stencil=triangle,hex", "delf compare kink --lattice.stencil=triangle,hex",
                 false) == "--lattice.stencil=triangle,hexagon\n");
  CHECK(complete("delf reproduce mps-sym", "delf reproduce mps-sym", true) ==
        "mps-symmetric\nmps-symmetric-differences\nmps-symmetric-order\n");
  CHECK(complete("delf verify kink --fields ro", "delf verify kink --fields ro", true) == "rows.csv\n");
  CHECK(complete("delf verify kink --fie", "delf verify kink --fie", true) == "--fields\n");
}

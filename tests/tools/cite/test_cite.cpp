// SPDX-License-Identifier: MIT
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/shipped_scenes.hpp"

using namespace delf::testing;

namespace {

/// The text with blanks for the ends of its lines, which may be anywhere.
std::string in_one_line(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// What `cite ARGUMENTS` prints.
std::string cited(const Folder& folder, const std::string& arguments) {
  return in_one_line(delf_program(folder, "cite " + arguments).out);
}

/// A document around a methods section.
std::string compiled(const Folder& folder, const std::string& section) {
  folder.write("paper.tex",
               "\\documentclass{article}\n\\usepackage[T1]{fontenc}\n\\usepackage{amsmath}\n\\begin{document}\n"
               "\\input{" +
                   section + "/methods}\n\\bibliographystyle{plain}\n\\bibliography{" + section +
                   "/references}\n\\end{document}\n");
  return shell(folder, "pdflatex -interaction=nonstopmode -halt-on-error paper.tex").code == 0
             ? ""
             : read(folder / "paper.log");
}

bool has_latex(const Folder& folder) { return shell(folder, "command -v pdflatex").code == 0; }

}  // namespace

TEST_CASE("cite prints a methods section of a scene, with the discrete equations and all that it rests on") {
  const Folder folder;
  const Ran ran = delf_program(folder, "cite collision");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  for (const char* part :
       {"We solve the sine-Gordon equation \\cite{perring-skyrme-1962,scott-chu-mclaughlin-1973}", "\\varphi_{tt}",
        "\\ell =", "on a circle of length $40$ for $0\\le t\\le 100$",
        "the symmetric rectangle \\cite{marsden-patrick-shkoller-1998}", "\\varphi_{i}^{j+1}",
        "The scheme is of order 2.", "multisymplectic form formula", "$N = 255$ sites", "$h/k = 0.125$",
        "\\operatorname{am}", "simplified Newton method", "\\cite{delf}", "\\cite{hdf5}"}) {
    INFO(part);
    CHECK(contains(in_one_line(ran.out), part));
  }
  CHECK(contains(cited(folder, "collision --cite.format=text"), "References "));
  CHECK(contains(cited(folder, "collision --cite.format=markdown"), "[@perring-skyrme-1962; @scott"));
  // keys of the command line are those of the scene
  CHECK(contains(cited(folder, "collision --lattice.stencil=hexagon --lattice.sites=256"), "the hexagon"));
  CHECK(contains(cited(folder, "collision --scheme.method=guo"), "\\cite{guo-1986,marsden-"));
  CHECK(contains(cited(folder, "breather --scheme.method=composition --scheme.order=8"), "kahan-li-1997"));
}

TEST_CASE("cite of a folder has the numbers of its run and of its checks") {
  const Folder folder;
  folder.write("own.ini", small_scene());
  REQUIRE(delf_program(folder, "run own.ini --out run --output.figures=off").code == 0);
  REQUIRE(delf_program(folder, "verify own.ini --out run --output.figures=off").code == 0);
  const Ran ran = delf_program(folder, "cite run --cite.format=text");
  INFO(ran.err);
  REQUIRE(ran.code == 0);
  CHECK(contains(in_one_line(ran.out), "a relative error of the energy of at most"));
  CHECK(contains(in_one_line(ran.out), "checks of `delf verify` passed, among them the field equations to"));
  CHECK(contains(in_one_line(ran.out), "The computation was made with delf"));
  REQUIRE(delf_program(folder, "verify own.ini --out run --output.figures=off --verify.fault=sign").code == 1);
  CHECK(contains(cited(folder, "run --cite.format=text"), "checks of `delf verify` failed: field equations; form"));
  // the place of a warning is one of this machine
  std::string summary = read(folder / "run/summary.json");
  const std::string none = "\"warnings\": []";
  REQUIRE(contains(summary, none));
  summary.replace(summary.find(none), none.size(),
                  "\"warnings\": [\"/some/where/own.ini:40: run.every: has no effect\"]");
  folder.write("run/summary.json", summary);
  CHECK(contains(cited(folder, "run --cite.format=text"), "It ended with a warning: run.every: has no effect."));
  REQUIRE(delf_program(folder, "cite run --out paper").code == 0);
  CHECK(contains(read(folder / "paper/methods.tex"), "\\cite{delf}"));
  CHECK(contains(read(folder / "paper/methods.md"), "[@delf]"));
  CHECK(contains(read(folder / "paper/references.bib"), "@misc{delf,"));
  REQUIRE(delf_program(folder,
                       "convergence own.ini --out order --convergence.levels=2 --output.figures=off "
                       "--output.report=on")
              .code < 2);
  CHECK(contains(cited(folder, "order --cite.format=text"), "On 2 levels of steps"));
  REQUIRE(delf_program(folder, "sweep own.ini --out study --run.steps=3,4 --output.figures=off").code == 0);
  CHECK(contains(cited(folder, "study --cite.format=text"), "The study varied `run.steps` over 3 and 4"));
}

TEST_CASE("what cannot be cited is refused in one line") {
  const Folder folder;
  std::filesystem::create_directories(folder / "empty");
  folder.write("bad.ini", small_scene("[cite]\nsources = whitham-1975\n"));
  for (const auto& [arguments, complaint] :
       {std::pair{"cite", "cite what? Name a scene, or a folder of results"},
        {"cite empty", "command line: cite empty: holds no results of delf"},
        {"cite no-such-scene", "no-such-scene"},
        {"cite kink --cite.format=word", "cite.format = word"},
        {"cite bad.ini", "whitham-1975: is no key of references.bib; did you mean whitham-1974?"},
        {"cite kink --latex", "--latex: `cite` prints no formulas"}}) {
    const Ran ran = delf_program(folder, arguments);
    INFO(arguments << ": " << ran.err);
    CHECK(ran.code == 2);
    CHECK(contains(ran.err, complaint));
    CHECK(lines(ran.err).size() == 1);
  }
  folder.write("own.ini", small_scene());
  REQUIRE(delf_program(folder, "run own.ini --out run --output.figures=off").code == 0);
  const Ran other = delf_program(folder, "cite run --lattice.sites=5");
  CHECK(other.code == 2);
  CHECK(contains(other.err, "--lattice.sites: run/scene.ini says what its results were made with"));
  std::filesystem::remove(folder / "run/scene.ini");
  CHECK(contains(delf_program(folder, "cite run").err, "has no scene.ini"));
}

TEST_CASE("a methods section says of a scene what holds for it") {
  const Folder folder;
  struct Said {
    const char* arguments;
    std::vector<std::string> parts, not_said;
  };
  const std::vector<Said> all{
      {"modulational-instability", {"; v(0, x) = "}, {"- b); 2 w s"}},
      // a plan is explicit, and each unknown of its own equation is iterated
      {"pendulum", {"simplified Newton method", "phi(j+1) - 2*phi(j)", "at every row j"}, {"is explicit", ",i)"}},
      {"collision --scheme.method=guo", {"simplified Newton method"}, {"is explicit"}},
      {"kepler", {"Each step is explicit."}, {}},
      // walls take the momentum
      {"fermi-pasta-ulam", {"multisymplectic form formula."}, {"Noether"}},
      {"kdv", {"tanh(w (x - 15 - 4 w^2 t)), where w = 0.5; the second row"}, {"Noether", "with w = 0.5"}},
      {"liouville", {"where a = 0.5 and b = 0.5"}, {"with a = 0.5"}},
      {"wave-map", {"Noether", "rotation x"}, {}},
      {"sphere", {"phi_t = 0; the first step follows from the discrete Legendre transform"}, {}},
      {"sphere --lattice.time_steps=reversible --lattice.step_control=0.5",
       {"is reversible, not symplectic"},
       {"multisymplectic form formula"}},
      {"asynchronous", {"at t = 0, with the rate of this solution; the first step"}, {}},
      {"pendulum --scheme.method=radau-iia", {"the first step starts from q and q_t"}, {"Legendre"}},
      {"phi4-kink", {"D. K. Campbell"}, {"Perring"}},
      {"impurity", {"Fei"}, {"Perring", "D. K. Campbell"}},
      {"kink", {"Perring"}, {"D. K. Campbell", "Fei"}},
      {"turning-soliton", {"is u = tanh(x - 12) cos(t); v = ", "SHAKE"}, {"By linear theory", "phi1"}},
      {"kink --lattice.courant=0.5", {"finds no limit of the step up to h/k = 3"}, {}},
      {"kink --lattice.courant=4", {"h/k = 4"}, {"finds no limit"}}};
  for (const Said& said : all) {
    const std::string text = cited(folder, std::string(said.arguments) + " --cite.format=text");
    INFO(said.arguments << ": " << text);
    for (const std::string& part : said.parts) {
      INFO(part);
      CHECK(contains(text, part));
    }
    for (const std::string& part : said.not_said) {
      INFO(part);
      CHECK_FALSE(contains(text, part));
    }
  }
}

TEST_CASE("a methods section compiles in LaTeX") {
  const Folder folder;
  if (!has_latex(folder)) {
    WARN("pdflatex is missing: nothing is compiled");
    return;
  }
  for (const char* scene : {"collision", "kepler", "sphere", "solar-system"}) {
    REQUIRE(delf_program(folder, std::string("cite ") + scene + " --out " + scene).code == 0);
    INFO(scene);
    CHECK(compiled(folder, scene) == "");
  }
  std::filesystem::create_directories(folder / "bad");
  folder.write("bad/methods.tex", "\\nosuchcommand\n");
  CHECK(compiled(folder, "bad") != "");
}

TEST_CASE("every shipped scene has a methods section", "[slow]") {
  const Folder folder;
  for (const delf::ShippedScene& scene : delf::shipped_scenes()) {
    const Ran ran = delf_program(folder, "cite " + scene.name + " --out " + scene.name);
    INFO(scene.name << ": " << ran.err);
    CHECK(ran.code == 0);
    if (ran.code != 0) continue;
    const std::string section = in_one_line(read(folder / (scene.name + "/methods.tex")));
    CHECK((contains(section, "We solve ") || contains(section, "We integrate ")));
    CHECK(contains(section, "We use "));
    CHECK(contains(section, "\\cite{delf}"));
  }
}

// SPDX-License-Identifier: MIT
#include <sstream>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/shipped_scenes.hpp"

using namespace delf::testing;

namespace {

// The lines `# $ delf …` that a scene opens with.
std::vector<std::string> commands_of(const std::filesystem::path& scene) {
  std::vector<std::string> commands;
  const std::string mark = "# $ delf ";
  for (const std::string& line : lines(read(scene)))
    if (line.starts_with(mark)) commands.push_back(line.substr(mark.size()));
  return commands;
}

// Sanitizers make a step twenty times as long, and see all of its code in the first ones.
#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

// True for scenes that are solved at once, without steps.
bool is_still(const std::filesystem::path& scene) {
  const std::string text = read(scene);
  return contains(text, "time = none") || contains(text, "mesh = refined:");
}

// The command with few steps, where there are any, and no figures.
std::string shortened(const std::string& command, bool still) {
  const bool converges = command.starts_with("convergence ");
  std::istringstream words(command);
  std::string out;
  for (std::string word; words >> word;)
    if (!word.starts_with("--run.until=") && !word.starts_with("--run.steps=") &&
        !(sanitized && word.starts_with("--convergence.levels=")))
      out += word + " ";
  if (sanitized && converges) out += "--convergence.levels=2 ";
  return out + (still ? "" : "--run.steps=12 ") + "--output.figures=off" + (command.starts_with("plan ") ? "" : " --out out");
}

}  // namespace

TEST_CASE("the scenes are shipped, each with its equation and the commands that run it") {
  std::vector<std::string> names;
  for (const auto& scene : delf::shipped_scenes()) {
    names.push_back(scene.name);
    INFO(scene.name);
    CHECK_FALSE(scene.title.empty());
    CHECK((contains(read(scene.file), "_t") || contains(read(scene.file), "grad")));
    CHECK(contains(read(scene.file), "# Source: "));
    const auto commands = commands_of(scene.file);
    REQUIRE_FALSE(commands.empty());
    CHECK(commands.front() == "run " + scene.name);
  }
  CHECK(names == std::vector<std::string>{"asynchronous",
                                          "beam",
                                          "born-infeld",
                                          "boussinesq",
                                          "breather",
                                          "camassa-holm",
                                          "collision",
                                          "complex-klein-gordon",
                                          "coupled-pendula",
                                          "coupled-sine-gordon",
                                          "discrete-breather",
                                          "fast-kink",
                                          "fermi-pasta-ulam",
                                          "gauss-kink",
                                          "guiding-centre",
                                          "harmonic-map",
                                          "henon-heiles",
                                          "henon-heiles-text",
                                          "impurity",
                                          "interval",
                                          "kdv",
                                          "kepler",
                                          "kink",
                                          "kink-train",
                                          "liouville",
                                          "lotka-volterra",
                                          "modulational-instability",
                                          "nls",
                                          "nonlinear-string",
                                          "peierls-barrier",
                                          "peierls-nabarro",
                                          "pendulum",
                                          "phi4-collision",
                                          "phi4-kink",
                                          "phi4-moving-mesh",
                                          "phi6-kink",
                                          "phi6-moving-mesh",
                                          "r-adaptive",
                                          "refined-kink",
                                          "sine-gordon-text",
                                          "sinh-gordon",
                                          "solar-system",
                                          "soliton-bounce",
                                          "soliton-gas",
                                          "spacetime-element",
                                          "sphere",
                                          "spherical-pendulum",
                                          "static-kink",
                                          "toda-chain",
                                          "turning-soliton",
                                          "two-soliton-bounce",
                                          "wall-reflection",
                                          "wave-map",
                                          "wave-map-text",
                                          "wave-packet",
                                          "workprecision-breather",
                                          "workprecision-collision",
                                          "workprecision-moving",
                                          "workprecision-packet",
                                          "workprecision-phi4"});
}

TEST_CASE("every command that a scene names runs, and warns of nothing") {
  const Folder folder;
  for (const auto& scene : delf::shipped_scenes())
    for (const std::string& command : commands_of(scene.file)) {
      const Ran ran = delf_program(folder, shortened(command, is_still(scene.file)));
      INFO(command << "\n" << ran.err);
      CHECK(ran.code == 0);
      CHECK(complaints(ran) == "");
    }
}

TEST_CASE("every shipped scene runs to its end") {
  const Folder folder;
  for (const auto& scene : delf::shipped_scenes()) {
    const std::string steps = sanitized && !is_still(scene.file) ? " --run.steps=100" : "";
    const Ran ran = delf_program(folder, "run " + scene.name + steps + " --output.figures=off --out " + scene.name);
    INFO(scene.name << "\n" << ran.err);
    CHECK(ran.code == 0);
    CHECK(contains(read(folder / (scene.name + "/summary.json")), "\"status\": \"done\""));
  }
}

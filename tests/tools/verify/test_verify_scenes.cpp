// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/scene/shipped_scenes.hpp"

using namespace delf;
using namespace delf::testing;

TEST_CASE("every shipped scene passes verification, and fails with a planted fault", "[slow]") {
  int regions = 0;
  for (const ShippedScene& scene : shipped_scenes()) {
    const Folder folder;
    // long runs have no other kinds of stencil than short ones
    const std::string text = read(scene.file);
    const bool timeless = contains(text, "time = none") || contains(text, "mesh = refined:");
    const std::string steps = timeless ? "" : " --run.steps=100";
    const std::string verify = "verify " + scene.name + steps + " --output.figures=off --out out";
    const Ran ran = delf_program(folder, verify);
    CAPTURE(scene.name, ran.out, ran.err);
    if (contains(ran.out, "the scheme has no Lagrangian")) {
      CHECK(ran.code == 1);
      continue;
    }
    CHECK(ran.code == 0);
    const auto json = nlohmann::json::parse(read(folder / "out/verify.json"));
    CHECK(json["passed"] == true);
    CHECK(json["checks"].size() >= 7);
    for (const auto& check : json["checks"])
      if (std::string(check["name"]).starts_with("form formula")) {
        CHECK(check["value"] <= 1e-13);
        ++regions;
      }
    CHECK(delf_program(folder, verify + " --verify.fault=sign").code == 1);
  }
  CHECK(regions > 50);
}

TEST_CASE("a gauge on the jumps alone, which keeps the form, is found by the check of fluxes") {
  const Folder folder;
  const Ran ran =
      delf_program(folder, "verify lotka-volterra --scheme.nu=0.01 --run.steps=30 --output.figures=off --out out");
  CAPTURE(ran.out, ran.err);
  CHECK(ran.code == 1);
  const auto json = nlohmann::json::parse(read(folder / "out/verify.json"));
  for (const auto& check : json["checks"]) CHECK((check["passed"] == false) == (check["name"] == "flux consistency"));
}

// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <vector>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/files/fields_reader.hpp"

using namespace delf::testing;

namespace {

nlohmann::json summary(const Folder& folder, const std::string& arguments, const std::string& out = "out") {
  const Ran ran = delf_program(folder, "run " + arguments + " --output.figures=off --out " + out);
  INFO(arguments << "\n" << ran.err);
  REQUIRE(ran.code == 0);
  return nlohmann::json::parse(read(folder / (out + "/summary.json")));
}
double error(const Folder& folder, const std::string& arguments) {
  return summary(folder, arguments)["error_linf"].get<double>();
}

/// Frames of a run on a point, and the time between them.
std::vector<std::vector<double>> frames(const Folder& folder, const std::string& out = "out") {
  const delf::FieldsReader fields(folder / (out + "/fields.h5"));
  std::vector<std::vector<double>> all;
  for (int n = 0; n < static_cast<int>(fields.frames()); ++n) all.push_back(fields.row(n));
  return all;
}

/// Toda's third integral Σ p³/3 + p_i (e^{q_{i−1} − q_i} + e^{q_i − q_{i+1}}), in the middle of two rows.
double third_integral(const std::vector<double>& before, const std::vector<double>& after, double h) {
  const std::size_t n = before.size();
  const auto q = [&](std::size_t i) { return (before[i % n] + after[i % n]) / 2; };
  const auto p = [&](std::size_t i) { return (after[i % n] - before[i % n]) / h; };
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i)
    sum += p(i) * p(i) * p(i) / 3 + p(i) * (std::exp(q(i + n - 1) - q(i)) + std::exp(q(i) - q(i + 1)));
  return sum;
}

}  // namespace

TEST_CASE("Liouville, Born-Infeld and the wave map as text converge to their solutions to second order") {
  const Folder folder;
  for (const char* scene : {"liouville --run.until=2", "born-infeld --run.until=1", "wave-map-text --run.until=0.5"}) {
    const std::string command(scene);
    const double coarse = error(folder, command + " --lattice.sites=64"),
                 fine = error(folder, command + " --lattice.sites=128");
    INFO(scene << ": " << coarse << ", " << fine);
    CHECK(coarse / fine > 3.4);
    CHECK(coarse / fine < 4.6);
  }
}

TEST_CASE("the wave map as text keeps its sphere and its rotations, and is verified") {
  const Folder folder;
  const auto json = summary(folder, "wave-map-text --run.steps=60");
  CHECK(json["constraint_max"].get<double>() < 1e-13);
  REQUIRE(json["conserved"].size() == 3);
  for (const auto& conserved : json["conserved"]) CHECK(conserved["error_max"].get<double>() < 1e-13);
  const Ran ran = delf_program(
      folder, "verify wave-map-text --run.steps=30 --verify.checks=noether,equations,forms --lattice.sites=24");
  INFO(ran.out << ran.err);
  CHECK(ran.code == 0);
  // staggered waves off the sphere, as for the built-in one
  const Ran refused = delf_program(folder, "run wave-map-text --lattice.stencil=rectangle-symmetric");
  CHECK(refused.code == 2);
  CHECK(contains(refused.err, "lattice.stencil"));
}

TEST_CASE("a chain of Toda keeps its momentum to round-off, and its third integral to second order") {
  const Folder folder;
  const auto drift = [&](double h) {
    const auto json = summary(folder, "toda-chain --run.until=5 --lattice.time_step=" + std::to_string(h));
    CHECK(json["conserved"][0]["error_max"].get<double>() < 1e-12);
    const auto rows = frames(folder);
    const double first = third_integral(rows[0], rows[1], h);
    double worst = 0;
    for (std::size_t n = 1; n + 1 < rows.size(); ++n)
      worst = std::max(worst, std::abs(third_integral(rows[n], rows[n + 1], h) - first));
    return worst;
  };
  const double coarse = drift(0.1), fine = drift(0.05);
  INFO(coarse << ", " << fine);
  CHECK(coarse / fine > 3.4);
  CHECK(coarse / fine < 4.6);
}

TEST_CASE("coupled pendula exchange their energy, keep the total, and swing as one where they begin as one") {
  const Folder folder;
  CHECK(summary(folder, "coupled-pendula --output.every=1")["energy_error_max"].get<double>() < 2e-4);
  double first = 0, second = 0;
  for (const auto& row : frames(folder))
    first = std::max(first, std::abs(row[0])), second = std::max(second, std::abs(row[1]));
  CHECK(first > 0.95);
  CHECK(second > 0.5);  // it began at rest at 0
  summary(folder, "coupled-pendula --initial.v=angle --output.every=1");
  for (const auto& row : frames(folder)) CHECK(std::abs(row[0] - row[1]) < 1e-11);
}

TEST_CASE("a nonlinear string keeps its momentum to round-off, and its energy to second order") {
  const Folder folder;
  const auto energy_error = [&](const std::string& sites) {
    const auto json = summary(folder, "nonlinear-string --run.until=1.5 --lattice.sites=" + sites);
    REQUIRE(json["conserved"].size() == 1);
    CHECK(json["conserved"][0]["error_max"].get<double>() < 1e-13);
    return json["energy_error_max"].get<double>();
  };
  const double coarse = energy_error("41"), fine = energy_error("81");
  INFO(coarse << ", " << fine);
  CHECK(coarse / fine > 3.2);
  CHECK(coarse / fine < 4.8);
}

TEST_CASE("Henon and Heiles's motion as text is the built-in one") {
  const Folder folder;
  summary(folder, "henon-heiles-text --run.until=20", "text");
  summary(folder,
          "henon-heiles --scheme.method=multisymplectic --lattice.stencil=midpoint --lattice.time_step=0.05 "
          "--run.until=20 --initial.start=centred",
          "built-in");
  const auto text = frames(folder, "text"), built_in = frames(folder, "built-in");
  REQUIRE(text.size() == built_in.size());
  for (std::size_t n = 0; n < text.size(); ++n)
    for (std::size_t a = 0; a < 2; ++a) CHECK(std::abs(text[n][a] - built_in[n][a]) < 1e-11);
}

TEST_CASE("friction is a density that depends on t") {
  // e^{gt}(½φ_t² − ½φ²): φ_tt + g φ_t + φ = 0
  const Folder folder;
  folder.write("damped.ini",
               "[theory]\ndensity = exp(g*t)*(0.5*phi_t^2 - 0.5*phi^2)\nparameters = g = 0.2\n"
               "[lattice]\nspace = point\nstencil = midpoint\ntime_step = 0.02\n"
               "[exact]\nphi = let w = sqrt(1 - g^2/4); exp(-g*t/2)*(cos(w*t) + g/2/w*sin(w*t))\n"
               "[run]\nuntil = 10\n[output]\nfigures = off\n");
  const double coarse = error(folder, "damped.ini"), fine = error(folder, "damped.ini --lattice.time_step=0.01");
  INFO(coarse << ", " << fine);
  CHECK(coarse / fine > 3.8);
  CHECK(coarse / fine < 4.2);
}

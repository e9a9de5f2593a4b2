// SPDX-License-Identifier: MIT
#include "tools/stability/mesh_stability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/mesh_frequency.hpp"
#include "schemes/stepping/evolution.hpp"
#include "tools/files/text_file.hpp"
#include "tools/outcome/findings_json.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/progress.hpp"
#include "tools/report/text_columns.hpp"
#include "tools/scene/mesh_methods.hpp"
#include "tools/stability/point_limits.hpp"

namespace delf {
namespace {

constexpr int run_steps = 300;
constexpr double noise = 1e-9, grown = 1e-4;

struct MeshFinding {
  PointFinding oscillator;
  double limit = 0;  ///< h
  bool agrees = true;
};

bool is_of_theory(const std::string& key) { return key.starts_with("theory."); }

/// Noise of the linear theory stays as small as it is. With steps that double it is at `grown` after some 20.
bool stays(const ComplexScene& c, const NamedScheme& scheme, double h) {
  Problem problem = c.problem_on_mesh();
  problem.method = scheme.problem.method, problem.time_step = h;
  problem.parameters = {};
  for (const auto& [key, value] : c.scene.problem.parameters)
    if (is_of_theory(key)) problem.parameters[key] = value;
  for (const auto& [key, value] : scheme.problem.parameters)
    if (!is_of_theory(key)) problem.parameters[key] = value;
  // a boundary that is driven is no small wave
  if (c.boundary_works())
    problem.lattice = Lattice::on(std::make_shared<MeshSpace>(MeshSpace{c.space->mesh, c.space->fixed}));
  Simulation simulation(problem);
  std::mt19937_64 random(c.scene.initial.seed);
  std::normal_distribution<double> normal;
  std::vector<double> row, rates(simulation.components().size() * at(c.sites()), 0.0);
  for (int i = 0; i < c.sites(); ++i) {
    std::vector<double> fields(c.fields.size());
    for (double& phi : fields) phi = c.space->fixed[i] ? 0 : noise * normal(random);
    for (const Component& component : simulation.components())
      row.push_back(component.role == Role::multiplier ? 0 : fields[component.field]);
  }
  std::vector<double> fields(c.space->fields_of_row());
  try {
    simulation.start_legendre(row, rates);
    for (int n = 1; n < run_steps && !Interrupt::asked(); ++n) {
      simulation.step();
      simulation.copy_row(0, fields);
      for (const double phi : fields)
        if (!(std::abs(phi) < grown)) return false;
    }
    return true;
  } catch (const NumericalFailure&) {
    return false;
  }
}

/// The variants of all methods that step a mesh, the scene's own first, on one oscillator.
std::vector<NamedScheme> schemes_of(const ComplexScene& c) {
  Problem point = c.problem_on_mesh();
  point.lattice = Lattice::point();
  std::vector<NamedScheme> schemes;
  if (c.has_method()) schemes.push_back({scheme_label(point), point});
  point.parameters = {};
  for (const NamedScheme& scheme : named_schemes(point))
    if (is_named_on_meshes(find_method(scheme.problem.method))) schemes.push_back(scheme);
  return schemes;
}

std::string in_words(double limit) { return std::isinf(limit) ? "none" : fmt::format("{:.6g}", limit); }

}  // namespace

ExitCode stability(const ComplexScene& c, const std::filesystem::path& folder) {
  const Interrupt interrupt;
  if (c.time != MeshTime::rows)
    throw c.scene.settings.error("lattice.time", "limits are those of rows; leave it out for delf stability");
  if (c.theory->constraint())
    throw c.scene.settings.error("theory.name",
                                 "limits on a mesh are of theories without a constraint; choose another");
  const PointRequest request = point_request(c.scene);
  Problem usual = c.problem_on_mesh();
  usual.method = Problem().method;
  const auto longest = longest_step(Simulation(usual).evolution().system());
  if (!longest)
    throw c.scene.settings.error("theory.name",
                                 "nothing oscillates about phi = 0; choose a theory whose vacuum is there");
  const double omega = 2 / *longest;
  const std::vector<NamedScheme> schemes = schemes_of(c);
  Progress progress(static_cast<std::int64_t>(schemes.size()));
  std::vector<MeshFinding> findings;
  for (const NamedScheme& scheme : schemes) {
    if (Interrupt::asked()) break;
    MeshFinding f{find_point_limit(scheme, request)};
    if (!f.oscillator.left_out.empty()) continue;
    f.limit = f.oscillator.theory / omega;
    f.agrees = f.oscillator.agrees;
    // Implicit elements stay at any step: a run beyond all waves' resolution shows it.
    const double in = std::isinf(f.limit) ? 4 / omega : f.limit * (1 - 2 * request.agreement);
    if (f.limit > 0) f.agrees = f.agrees && stays(c, scheme, in);
    if (f.limit > 0 && std::isfinite(f.limit) && !f.oscillator.too_narrow && f.oscillator.stable.size() < 2)
      f.agrees = f.agrees && !stays(c, scheme, f.limit * (1 + 2 * request.agreement));
    if (Interrupt::asked()) break;  // it is half done
    findings.push_back(std::move(f));
    progress.at(static_cast<std::int64_t>(findings.size()));
  }
  std::vector<std::vector<std::string>> rows;
  for (const MeshFinding& f : findings)
    rows.push_back({f.oscillator.scheme, fmt::format("{:.2f}", f.oscillator.order), in_words(f.oscillator.theory),
                    in_words(f.limit), f.agrees ? "" : "FAILED"});
  Json json = json_head(c.scene);
  json["largest_frequency"] = omega;
  json["agreement"] = request.agreement;
  json["limits"] = json_list(findings, [](const MeshFinding& f) {
    return Json{{"scheme", f.oscillator.scheme},    {"frequency_step", f.oscillator.theory}, {"time_step", f.limit},
                {"unlimited", std::isinf(f.limit)}, {"order", f.oscillator.order},           {"agrees", f.agrees}};
  });
  make_results_folder(folder);
  write_text_file(folder / "stability.json", json_text(json));
  fmt::print("{}: {}; the largest frequency about phi = 0 is {:.6g}\n\n{}", c.scene.name, c.mesh_in_words(), omega,
             text_table({{"scheme"}, {"order", true}, {"wh", true}, {"longest h", true}, {"remarks"}}, rows, 120));
  if (Interrupt::asked()) {
    fmt::print("\nnot finished (interrupted)\n{}: stability.json\n", folder.string());
    return ExitCode::interrupted;
  }
  const auto failed = std::ranges::count(findings, false, &MeshFinding::agrees);
  fmt::print("\n{} of {} limits agree\n{}: stability.json\n", findings.size() - at(failed), findings.size(),
             folder.string());
  return failed == 0 ? ExitCode::done : ExitCode::check_failed;
}

}  // namespace delf

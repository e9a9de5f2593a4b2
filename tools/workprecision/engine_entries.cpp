// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "lattice/error.hpp"
#include "schemes/simulation.hpp"
#include "schemes/stability/linear_stability.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/stepping/flush_denormals.hpp"
#include "schemes/stepping/force_evaluations.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/compare/placed_row.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"
#include "tools/workprecision/entry.hpp"

namespace delf {

namespace {

// A scheme of the engine with the scene that it runs.
class EngineEntry final : public StartedEntry {
 public:
  explicit EngineEntry(Scene scene)
      : scene_(std::move(scene)),
        initial_(scene_),
        simulation_(build()),
        at_once_(std::clamp<std::int64_t>(20000 / scene_.problem.lattice.sites(), 1, most_at_once)) {
    initial_.start(simulation_);
  }
  std::int64_t newest() const override { return simulation_.newest(); }
  void advance(std::int64_t steps, const RunLimit& limit) override {
    // steps between two looks at the limit take some 0.1 s at most
    constexpr double soon = 0.02, late = 0.1;
    const FlushDenormals for_all_steps;
    while (steps > 1) {
      if (limit.reached()) return;
      const auto count = std::min(steps - 1, at_once_);
      const auto from = RunLimit::Clock::now();
      simulation_.steps(static_cast<int>(count));
      const double seconds = seconds_since(from);
      if (seconds > late) at_once_ = std::max<std::int64_t>(1, count / 2);
      else if (seconds < soon && count == at_once_) at_once_ = std::min(2 * at_once_, most_at_once);
      steps -= count;
    }
    if (steps > 0 && !limit.reached()) simulation_.step(true);
  }
  void copy(std::span<double> out) const override {
    if (simulation_.evolution().system().moves()) std::ranges::copy(placed_row(simulation_).fields, out.begin());
    else simulation_.observe(0, out);
  }
  std::vector<double> positions() const override {
    return simulation_.evolution().system().moves() ? placed_row(simulation_).positions : std::vector<double>();
  }
  double energy() const override { return simulation_.monitors().energy; }
  // those of a pass; an explicit step is one, an implicit one as many as it has iterations
  double forces() const override {
    return forces_in_a_pass(simulation_.evolution().system()) * std::max(1, simulation_.iterations());
  }

 private:
  Simulation build() {
    Problem problem = scene_.problem;
    problem.winding = initial_.winding();
    initial_.keep_slopes(problem);
    Simulation simulation(problem);
    refuse_unstable(simulation);
    return simulation;
  }

  // A kernel is free of error about its own rows only: beyond its limit a short run may still look accurate.
  void refuse_unstable(const Simulation& simulation) const {
    if (!simulation.is_processed()) return;
    const auto vacuum = find_theory(scene_.problem.theory).vacuum;
    if (!vacuum || simulation.theory().density().is_placed()) return;
    constexpr int wave_numbers = 65;
    const StabilityVerdict verdict = linear_stability(Symbol(simulation.evolution().system(), *vacuum), wave_numbers);
    if (!verdict.stable)
      throw BadInput("lattice.courant", fmt::format("h/k = {:.4g}: beyond the linear limit of the scheme",
                                                    scene_.problem.time_step / scene_.problem.lattice.space_step()));
  }

  static constexpr std::int64_t most_at_once = 64;
  Scene scene_;
  InitialRows initial_;
  Simulation simulation_;
  std::int64_t at_once_;
};

// The scene as this scheme runs it. Without a known solution rows 0 and 1 come from φ and φ_t, as those of all others.
Scene scene_of(const Scene& scene, const Problem& problem, const Resolution& r) {
  Scene other = scene;
  other.problem = problem;
  other.problem.lattice = lattice_of(scene, r.sites);
  other.problem.time_step = r.time_step;
  other.steps = r.steps;
  other.start.reset();
  if (find_method(problem.method).start || scene.from_file()) return other;
  if (scene.start == StartRule::centred) other.start = scene.start;
  else if (const InitialRows rows(other); !rows.exact() && rows.rule() != StartRule::values)
    other.start = StartRule::centred;
  return other;
}

// Two problems that differ in theory and lattice at most state one scheme.
bool same_scheme(const Problem& a, const Problem& b) {
  return a.method == b.method && scheme_label(a) == scheme_label(b) &&
         std::ranges::equal(completed(a).parameters, completed(b).parameters);
}

}  // namespace

std::vector<WorkPrecisionEntry> engine_entries(const Scene& scene) {
  std::vector<NamedScheme> schemes = named_schemes(scene.problem);
  auto own = std::ranges::find_if(schemes, [&](const NamedScheme& s) { return same_scheme(s.problem, scene.problem); });
  if (own == schemes.end()) {
    std::string name = scheme_label(scene.problem);
    if (std::ranges::find(schemes, name, &NamedScheme::name) != schemes.end()) name += " of the scene";
    own = schemes.insert(schemes.begin(), {name, scene.problem});
  }
  const std::string own_name = own->name;
  std::vector<WorkPrecisionEntry> all;
  for (NamedScheme& scheme : schemes)
    all.push_back({scheme.name, false, false, scheme.tuned, scheme.nodes, scheme.rank, scheme.name == own_name,
                   [&scene, problem = std::move(scheme.problem)](const Resolution& r) -> std::unique_ptr<StartedEntry> {
                     return std::make_unique<EngineEntry>(scene_of(scene, problem, r));
                   }});
  return all;
}

}  // namespace delf

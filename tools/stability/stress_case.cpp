// SPDX-License-Identifier: MIT
#include "tools/stability/stress_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "lattice/index.hpp"
#include "schemes/declared.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/report/seconds_since.hpp"
#include "tools/rows/engine.hpp"
#include "tools/rows/initial_rows.hpp"

namespace delf {

namespace {

// A step that is solved to scheme.tolerance leaves some 1e-15; one that was not solved leaves much more.
constexpr double solved = 1e-9;
// A field that has grown so much will overflow if it is let: it is not bounded.
constexpr double blown_up = 1e6;

Scene scene_of(const StressCase& stress_case) {
  Scene scene(Settings(stress_case.name, {}, keys_of(stress_case)));
  scene.name = stress_case.name;
  scene.problem = stress_case.problem;
  scene.initial = stress_case.state;
  scene.steps = stress_case.steps;
  return scene;
}

struct Extent {
  double largest = 0;
  double difference = 0;  ///< the largest between neighbours
  bool finite = true;
};

Extent extent_of(const std::vector<double>& row, std::size_t components) {
  Extent e;
  for (std::size_t i = 0; i < row.size(); ++i) {
    e.finite = e.finite && std::isfinite(row[i]);
    e.largest = std::max(e.largest, std::abs(row[i]));
    if (i >= components) e.difference = std::max(e.difference, std::abs(row[i] - row[i - components]));
  }
  return e;
}

// The residual that is allowed: differences of rounded values are good to ε|φ|/|Δφ|, and numbers below 1e-308 are 0.
double solved_to(const Extent& e) {
  return solved + 64 * std::numeric_limits<double>::epsilon() * e.largest / e.difference +
         1e3 * std::numeric_limits<double>::min() / e.difference;
}

// Steps, and looks at some fifty rows on the way.
class Watched {
 public:
  Watched(const StressCase& stress_case, const Scene& scene, const InitialRows& initial, Simulation& simulation,
          StressResult& result)
      : case_(stress_case),
        scene_(scene),
        initial_(initial),
        simulation_(simulation),
        result_(result),
        fields_(at(simulation.count(Role::field))) {
    row_.resize(at(scene.problem.lattice.sites()) * fields_);
  }

  void start() {
    initial_.start(simulation_);
    energy_ = simulation_.monitors().energy;
    look();
    first_ = std::max(extent_of(row_, fields_).largest, std::numeric_limits<double>::min());
  }

  void run(double budget, const std::function<void(const StressResult&)>& report) {
    const auto begin = std::chrono::steady_clock::now();
    const std::int64_t every = std::max<std::int64_t>(1, case_.steps / 50);
    std::int64_t look_at_clock = 1;
    while (simulation_.newest() < case_.steps && result_.verdict < StressVerdict::diverged) {
      const std::int64_t next = simulation_.newest() + 1;
      const bool cut = next >= look_at_clock && seconds_since(begin) > budget * case_.patience;
      const bool looked_at = cut || next % every == 0 || next == case_.steps;
      simulation_.step(looked_at);
      result_.steps = next;
      if (next >= look_at_clock) look_at_clock = next + clock_stride(seconds_since(begin), next);
      if (looked_at) {
        look();
        result_.seconds = seconds_since(begin);
        if (report) report(result_);
      }
      if (cut && next < case_.steps) {
        result_.cut_at = static_cast<double>(next) * case_.problem.time_step;
        return;
      }
    }
  }

 private:
  // some hundred looks a second
  static std::int64_t clock_stride(double elapsed, std::int64_t steps) {
    return std::clamp<std::int64_t>(static_cast<std::int64_t>(0.01 * static_cast<double>(steps) / (elapsed + 1e-9)), 1,
                                    100000);
  }

  void look() {
    simulation_.observe(0, row_);
    const Extent extent = extent_of(row_, fields_);
    const double t = static_cast<double>(simulation_.newest()) * case_.problem.time_step;
    if (!extent.finite) return judge(StressVerdict::silent, fmt::format("t = {:.6g}: the row is not finite", t));
    if (simulation_.newest() >= simulation_.starting_rows()) {
      const double residual = simulation_.residual();
      if (!(residual <= result_.residual_max)) result_.residual_max = residual;
      if (!(residual <= solved_to(extent)))
        return judge(
            StressVerdict::unsolved,
            fmt::format("t = {:.6g}: the residual of the equations is {:.3g}, and nothing was said", t, residual));
    }
    const double energy = simulation_.monitors().energy, error = std::abs((energy - energy_) / energy_);
    if (std::isfinite(error)) {  // relative to an energy of zero, or of squares that underflow, there is none
      if (!(error <= result_.energy_error_max)) result_.energy_error_max = error;
      if (error > case_.energy_bound)
        judge(StressVerdict::wrong, fmt::format("the energy is off by {:.3g} of itself at t = {:.6g}", error, t));
    }
    if (extent.largest > blown_up * first_) {
      if (!(result_.diverged_at <= t)) result_.diverged_at = t;
      return judge(StressVerdict::diverged, fmt::format("|phi| is {:.3g} at t = {:.6g}", extent.largest, t));
    }
    if (extent.largest > case_.growth_bound * first_)
      judge(StressVerdict::wrong, fmt::format("|phi| has grown {:.3g}-fold at t = {:.6g}", extent.largest / first_, t));
    compare(t);
  }

  void compare(double t) {
    const State* exact = initial_.exact();
    if (!exact || t > exact->exact_until()) return;
    std::vector<double> solution(row_.size());
    exact->values(t, scene_.problem.lattice, solution);
    double error = 0;
    for (std::size_t i = 0; i < row_.size(); ++i) error = std::max(error, std::abs(row_[i] - solution[i]));
    result_.error_linf = error;
    scale_ = std::max(scale_, extent_of(solution, fields_).largest);  // a breather passes through zero
    if (error > case_.error_bound * scale_)
      judge(StressVerdict::wrong, fmt::format("the error is {:.3g} at t = {:.6g}", error, t));
  }

  // The first that is wrong is reported; what must not be is worse than wrong.
  void judge(StressVerdict verdict, const std::string& reason) {
    if (verdict <= result_.verdict) return;
    result_.verdict = verdict;
    result_.reason = reason;
  }

  const StressCase& case_;
  const Scene& scene_;
  const InitialRows& initial_;
  Simulation& simulation_;
  StressResult& result_;
  std::size_t fields_;
  std::vector<double> row_;
  double energy_ = 0, first_ = std::numeric_limits<double>::infinity();
  double scale_ = std::numeric_limits<double>::min();  ///< the largest |φ| of the solution so far
};

void end(StressResult& result, StressVerdict verdict, const std::string& reason) {
  if (must_not_be(result.verdict)) return;
  result.verdict = verdict;
  result.reason = reason;
}

}  // namespace

const char* to_string(StressVerdict verdict) {
  switch (verdict) {
    case StressVerdict::stable:
      return "stable";
    case StressVerdict::unstarted:
      return "not started";
    case StressVerdict::wrong:
      return "bounded but wrong";
    case StressVerdict::diverged:
      return "diverged";
    case StressVerdict::refused:
      return "refused";
    case StressVerdict::unsolved:
      return "unsolved";
    case StressVerdict::silent:
      return "not finite, silently";
    case StressVerdict::failed:
      return "failed";
    case StressVerdict::crashed:
      return "crashed";
    case StressVerdict::hung:
      return "hung";
  }
  return "";
}

std::vector<Setting> keys_of(const StressCase& stress_case) {
  Problem p = completed(stress_case.problem);
  std::vector<Setting> keys;
  const auto add = [&](const std::string& key, const std::string& value) { keys.push_back({key, value, 0}); };
  const auto number = [](double x) { return fmt::format("{}", x); };
  add("theory.name", p.theory);
  if (p.circle_valued) add("theory.fibre", "S1");
  const MethodEntry& method = find_method(p.method);
  const auto add_all = [&](const std::vector<Parameter>& declared) {
    for (const Parameter& parameter : declared)
      if (p.parameters.has(parameter.key)) add(parameter.key, to_text(p.parameters[parameter.key]));
  };
  add_all(parameters_of(find_theory(p.theory), p.parameters));
  if (method.reads_stencil) add("lattice.stencil", p.stencil);
  if (p.method != Problem{}.method) add("scheme.method", p.method);
  add_all(method.parameters);
  if (p.lattice.space() == Space::interval) add("lattice.space", "interval");
  add("lattice.length", number(p.lattice.length()));
  add("lattice.sites", fmt::format("{}", p.lattice.sites()));
  add("lattice.time_step", number(p.time_step));
  add("initial.state", stress_case.state.name);
  ParameterValues given = stress_case.state.values;
  for (const Parameter& parameter : find_state(stress_case.state.name).parameters)
    if (given.has(parameter.key)) add(parameter.key, to_text(given[parameter.key]));
  add("run.steps", fmt::format("{}", stress_case.steps));
  return keys;
}

StressResult run_stress_case(const StressCase& stress_case, double budget,
                             const std::function<void(const StressResult&)>& report) {
  StressResult result;
  const auto begin = std::chrono::steady_clock::now();
  const auto now = [&] { return static_cast<double>(result.steps + 1) * stress_case.problem.time_step; };
  try {
    const Scene scene = scene_of(stress_case);
    const InitialRows initial(scene);
    Simulation simulation = build(scene, initial.winding());
    Watched watched(stress_case, scene, initial, simulation, result);
    watched.start();
    if (report) report(result);
    watched.run(budget, report);
  } catch (const BadInput& error) {
    end(result, StressVerdict::refused, error.what());
  } catch (const NoConvergence& error) {
    end(result, StressVerdict::refused, error.what());
  } catch (const NumericalFailure& error) {  // not finite, or a mesh that would cross itself
    result.diverged_at = now();
    end(result, StressVerdict::diverged, error.what());
  } catch (const std::exception& error) {
    end(result, StressVerdict::failed, error.what());
  }
  result.seconds = seconds_since(begin);
  return result;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/stability/corner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

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

Scene scene_of(const Corner& corner) {
  Scene scene(Settings(corner.name, {}, keys_of(corner)));
  scene.name = corner.name;
  scene.problem = corner.problem;
  scene.initial = corner.state;
  scene.steps = corner.steps;
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
  Watched(const Corner& corner, const Scene& scene, const InitialRows& initial, Simulation& simulation,
          CornerResult& result)
      : corner_(corner),
        scene_(scene),
        initial_(initial),
        simulation_(simulation),
        result_(result),
        fields_(static_cast<std::size_t>(simulation.count(Role::field))) {
    row_.resize(static_cast<std::size_t>(scene.problem.lattice.sites()) * fields_);
  }

  void start() {
    initial_.start(simulation_);
    energy_ = simulation_.monitors().energy;
    look();
    first_ = std::max(extent_of(row_, fields_).largest, std::numeric_limits<double>::min());
  }

  void run(double budget, const std::function<void(const CornerResult&)>& report) {
    const auto begin = std::chrono::steady_clock::now();
    const std::int64_t every = std::max<std::int64_t>(1, corner_.steps / 50);
    std::int64_t look_at_clock = 1;
    while (simulation_.newest() < corner_.steps && result_.verdict < CornerVerdict::diverged) {
      const std::int64_t next = simulation_.newest() + 1;
      const bool cut = next >= look_at_clock && seconds_since(begin) > budget * corner_.patience;
      const bool looked_at = cut || next % every == 0 || next == corner_.steps;
      simulation_.step(looked_at);
      result_.steps = next;
      if (next >= look_at_clock) look_at_clock = next + clock_stride(seconds_since(begin), next);
      if (looked_at) {
        look();
        result_.seconds = seconds_since(begin);
        if (report) report(result_);
      }
      if (cut && next < corner_.steps) {
        result_.cut_at = static_cast<double>(next) * corner_.problem.time_step;
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
    const double t = static_cast<double>(simulation_.newest()) * corner_.problem.time_step;
    if (!extent.finite) return judge(CornerVerdict::silent, fmt::format("t = {:.6g}: the row is not finite", t));
    if (simulation_.newest() >= simulation_.starting_rows()) {
      const double residual = simulation_.residual();
      if (!(residual <= result_.residual_max)) result_.residual_max = residual;
      if (!(residual <= solved_to(extent)))
        return judge(
            CornerVerdict::unsolved,
            fmt::format("t = {:.6g}: the residual of the equations is {:.3g}, and nothing was said", t, residual));
    }
    const double energy = simulation_.monitors().energy, error = std::abs((energy - energy_) / energy_);
    if (std::isfinite(error)) {  // relative to an energy of zero, or of squares that underflow, there is none
      if (!(error <= result_.energy_error_max)) result_.energy_error_max = error;
      if (error > corner_.energy_bound)
        judge(CornerVerdict::wrong, fmt::format("the energy is off by {:.3g} of itself at t = {:.6g}", error, t));
    }
    if (extent.largest > blown_up * first_) {
      if (!(result_.diverged_at <= t)) result_.diverged_at = t;
      return judge(CornerVerdict::diverged, fmt::format("|phi| is {:.3g} at t = {:.6g}", extent.largest, t));
    }
    if (extent.largest > corner_.growth_bound * first_)
      judge(CornerVerdict::wrong, fmt::format("|phi| has grown {:.3g}-fold at t = {:.6g}", extent.largest / first_, t));
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
    if (error > corner_.error_bound * scale_)
      judge(CornerVerdict::wrong, fmt::format("the error is {:.3g} at t = {:.6g}", error, t));
  }

  // The first that is wrong is told; what must not be is worse than wrong.
  void judge(CornerVerdict verdict, const std::string& reason) {
    if (verdict <= result_.verdict) return;
    result_.verdict = verdict;
    result_.reason = reason;
  }

  const Corner& corner_;
  const Scene& scene_;
  const InitialRows& initial_;
  Simulation& simulation_;
  CornerResult& result_;
  std::size_t fields_;
  std::vector<double> row_;
  double energy_ = 0, first_ = std::numeric_limits<double>::infinity();
  double scale_ = std::numeric_limits<double>::min();  ///< the largest |φ| of the solution so far
};

void end(CornerResult& result, CornerVerdict verdict, const std::string& reason) {
  if (must_not_be(result.verdict)) return;
  result.verdict = verdict;
  result.reason = reason;
}

}  // namespace

const char* to_string(CornerVerdict verdict) {
  switch (verdict) {
    case CornerVerdict::stable:
      return "stable";
    case CornerVerdict::unstarted:
      return "not started";
    case CornerVerdict::wrong:
      return "bounded but wrong";
    case CornerVerdict::diverged:
      return "diverged";
    case CornerVerdict::refused:
      return "refused";
    case CornerVerdict::unsolved:
      return "unsolved";
    case CornerVerdict::silent:
      return "not finite, silently";
    case CornerVerdict::failed:
      return "failed";
    case CornerVerdict::crashed:
      return "crashed";
    case CornerVerdict::hung:
      return "hung";
  }
  return "";
}

std::vector<Setting> keys_of(const Corner& corner) {
  Problem p = completed(corner.problem);
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
  add("initial.state", corner.state.name);
  ParameterValues given = corner.state.values;
  for (const Parameter& parameter : find_state(corner.state.name).parameters)
    if (given.has(parameter.key)) add(parameter.key, to_text(given[parameter.key]));
  add("run.steps", fmt::format("{}", corner.steps));
  return keys;
}

CornerResult run_corner(const Corner& corner, double budget, const std::function<void(const CornerResult&)>& report) {
  CornerResult result;
  const auto begin = std::chrono::steady_clock::now();
  const auto now = [&] { return static_cast<double>(result.steps + 1) * corner.problem.time_step; };
  try {
    const Scene scene = scene_of(corner);
    const InitialRows initial(scene);
    Simulation simulation = build(scene, initial.winding());
    Watched watched(corner, scene, initial, simulation, result);
    watched.start();
    if (report) report(result);
    watched.run(budget, report);
  } catch (const BadInput& error) {
    end(result, CornerVerdict::refused, error.what());
  } catch (const NoConvergence& error) {
    end(result, CornerVerdict::refused, error.what());
  } catch (const NumericalFailure& error) {  // not finite, or a mesh that would cross itself
    result.diverged_at = now();
    end(result, CornerVerdict::diverged, error.what());
  } catch (const std::exception& error) {
    end(result, CornerVerdict::failed, error.what());
  }
  result.seconds = seconds_since(begin);
  return result;
}

}  // namespace delf

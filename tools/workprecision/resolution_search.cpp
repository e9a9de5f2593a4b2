// SPDX-License-Identifier: MIT
#include "tools/workprecision/resolution_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "tools/report/interrupt.hpp"
#include "tools/report/seconds_since.hpp"

namespace delf {

namespace {

constexpr double coarsest = 8;         // the scene's N over the first, and the first h over the scene's
constexpr int scenes_own = 6;          // times √2: N and h of the scene
constexpr double own_share = 0.1;      // of the time: of the scene's own scheme, before all others
constexpr double share_of_one = 0.25;  // of the time: the most that one run may take
// The seconds of two runs within this are taken for equal: they have been run once.
constexpr double clearly = 0.7;
constexpr double hopelessly = 0.03;
constexpr double falling = 0.85;
constexpr double unstable = 10;  // times the field
constexpr double unknown = WorkPrecisionRun::unknown;
constexpr double hardly_better = 1.1;  // rounding at the floor is no progress

double refinement(int times) { return std::pow(2.0, 0.5 * times); }

}  // namespace

ResolutionSearch::ResolutionSearch(const Scene& scene, const WorkPrecisionRequest& request,
                                   const std::vector<WorkPrecisionEntry>& entries, const ComparedSolution& solution)
    : scene_(scene),
      request_(request),
      entries_(entries),
      solution_(solution),
      reasons_(entries.size()),
      seen_(entries.size()) {
  const std::vector<double> there = solution.at(scene.problem.lattice, request.until);
  const auto [least, most] = std::ranges::minmax(there);
  field_scale_ = std::max(1e-300, std::max(std::abs(most), std::abs(least)));
}

bool ResolutionSearch::chosen() const { return request_.sites.empty() && request_.courants.empty(); }

bool ResolutionSearch::is_scenes_own(std::size_t c, const Resolution& r) const {
  return entries_[c].own && r.sites == scene_.problem.lattice.sites() && r.steps == scene_steps();
}

std::int64_t ResolutionSearch::scene_steps() const {
  return std::max<std::int64_t>(1, std::llround(request_.until / scene_.problem.time_step));
}

void ResolutionSearch::seed(std::size_t c) {
  const double own = scene_.problem.time_step / scene_.problem.lattice.space_step();
  std::vector<double> courants = request_.courants;
  if (courants.empty()) courants = {request_.sites.empty() ? 0 : own};
  for (const double courant : courants) {
    if (request_.sites.empty()) push({c, 0, 0, courant, 0, 0, 0, unknown});
    for (const int sites : request_.sites) push({c, 0, 0, courant, sites, 0, 0, unknown});
  }
}

Resolution ResolutionSearch::resolution(const Next& next) const {
  const Lattice& lattice = scene_.problem.lattice;
  Resolution r;
  double h = scene_.problem.time_step * coarsest / refinement(next.time);
  if (lattice.space() == Space::point) r.sites = 1;
  else {
    const double coarse = lattice.cells() / coarsest / entries_[next.entry].nodes;
    // an even number of cells: stencils of brick walls close around a circle then
    const auto cells = [&](int times) { return 2 * std::max(2L, std::lround(0.5 * coarse * refinement(times))); };
    const int ends = lattice.is_circle() ? 0 : 1;
    r.sites = next.sites ? next.sites : static_cast<int>(cells(next.space)) + ends;
    if (!next.sites && next.space == scenes_own && entries_[next.entry].own) r.sites = lattice.sites();
    const double k = lattice_of(scene_, r.sites).space_step();
    if (next.courant > 0) h = next.courant * k;
  }
  // until = steps · h, exactly
  r.steps = std::max<std::int64_t>(1, std::llround(request_.until / h));
  r.time_step = request_.until / static_cast<double>(r.steps);
  return r;
}

void ResolutionSearch::push(const Next& next) {
  const Resolution r = resolution(next);
  auto& seen = seen_[next.entry];
  if (const std::pair place{r.sites, r.steps}; std::ranges::find(seen, place) == seen.end()) {
    seen.push_back(place);
    queue_.push_back(next);
    if (next.sites) queue_.back().cost = static_cast<double>(r.sites) * static_cast<double>(r.steps) * 1e-8;
  }
}

void ResolutionSearch::run(Clock::time_point until, const std::function<void()>& at) {
  const Clock::time_point begin = Clock::now();
  const double seconds = seconds_of(until - begin);
  until_ = until;
  most_of_one_ = chosen() ? share_of_one * seconds : std::numeric_limits<double>::infinity();
  if (const auto own = std::ranges::find(entries_, true, &WorkPrecisionEntry::own); chosen() && own != entries_.end())
    run_own(delf::at(own - entries_.begin()), -seconds_since(until) * own_share, at);
  for (std::size_t c = 0; c < entries_.size(); ++c) seed(c);
  run_cheapest(until, at);
  out_of_time_ = out_of_time_ || !queue_.empty();
}

// The scene's own resolution, whatever it takes, and the coarser ones at its h/k: together they cost as much again.
void ResolutionSearch::run_own(std::size_t c, double seconds, const std::function<void()>& at) {
  const Clock::time_point begin = Clock::now();
  Clock::time_point until = begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  const double most = std::exchange(most_of_one_, std::numeric_limits<double>::infinity());
  const Next own{c, scenes_own, scenes_own, 0, 0, 0, 0, unknown};
  push(own);
  queue_.clear();
  attempt(own);
  at();
  most_of_one_ = most;
  // as long again, but not past the search
  until = std::min(until_, std::max(until, Clock::now() + (Clock::now() - begin)));
  const double cost = tried_.empty() ? 0 : tried_.back().result.seconds;
  const double setup = tried_.empty() ? 0 : tried_.back().result.seconds_setup;
  for (int i = 1; i < scenes_own; ++i)
    push({c, i, i, 0, 0, cost / refinement(2 * (scenes_own - i)), setup / refinement(scenes_own - i), unknown});
  run_cheapest(until, at);
}

void ResolutionSearch::run_cheapest(Clock::time_point until, const std::function<void()>& at) {
  while (!queue_.empty() && !Interrupt::asked()) {
    const auto cheapest = std::ranges::min_element(queue_, {}, &Next::cost);
    if (cheapest->cost + cheapest->setup > -seconds_since(until)) break;
    const Next next = *cheapest;
    queue_.erase(cheapest);
    attempt(next);
    at();
  }
}

// Tries a finer resolution after a failure at a coarse one: a smaller step, or more sites up to those of the scene.
void ResolutionSearch::retry(const Next& next, const Resolution& r, double cost) {
  if (next.sites) return;
  cost = std::max(1.5 * next.cost, refinement(1) * cost);
  const bool point = scene_.problem.lattice.space() == Space::point;
  const double least = lattice_of(scene_, r.sites).space_step() / 64;
  if (next.courant == 0 && r.time_step > least)
    push({next.entry, next.space, next.time + 1, 0, 0, cost, next.setup, unknown});
  if (!point && next.space < scenes_own)
    push({next.entry, next.space + 1, next.time + 1, next.courant, 0, cost, next.setup, unknown});
}

void ResolutionSearch::attempt(const Next& next) {
  const Resolution r = resolution(next);
  constexpr std::int64_t fewest_steps = 8;
  if (r.steps < fewest_steps && !next.sites)
    return push({next.entry, next.space + 1, next.time + 1, next.courant, 0, next.cost, next.setup, unknown});
  std::string& reason = reasons_[next.entry];
  const auto failed = [&](const std::string& why) {
    if (reason.empty()) reason = why;
  };
  const StepClock clock(scene_.problem.threads);
  const double begin = clock.now();
  try {
    TriedRun tried =
        run_once(scene_, entries_, next.entry, r, request_.until, solution_, RunLimit(until_, most_of_one_));
    if (Interrupt::asked()) return;  // it is not at its end
    if (!std::isfinite(tried.result.seconds)) {
      out_of_time_ = true;
      return failed(fmt::format("stopped after {:.2g} s at row {} of {}, N = {}: raise workprecision.budget",
                                clock.since(begin), tried.newest, r.steps, r.sites));
    }
    if (!std::isfinite(tried.result.error_linf)) {
      failed("the field is no longer finite");
      return retry(next, r, clock.since(begin));
    }
    tried_.push_back(std::move(tried));
    if (!next.sites) refine(next, tried_.back().result);
  } catch (const BadInput& error) {
    failed(error.what());
    // a stencil may be too wide, or a wave too short, for few sites
    if (!next.sites && r.sites < scene_.problem.lattice.sites())
      push({next.entry, next.space + 1, next.time + 1, next.courant, 0, next.cost, next.setup, unknown});
  } catch (const NumericalFailure& error) {
    failed(error.what());
    retry(next, r, clock.since(begin));  // unstable, or without a solution
  } catch (const std::bad_alloc&) {
    failed(fmt::format("out of memory at N = {}", r.sites));
  } catch (const std::length_error&) {
    failed(fmt::format("out of memory at N = {}", r.sites));
  }
}

// Errors as large as the field itself do not predict the effect of refinement.
bool ResolutionSearch::too_coarse(const Next& next, const WorkPrecisionRun& run) const {
  const Problem& p = scene_.problem;
  const int scene_sites = p.lattice.sites() / entries_[next.entry].nodes;
  return run.error_linf > 0.1 * field_scale_ && run.sites <= 2 * scene_sites &&
         run.time_step >= (p.lattice.space() == Space::point ? p.time_step : run.space_step) / 16;
}

bool ResolutionSearch::beaten(const TriedRun& run, double share) const {
  return std::ranges::any_of(tried_, [&](const TriedRun& other) {
    return other.entry == run.entry && other.result.seconds < share * run.result.seconds &&
           other.result.error_linf <= hardly_better * run.result.error_linf;
  });
}

bool ResolutionSearch::worth(const TriedRun& run) const {
  return !request_.sites.empty() || is_scenes_own(run.entry, run.resolution) ||
         (run.result.error_linf <= field_scale_ && !beaten(run, clearly));
}

void ResolutionSearch::refine(const Next& next, const WorkPrecisionRun& run) {
  if (run.error_linf <= 0.5 * request_.accuracies.back()) return;
  const bool point = scene_.problem.lattice.space() == Space::point, free = next.courant == 0;
  const auto further = [&](int space, int time, double before) {
    push({next.entry, next.space + space, next.time + time, next.courant, 0, run.seconds * refinement(space + time),
          run.seconds_setup * refinement(space), before});
  };
  if (run.error_linf > unstable * field_scale_) return retry(next, tried_.back().resolution, run.seconds);
  const bool single = (too_coarse(next, run) || !beaten(tried_.back(), clearly));
  // Dispersion may cancel at one resolution: those after it fall short of it, but still get better.
  const bool both = single || (run.error_linf < falling * next.before && !beaten(tried_.back(), hopelessly));
  if (point) return both ? further(0, 1, run.error_linf) : void();
  if (free && single) further(0, 1, unknown), further(1, 0, unknown);
  if (both) further(1, 1, run.error_linf);
}

std::vector<TriedRun> ResolutionSearch::worth_timing() const {
  std::vector<TriedRun> worth_timing;
  for (const TriedRun& run : tried_)
    if (worth(run)) worth_timing.push_back(run);
  return worth_timing;
}

std::vector<WorkPrecisionOutcome::LeftOut> ResolutionSearch::left_out() const {
  std::vector<WorkPrecisionOutcome::LeftOut> list;
  for (std::size_t c = 0; c < entries_.size(); ++c) {
    if (std::ranges::any_of(tried_, [&](const TriedRun& run) { return run.entry == c && worth(run); })) continue;
    double least = std::numeric_limits<double>::infinity();
    for (const TriedRun& run : tried_)
      if (run.entry == c) least = std::min(least, run.result.error_linf);
    std::string reason = reasons_[c];
    if (std::isfinite(least))
      reason = fmt::format("no error below the field itself at what was run{}",
                           out_of_time_ ? "; raise workprecision.budget" : "");
    else if (reason.empty())
      reason = Interrupt::asked() ? "interrupted before it was run"
                                  : "the time was used up before it was run; raise workprecision.budget";
    list.push_back({entries_[c].name, reason});
  }
  return list;
}

}  // namespace delf

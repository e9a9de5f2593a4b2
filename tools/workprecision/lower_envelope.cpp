// SPDX-License-Identifier: MIT
#include "tools/workprecision/lower_envelope.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"

namespace delf {

std::vector<std::size_t> lower_envelope(const std::vector<WorkPrecisionRun>& runs, std::span<const std::size_t> among) {
  std::vector<std::size_t> sorted;
  for (const std::size_t i : among)
    if (std::isfinite(runs[i].error_linf) && std::isfinite(runs[i].seconds)) sorted.push_back(i);
  std::ranges::sort(sorted, [&](std::size_t a, std::size_t b) {
    return runs[a].seconds != runs[b].seconds ? runs[a].seconds < runs[b].seconds
                                              : runs[a].error_linf < runs[b].error_linf;
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : sorted)
    if (front.empty() || runs[i].error_linf < runs[front.back()].error_linf) front.push_back(i);
  return front;
}

std::optional<std::size_t> cheapest(const std::vector<WorkPrecisionRun>& runs, std::span<const std::size_t> among,
                                    double accuracy) {
  std::optional<std::size_t> best;
  for (const std::size_t i : among)
    if (runs[i].error_linf <= accuracy && std::isfinite(runs[i].seconds) &&
        (!best || runs[i].seconds < runs[*best].seconds))
      best = i;
  return best;
}

namespace {

/// Least squares slope of log error over log x along runs that become more accurate, without floor and coarse half.
double asymptotic_slope(const std::vector<WorkPrecisionRun>& runs, std::vector<std::size_t> rising, const auto& x_of) {
  while (rising.size() > 2 && runs[rising.back()].error_linf > 0.5 * runs[rising[rising.size() - 2]].error_linf)
    rising.pop_back();
  // the more accurate half, on the logarithmic scale: coarse runs are not asymptotic
  if (rising.size() > 3) {
    const double middle = std::sqrt(runs[rising.front()].error_linf * runs[rising.back()].error_linf);
    std::vector<std::size_t> half;
    for (const std::size_t i : rising)
      if (runs[i].error_linf <= middle) half.push_back(i);
    if (half.size() >= 2) rising = half;
  }
  if (rising.size() < 2) return WorkPrecisionRun::unknown;
  double x = 0, y = 0, xx = 0, xy = 0;
  const auto n = static_cast<double>(rising.size());
  for (const std::size_t i : rising) {
    const double s = std::log(x_of(runs[i])), e = std::log(std::max(runs[i].error_linf, 1e-300));
    x += s, y += e, xx += s * s, xy += s * e;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

}  // namespace

double slope_of(const std::vector<WorkPrecisionRun>& runs, std::span<const std::size_t> front) {
  return asymptotic_slope(runs, {front.begin(), front.end()}, [](const WorkPrecisionRun& r) { return r.seconds; });
}

double order_of(const std::vector<WorkPrecisionRun>& runs, std::span<const std::size_t> members) {
  constexpr double same = 1.02;  // h is rounded so that steps end at the end
  const auto x_of = [](const WorkPrecisionRun& r) { return r.sites > 1 ? r.sites : static_cast<double>(r.steps); };
  const auto ratio = [](const WorkPrecisionRun& r) { return r.sites > 1 ? r.time_step / r.space_step : 1; };
  const auto error = [&](std::size_t i) { return runs[i].error_linf; };
  std::vector<std::size_t> best;
  for (const std::size_t one : members) {
    std::vector<std::size_t> group;
    for (const std::size_t i : members)
      if (std::isfinite(error(i)) && std::abs(std::log(ratio(runs[i]) / ratio(runs[one]))) < std::log(same))
        group.push_back(i);
    std::ranges::sort(group, {}, [&](std::size_t i) { return x_of(runs[i]); });
    const auto repeated = std::ranges::unique(group, {}, [&](std::size_t i) { return x_of(runs[i]); });
    group.erase(repeated.begin(), repeated.end());
    if (group.size() > best.size() ||
        (group.size() == best.size() && !group.empty() && error(group.back()) < error(best.back())))
      best = group;
  }
  return -asymptotic_slope(runs, best, x_of);
}

void compare(WorkPrecisionOutcome& outcome, const std::vector<double>& accuracies) {
  std::vector<WorkPrecisionRun>& runs = outcome.runs;
  outcome.lines.clear(), outcome.costs.clear();
  std::vector<std::size_t> sides[2];              // of the engine, of the peers
  std::vector<std::size_t> plain[2], special[2];  // without and with tuned schemes and processed peers
  std::vector<std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    runs[i].on_envelope = false;
    const std::size_t side = runs[i].peer ? 1 : 0;
    sides[side].push_back(i);
    (runs[i].tuned || runs[i].processed ? special : plain)[side].push_back(i);
    const auto line = std::ranges::find(outcome.lines, runs[i].scheme, &WorkPrecisionLine::scheme);
    const std::size_t at = line - outcome.lines.begin();
    if (line == outcome.lines.end()) {
      outcome.lines.push_back({runs[i].scheme, runs[i].peer, runs[i].own, {}});
      members.emplace_back();
    }
    members[at].push_back(i);
  }
  outcome.unsteady = delf::at(std::ranges::count_if(
      runs, [](const WorkPrecisionRun& r) { return r.repeats > 1 && r.seconds_max > 3 * r.seconds_min; }));
  for (std::size_t l = 0; l < members.size(); ++l) {
    outcome.lines[l].front = lower_envelope(runs, members[l]);
    outcome.lines[l].slope = slope_of(runs, outcome.lines[l].front);
    outcome.lines[l].order = order_of(runs, members[l]);
  }
  for (const auto& side : sides)
    for (const std::size_t i : lower_envelope(runs, side)) runs[i].on_envelope = true;
  for (const double accuracy : accuracies) {
    WorkPrecisionCost cost{accuracy, cheapest(runs, plain[0], accuracy), cheapest(runs, plain[1], accuracy),
                           cheapest(runs, special[0], accuracy), cheapest(runs, special[1], accuracy)};
    const auto ratio = [&runs](const auto& slow, const auto& fast) {
      return slow && fast ? runs[*slow].seconds / runs[*fast].seconds : WorkPrecisionRun::unknown;
    };
    cost.ratio = ratio(cost.peer, cost.engine);
    cost.tuned_ratio = ratio(cost.peer, cost.tuned);
    cost.processed_ratio = ratio(cost.processed_peer, cost.engine);
    outcome.costs.push_back(cost);
  }
}

}  // namespace delf

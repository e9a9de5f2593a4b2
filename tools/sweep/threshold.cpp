// SPDX-License-Identifier: MIT
#include "tools/sweep/threshold.hpp"

#include <fmt/format.h>

#include <cmath>

#include "tools/report/interrupt.hpp"

namespace delf {

namespace {

struct Bisected {
  double at, number;
};

}  // namespace

Threshold find_threshold(const SweepRequest& request, const std::string& number, RunPool& pool) {
  Threshold result;
  const SweepRequest::Bisection& b = *request.bisection;
  // The runs at these values of the key; fewer after Ctrl-C, and none that count without the number.
  const auto points = [&](const std::vector<double>& places) {
    std::vector<SweptRun> runs;
    for (const double place : places) runs.push_back(request.run({fmt::format("{}", place)}));
    const std::vector<SweepRow> rows = pool.rows_of(runs);
    std::vector<Bisected> all;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (rows[i].status.empty()) return all;
      result.rows.push_back(rows[i]);
      result.values.push_back(runs[i].values);
      all.push_back({places[i], rows[i].number(number)});
      if (!std::isfinite(all.back().number) && !pool.number_is_unknown())
        throw NumericalFailure(
            fmt::format("the run at {} = {} ({}) has no number {}; choose other ends, or another number",
                        request.keys[0], places[i], rows[i].status, number));
    }
    if (pool.number_is_unknown()) all.clear();
    return all;
  };
  std::vector<Bisected> ends = points({b.low, b.high});
  if (ends.size() < 2) return result;
  result.level = b.level.value_or(0.5 * (ends[0].number + ends[1].number));
  const auto above = [&](const Bisected& p) { return p.number > result.level; };
  if (above(ends[0]) == above(ends[1]))
    throw BadScene(
        fmt::format("command line: --sweep.bisect: {} is {:.6g} at {} = {} and {:.6g} at {}, both on one side of "
                    "{:.6g}; choose other "
                    "ends or sweep.level",
                    number, ends[0].number, request.keys[0], b.low, ends[1].number, b.high, result.level));
  while (ends[1].at - ends[0].at > b.accuracy) {
    const double low = ends[0].at, quarter = 0.25 * (ends[1].at - low);
    if (!(low + quarter > low)) break;  // rounding
    std::vector<Bisected> all{ends[0]};
    const std::vector<Bisected> between = points({low + quarter, low + 2 * quarter, low + 3 * quarter});
    if (between.size() < 3) break;
    all.insert(all.end(), between.begin(), between.end());
    all.push_back(ends[1]);
    std::size_t i = 1;
    while (above(all[i]) == above(all[0])) ++i;
    ends = {all[i - 1], all[i]};
  }
  result.low = ends[0].at, result.high = ends[1].at;
  result.at_low = ends[0].number, result.at_high = ends[1].number;
  result.found = !Interrupt::asked() && !pool.number_is_unknown();
  return result;
}

}  // namespace delf

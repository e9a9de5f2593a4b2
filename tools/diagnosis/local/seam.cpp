// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "lattice/index.hpp"
#include "tools/diagnosis/fields_system.hpp"
#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/local/wall_law.hpp"
#include "tools/diagnosis/own_equations.hpp"

namespace delf {
namespace {

using Rows = std::vector<std::vector<double>>;

struct Moment {
  std::int64_t row;
  Rows rows;  ///< from row − reach
};

// Some rows whose equations fail, with the rows that they read.
std::vector<Moment> moments_of(const Evidence& e) {
  const std::int64_t reach = std::max(1, e.system.height());
  const auto& failing = e.failed.rows();
  constexpr std::size_t most = 8;
  std::vector<Moment> moments;
  for (std::size_t n = 0; n < std::min(most, failing.size()); ++n) {
    const std::int64_t row = failing[failing.size() * n / std::min(most, failing.size())];
    moments.push_back({row, {}});
    for (std::int64_t j = row - reach; j <= row + reach; ++j) moments.back().rows.push_back(e.row(j));
  }
  return moments;
}

// Ghost sites beyond both ends: φ₋₁ = φ₁ and φ_N = φ_{N−2}, or beyond them with ends half a cell off, φ₋₁ = φ₀.
bool is_mirror(const Evidence& e, const std::vector<Moment>& moments, int about) {
  const int N = e.system.lattice().sites(), C = e.system.components(), w = e.system.width();
  Problem p = e.problem;
  p.lattice = Lattice::circle(N + 2 * w, e.system.lattice().space_step() * (N + 2 * w));
  const auto wider = fields_system(p);
  if (!wider) return false;
  for (const Moment& m : moments) {
    Rows rows;
    for (const auto& row : m.rows) {
      std::vector<double> with_ghosts;
      for (int i = -w; i < N + w; ++i) {
        const int inside = i < 0 ? -i - 1 + about : i >= N ? 2 * N - 1 - about - i : i;
        for (int c = 0; c < C; ++c) with_ghosts.push_back(row[inside * C + c]);
      }
      rows.push_back(std::move(with_ghosts));
    }
    const std::int64_t first = m.row - static_cast<std::int64_t>(rows.size() / 2);
    if (!(worst_equation(*wider, rows, first, m.row, 0, w, w + N - 1) <= e.tolerance)) return false;
  }
  return true;
}

}  // namespace

std::optional<Finding> find_seam(const Evidence& e) {
  const Lattice& lattice = e.system.lattice();
  if (!lattice.is_circle() || e.failed.failed() == 0) return std::nullopt;
  const int N = lattice.sites(), w = std::max(1, e.system.width()), C = e.system.components();
  for (const int i : e.failed.sites())
    if (i >= w && i < N - w) return std::nullopt;
  const auto moments = moments_of(e);
  const auto everywhere = [&](const auto& true_of) { return std::ranges::all_of(moments, true_of); };
  const auto at = [&](const std::vector<double>& row, int i) { return row[i * C]; };

  constexpr double circle = 2 * std::numbers::pi;
  const std::vector<double>& row = moments.front().rows.front();
  const double beyond = 2 * at(row, N - 1) - at(row, N - 2);
  for (const double gain : {beyond - at(row, 0), at(row, N - 1) - at(row, 0)}) {
    const double monodromy = circle * std::round(gain / circle);
    if (monodromy == e.monodromy) continue;
    if (everywhere([&](const Moment& m) {
          const std::int64_t first = m.row - static_cast<std::int64_t>(m.rows.size() / 2);
          return worst_equation(e.system, m.rows, first, m.row, monodromy) <= e.tolerance;
        }))
      return Finding{"seam",
                     fmt::format("The equations fail at the seam of the circle alone: the field gains 2π·({:.0f}) "
                                 "around it. Use boundary.winding = {:.0f}.",
                                 monodromy / circle, monodromy / circle)};
  }
  const double k = lattice.space_step(), same = 1e-12 * largest_of(moments.front().rows);
  if (everywhere([&](const Moment& m) {
        return std::ranges::all_of(m.rows, [&](const auto& r) {
          const double gain = at(r, N - 1) - at(r, 0);
          return std::abs(gain - circle * std::round(gain / circle)) <= same;
        });
      }) &&
      std::abs(at(row, 1) - at(row, 0)) + std::abs(at(row, N - 1) - at(row, N - 2)) > same)
    return Finding{
        "seam",
        fmt::format("The last site repeats the first: the rows hold both ends of the circle. Leave the last site "
                    "out, with lattice.sites = {}; if the length is right, k is {:.10g} and not {:.10g}.",
                    N - 1, lattice.length() / (N - 1), k)};
  const auto still = [&](int i) {
    return everywhere([&](const Moment& m) {
      return std::ranges::all_of(m.rows, [&](const auto& r) { return at(r, i) == at(row, i); });
    });
  };
  const bool left = still(0), right = still(N - 1);
  if (left && right)
    return Finding{"seam",
                   fmt::format("Both end sites keep their values: the rows are of an interval between fixed walls. Use "
                               "lattice.space = interval, lattice.length = {:.10g}.",
                               k * (N - 1))};
  if (left || right)
    return Finding{"seam", fmt::format("Site {} keeps its value: it is a fixed wall. Use lattice.space = interval, "
                                       "lattice.length = {:.10g}.",
                                       left ? 0 : N - 1, k * (N - 1))};
  if (is_mirror(e, moments, 1))
    return Finding{"seam",
                   fmt::format("The ends are mirrors, φ₋₁ = φ₁: the rows are of an interval between natural walls. Use "
                               "lattice.space = interval, lattice.length = {:.10g}, boundary.left = natural, "
                               "boundary.right = natural.",
                               k * (N - 1))};
  if (is_mirror(e, moments, 0))
    return Finding{"seam",
                   "The ends are mirrors half a cell beyond the last sites, φ₋₁ = φ₀. No wall here is of that kind; "
                   "everything else holds."};
  if (const std::string at_left = wall_law(e, true), at_right = wall_law(e, false);
      !at_left.empty() && !at_right.empty())
    return Finding{
        "seam",
        fmt::format("The rows are of an interval with {} at its left end, and {} at its right one. No wall here is "
                    "of that kind; everything else holds.",
                    at_left, at_right)};
  return Finding{
      "seam", fmt::format("The equations fail at the ends alone, within {} site{} of them: the rows are of no circle, "
                          "and their ends are of none of the kinds that are known.",
                          w, w == 1 ? "" : "s")};
}

}  // namespace delf

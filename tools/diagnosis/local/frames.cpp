// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/own_equations.hpp"

namespace delf {
namespace {

using Rows = std::vector<std::vector<double>>;

std::int64_t reach_of(const Evidence& e) { return std::max(1, e.system.height()); }

/// The equations fail in these rows alone, and there are others.
bool only_between(const Evidence& e, std::int64_t first, std::int64_t last) {
  const auto& rows = e.failed.rows();
  return !rows.empty() && rows.front() >= first && rows.back() <= last && e.failed.rows_tried() > last - first + 1;
}

/// The worst equation of consecutive rows, each that has all the rows it reads.
double worst_of(const Evidence& e, const Rows& rows) {
  const std::int64_t reach = reach_of(e), count = static_cast<std::int64_t>(rows.size());
  double worst = 0;
  for (std::int64_t j = reach; j < count - reach; ++j)
    worst = std::max(worst, worst_equation(e.system, rows, 0, j, e.monodromy));
  return worst;
}

}  // namespace

std::optional<Finding> find_doubled_frame(const Evidence& e) {
  const std::int64_t reach = reach_of(e);
  for (const std::int64_t failing : e.failed.rows()) {
    for (std::int64_t j = std::max<std::int64_t>(failing - reach, 0); j < failing + reach && j + 1 < e.rows; ++j) {
      if (e.row(j) != e.row(j + 1)) continue;
      Rows rows;
      for (std::int64_t r = std::max<std::int64_t>(j - 2 * reach, 0); r <= std::min(j + 1 + 2 * reach, e.rows - 1); ++r)
        if (r != j + 1) rows.push_back(e.row(r));
      if (static_cast<std::int64_t>(rows.size()) < 2 * reach + 1 || worst_of(e, rows) > e.tolerance)
        return std::nullopt;
      const bool all = only_between(e, j - reach, j + 1 + reach);
      return Finding{"doubled-frame",
                     fmt::format("Frames {} and {} are the same: with one of them left out the equations hold there{}.",
                                 j, j + 1, all ? ", as they do elsewhere" : ""),
                     all};
    }
    return std::nullopt;  // the first failure tells
  }
  return std::nullopt;
}

// Rows p and q stand in each other's place: the equations that read either fail.
std::optional<Finding> find_exchanged_frames(const Evidence& e) {
  const std::int64_t reach = reach_of(e);
  const auto& failing = e.failed.rows();
  if (failing.empty() || static_cast<std::int64_t>(failing.size()) > 2 * (2 * reach + 1)) return std::nullopt;
  struct {
    std::int64_t p = 0, q = 0;
    double worst = std::numeric_limits<double>::infinity();
  } best;
  const auto read_by = [&](std::int64_t frame, std::int64_t row) { return std::abs(row - frame) <= reach; };
  for (std::int64_t p = failing.front() - reach; p <= failing.front() + reach; ++p)
    for (std::int64_t q = std::max(p + 1, failing.back() - reach); q <= failing.back() + reach; ++q) {
      if (p < 0 || q >= e.rows) continue;
      if (!std::ranges::all_of(failing, [&](std::int64_t row) { return read_by(p, row) || read_by(q, row); })) continue;
      double worst = 0;
      for (std::int64_t row = reach; row < e.rows - reach && worst < best.worst; ++row) {
        if (row > p + reach && row < q - reach) row = q - reach;
        if (!read_by(p, row) && !read_by(q, row)) continue;
        Rows rows;
        for (std::int64_t r = row - reach; r <= row + reach; ++r) rows.push_back(e.row(r == p ? q : r == q ? p : r));
        worst = std::max(worst, worst_equation(e.system, rows, row - reach, row, e.monodromy));
      }
      if (worst < best.worst) best = {p, q, worst};
    }
  if (!(best.worst <= e.tolerance)) return std::nullopt;
  return Finding{
      "exchanged-frames",
      fmt::format("Frames {} and {} were exchanged: with each in the other's place the equations hold there, "
                  "as they do elsewhere.",
                  best.p, best.q)};
}

// Between frames j and j + 1 one is missing: y* = Σ_r w_r y_r of the frames around, at the times −2, −1, 0 | 2, 3, 4
std::optional<Finding> find_dropped_frame(const Evidence& e) {
  const std::int64_t reach = reach_of(e);
  const auto& failing = e.failed.rows();
  if (failing.empty()) return std::nullopt;
  const std::int64_t j = failing.front() + reach - 1;
  if (reach != 1 || failing.size() > 2 || j < 2 || j + 3 >= e.rows) return std::nullopt;
  if (!only_between(e, j, j + 1)) return std::nullopt;
  // Lagrange's polynomial through these times, at time 1
  constexpr double weights[] = {0.05, -0.3, 0.75, 0.75, -0.3, 0.05};
  Rows rows;
  std::vector<double> missing(e.row(0).size(), 0.0);
  for (int n = 0; n < 6; ++n) {
    rows.push_back(e.row(j - 2 + n));
    for (std::size_t i = 0; i < missing.size(); ++i) missing[i] += weights[n] * rows.back()[i];
  }
  const double before = worst_of(e, {rows[1], rows[2], rows[3], rows[4]});
  rows.insert(rows.begin() + 3, missing);
  const double after = worst_of(e, {rows[1], rows[2], rows[3], rows[4], rows[5]});
  if (!(after < 0.05 * before)) return std::nullopt;
  return Finding{
      "dropped-frame",
      fmt::format("A frame is missing between frames {} and {}: with an interpolated one there the equations hold "
                  "{:.0f} times better, and elsewhere they hold.",
                  j, j + 1, before / after)};
}

std::optional<Finding> find_first_rows(const Evidence& e) {
  const std::int64_t reach = reach_of(e);
  if (!only_between(e, 0, 2 * reach - 1)) return std::nullopt;
  return Finding{
      "first-rows",
      fmt::format("Only the equations of the first rows fail, and from row {} on all hold: the rows before it are "
                  "not of this scheme. A start of another kind, or an array that was overwritten. Leave out the "
                  "first {}.",
                  2 * reach, reach == 1 ? "frame" : "frames")};
}

}  // namespace delf

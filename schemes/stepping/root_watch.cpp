// SPDX-License-Identifier: MIT
#include "schemes/stepping/root_watch.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace delf {
namespace {

/// What a root may leave its predictor by, over what the predictors of two orders differ by. In 192 runs of the shipped scenes
/// of elements, moving meshes and multipliers, by many methods and steps, those of the motion leave it by less than 4, but for
/// discontinuous elements of one function, which are two oscillations at once: by 4.11 at the longest steps. Other roots were
/// at 15.3 and more (Lotka–Volterra, h = 1/16), those of another branch of a constraint at 10¹⁶.
constexpr double most = 6;
constexpr double clearly = 0.25;   ///< a part of the way that no doubt begins below
constexpr double rounding = 1e-8;  ///< of the values: differences of high order are rounding below

using Maxima = std::array<double, RootWatch::most_rows + 1>;

void raise(double& largest, double by) { largest = std::max(largest, std::abs(by)); }

}  // namespace

RootWatch::RootWatch(const LatticeSystem& system) : system_(system) {}

RootWatch::Verdict RootWatch::judge(const SectionRing& ring, std::span<const Values> lists) const {
  int rows = 0;
  for (const Values& list : lists) rows = std::max(rows, std::min(list.rows, most_rows));
  if (rows < 2) return Verdict::doubtful;
  const auto fields = static_cast<std::size_t>(system_.fields());
  const int components = system_.components();
  const auto field_of = [&](int place) { return static_cast<std::size_t>(system_.component(place % components).field); };
  // Resolved motions leave the straight line by a small part of the way.
  std::vector<double> way(fields, 0.0), aside(fields, 0.0);
  for (const Values& list : lists) {
    if (list.rows < rows) continue;
    const double *const y = ring.row(list.row), *const y1 = ring.row(list.row - 1), *const y2 = ring.row(list.row - 2);
    for (const int at : list.places) {
      const double step = y1[at] - y2[at];
      raise(way[field_of(at)], step), raise(aside[field_of(at)], y[at] - y1[at] - step);
    }
  }
  bool all = true;
  for (std::size_t f = 0; f < fields; ++f) all = all && aside[f] <= clearly * way[f];
  if (all) return Verdict::near;

  std::vector<Maxima> leaves(fields, Maxima{}), differ(fields, Maxima{});  // |∇ᵖ y_{n+1}|, and what predictors differ by
  std::vector<double> size(fields, 0.0);
  for (const Values& list : lists) {
    if (list.rows < rows) continue;
    for (const int at : list.places) {
      double difference[most_rows + 1];  // ∇ᵖ of rows n+1, n, …
      for (int m = 0; m <= rows; ++m) difference[m] = ring.row(list.row - m)[at];
      const std::size_t f = field_of(at);
      raise(size[f], difference[1]);
      for (int p = 1; p <= rows; ++p) {
        if (p > 1) {
          raise(differ[f][static_cast<std::size_t>(p)], difference[1]);
          if (p < rows) raise(differ[f][static_cast<std::size_t>(p)], difference[2]);
        }
        for (int m = 0; m <= rows - p; ++m) difference[m] -= difference[m + 1];
        raise(leaves[f][static_cast<std::size_t>(p)], difference[0]);
      }
    }
  }
  const std::size_t last = std::max<std::size_t>(2, static_cast<std::size_t>(rows) - 1);
  Verdict verdict = Verdict::near;
  for (std::size_t f = 0; f < fields; ++f) {
    std::size_t p = 2;
    for (std::size_t q = 3; q <= last; ++q)
      if (differ[f][q] < differ[f][p]) p = q;
    const double least = rounding * size[f];
    if (leaves[f][p] > most * differ[f][p] + least) return Verdict::far;
    if (rows < most_rows && leaves[f][p] > differ[f][p] + least) verdict = Verdict::doubtful;
  }
  return verdict;
}

}  // namespace delf

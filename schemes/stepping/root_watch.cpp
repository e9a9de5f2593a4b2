// SPDX-License-Identifier: MIT
#include "schemes/stepping/root_watch.hpp"

#include <algorithm>
#include <cmath>

#include "lattice/index.hpp"
#include "schemes/system/driven_values.hpp"

namespace delf {
namespace {

/// The largest distance of a root from its predictor, over the difference of predictors of two orders. In 192 runs of
/// the shipped scenes of elements, moving meshes and multipliers, by many methods and steps, roots of the motion leave
/// it by less than 4, but for discontinuous elements of one function, two oscillations at once: by 4.11 at the longest
/// steps. Other roots were at 15.3 and more (Lotka–Volterra, h = 1/16), of another branch of a constraint at 10¹⁶.
constexpr double farthest = 6;
constexpr double clearly = 0.25;             ///< a part of the way that no doubt begins below
constexpr double rounding_of_motion = 1e-8;  ///< of the values: differences of high order are rounding below

/// Corrections that go no further than this part of |y|, or that all shrink by four and more, leave no other root near
/// (Kantorovich).
constexpr double little = 1e-3, straight = 0.25;

void raise(double& largest, double by) { largest = std::max(largest, std::abs(by)); }

}  // namespace

RootWatch::RootWatch(const LatticeSystem& system)
    : system_(system),
      driven_(DrivenValues(system).places_of_fields()),
      fields_(delf::at(system.fields())),
      has_flux_(has_flux(system)) {
  for (const Component& c : system.all_components()) {
    field_.push_back(delf::at(c.field));
    moves_.push_back(c.role == Role::field || c.position);
  }
}

Stop RootWatch::judge(const NewtonProgress& at, const SectionRing& ring, std::int64_t J, std::int64_t solved,
                      std::span<const Values> lists) {
  if (at.travelled <= little * at.size) return Stop::converged;
  const Stop stop = judge(ring, J, solved, lists);
  return stop == Stop::doubtful_root && at.steepest <= straight ? Stop::converged : stop;
}

int RootWatch::rows(const Values& list, std::int64_t J, std::int64_t solved) const {
  return static_cast<int>(std::min<std::int64_t>({list.is_field ? J + list.time : solved, list.held, most_rows}));
}

Stop RootWatch::judge(const SectionRing& ring, std::int64_t J, std::int64_t solved, std::span<const Values> lists) {
  int most = 0;
  for (const Values& list : lists) most = std::max(most, rows(list, J, solved));
  if (most < 2) return Stop::doubtful_root;
  // What flows in moves the field from rest, and few rows have none of that motion.
  if (has_flux_ && most < most_rows) return Stop::converged;
  const int components = system_.components();
  const auto each = [&](const auto& visit) {
    for (const Values& list : lists) {
      if (rows(list, J, solved) < most) continue;
      const double* y[most_rows + 1];  // rows n+1, n, …
      for (int m = 0; m <= most; ++m) y[m] = ring.row(J + list.time - m);
      for (const int at : list.places) visit(fields_[field_[at % components]], y, at);
    }
  };
  std::ranges::fill(fields_, Field{});
  // Resolved motions leave the straight line by a small part of the way.
  each([](Field& f, const double* const* y, int at) {
    const double step = y[1][at] - y[2][at];
    raise(f.way, step), raise(f.aside, y[0][at] - y[1][at] - step);
  });
  if (std::ranges::all_of(fields_, [](const Field& f) { return f.aside <= clearly * f.way; })) return Stop::converged;

  each([most](Field& f, const double* const* y, int at) {
    double difference[most_rows + 1];  // ∇ᵖ of rows n+1, n, …
    for (int m = 0; m <= most; ++m) difference[m] = y[m][at];
    raise(f.size, difference[1]);
    for (int p = 1; p <= most; ++p) {
      const std::size_t order = p;
      if (p > 1) raise(f.differ[order], difference[1]);
      if (p > 1 && p < most) raise(f.differ[order], difference[2]);
      for (int m = 0; m <= most - p; ++m) difference[m] -= difference[m + 1];
      raise(f.leaves[order], difference[0]);
    }
  });
  // A driven end moves as it is given, the new row included, and what it sets off may move as far.
  for (const Values& list : lists) {
    if (!list.is_field || rows(list, J, solved) < most) continue;
    for (const int at : driven_) {
      Field& f = fields_[field_[at % components]];
      double difference[most_rows + 1];
      for (int m = 0; m <= most; ++m) difference[m] = ring.row(J + list.time - m)[at];
      for (int p = 1; p <= most; ++p) {
        for (int m = 0; m <= std::min(2, most - p + 1); ++m) raise(f.differ[delf::at(p)], difference[m]);
        for (int m = 0; m <= most - p; ++m) difference[m] -= difference[m + 1];
      }
    }
  }
  const std::size_t last = std::max<std::size_t>(2, delf::at(most) - 1);
  Stop stop = Stop::converged;
  for (const Field& f : fields_) {
    std::size_t p = 2;
    for (std::size_t q = 3; q <= last; ++q)
      if (f.differ[q] < f.differ[p]) p = q;
    const double least = rounding_of_motion * f.size;
    if (f.leaves[p] > farthest * f.differ[p] + least) return Stop::other_root;
    if (most < most_rows && f.leaves[p] > f.differ[p] + least) stop = Stop::doubtful_root;
  }
  return stop;
}

bool RootWatch::leaps(const SectionRing& ring, std::int64_t row) const {
  const RowTimes& times = *system_.times();
  const double stride = times.step(row - 1) / times.step(row - 2);
  const double *const now = ring.row(row), *const before = ring.row(row - 1), *const first = ring.row(row - 2);
  double way = 0, aside = 0;
  const std::size_t size = moves_.size() * delf::at(system_.lattice().sites());
  for (std::size_t at = 0; at < size; ++at) {
    if (moves_[at % moves_.size()] == 0) continue;
    const double line = stride * (before[at] - first[at]);
    raise(way, line), raise(aside, now[at] - before[at] - line);
  }
  return aside > way;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/rows/at_the_ends.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

namespace {

using FieldPoints = std::vector<FieldPoint>;

FieldPoints values_at(const State& state, double t, double x) {
  FieldPoints values(delf::at(state.components()));
  state.at(t, x, values);
  return values;
}

void take(EndChange& worst, double change, const char* words) {
  if (change > worst.change) worst = {change, words};
}

/// A state on a circle at one time. A pulse may have its seam anywhere.
class CircleAt {
 public:
  CircleAt(const State& state, double length, double monodromy, double t)
      : state_(state), length_(length), monodromy_(monodromy), t_(t) {
    for (int i = 0; i <= points; ++i) row_.push_back(at(i));
  }

  /// The largest difference (left, right, distance) of component a that stays where an interval is halved again and again.
  template <class Difference>
  double jump(std::size_t a, const Difference& difference) const {
    const double cell = length_ / points;
    double most = 0, from = 0, to = 0;
    for (std::size_t i = 0; i < points; ++i)
      if (const double by = difference(row_[i][a], row_[i + 1][a], cell); by > most)
        most = by, from = static_cast<double>(i), to = from + 1;
    for (int halved = 0; halved < 30 && most > 0; ++halved) {
      const double middle = (from + to) / 2;
      const FieldPoint left = at(from)[a], here = at(middle)[a], right = at(to)[a];
      const double below = difference(left, here, (middle - from) * cell),
                   above = difference(here, right, (to - middle) * cell);
      most = std::max(below, above);
      (below > above ? to : from) = middle;
    }
    return most;
  }

 private:
  static constexpr int points = 2048;
  /// `cells` from the origin; around the circle the fields have gained `monodromy`.
  FieldPoints at(double cells) const {
    const bool around = cells >= points;
    FieldPoints values = values_at(state_, t_, around ? 0 : length_ * cells / points);
    for (FieldPoint& value : values) value.phi += around ? monodromy_ : 0;
    return values;
  }

  const State& state_;
  double length_, monodromy_, t_;
  std::vector<FieldPoints> row_;
};

}  // namespace

AtTheEnds at_the_ends(const Scene& scene, const State& state) {
  const Lattice& lattice = scene.problem.lattice;
  AtTheEnds worst;
  if (lattice.space() == Space::point) return worst;
  const int times = state.exact() ? 64 : 0, between_searches = 8;
  const double L = lattice.length(), end = scene.end(), acts = std::min(std::abs(end), L),
               monodromy = 2 * std::numbers::pi * state.winding() + gain_of(scene.problem.parameters);
  const auto is_driven = [&](const char* value, const char* flux) {
    return scene.problem.parameters.has(value) || scene.problem.parameters.has(flux);
  };
  const auto theory = make_theory(find_theory(scene.problem.theory), scene.problem.parameters);
  const FormulasOfTime left_motion = motion_of_end(*theory, scene.problem, left_end),
                       right_motion = motion_of_end(*theory, scene.problem, right_end);
  const FieldPoints left = values_at(state, 0, 0), right = values_at(state, 0, L);
  for (int n = 0; n <= times; ++n) {
    const double t = n == 0 ? 0 : end * n / times;
    const FieldPoints here = values_at(state, t, 0),
                      there = values_at(state, t,
                                        lattice.is_circle() ? L * (1 - 2 * std::numeric_limits<double>::epsilon()) : L);
    const auto at_wall = [&](Wall wall, const FieldPoint& now, const FieldPoint& before, const char* moves) {
      if (wall == Wall::natural)
        return take(worst.slope, std::abs(now.phi_x) * acts, "has a slope at a natural wall, which moves it");
      take(worst.value, std::abs(now.phi - before.phi), moves);
      if (times == 0) take(worst.slope, std::abs(now.phi_t) * acts, "has a rate at a fixed wall, which would move it");
    };
    for (std::size_t a = 0; a < here.size(); ++a) {
      if (lattice.is_circle()) {
        take(worst.value, std::abs(there[a].phi - here[a].phi - monodromy), "jumps where the circle closes");
        continue;
      }
      if (!is_driven(left_end, left_flux))
        at_wall(lattice.left(), here[a], left[a], "moves at the left wall, which is fixed");
      if (!is_driven(right_end, right_flux))
        at_wall(lattice.right(), there[a], right[a], "moves at the right wall, which is fixed");
    }
    const auto follow = [&](const FormulasOfTime& motion, const FieldPoints& now, const char* words) {
      for (std::size_t a = 0; times > 0 && a < motion.size(); ++a)
        take(worst.value, std::abs(now[a].phi - (*motion[a].formula)(t, 0)), words);
    };
    follow(left_motion, here, "does not move with the left end, which is driven");
    follow(right_motion, there, "does not move with the right end, which is driven");
    if (!lattice.is_circle() || n % between_searches != 0) continue;
    const CircleAt circle(state, L, monodromy, t);
    for (std::size_t a = 0; a < here.size(); ++a) {
      const auto value = [](const FieldPoint& l, const FieldPoint& r, double apart) {
        return std::abs(r.phi - l.phi - apart * (l.phi_x + r.phi_x) / 2);
      };
      const auto slope = [](const FieldPoint& l, const FieldPoint& r, double) { return std::abs(r.phi_x - l.phi_x); };
      take(worst.value, circle.jump(a, value), "jumps where the circle closes");
      take(worst.slope, acts * circle.jump(a, slope), "has a corner where the circle closes, which moves it");
    }
  }
  return worst;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/system/equation_terms.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "lattice/error.hpp"
#include "lattice/stencil.hpp"

namespace delf {
namespace {

/// The constant part of the equation at one site, with cancelled coefficients dropped: A_{m,s,b} and r(0).
struct LinearEquation {
  std::map<std::tuple<int, int, int>, double> A;  ///< (row offset, site offset, component)
  double constant = 0;
};

LinearEquation linear_equation(const LatticeSystem& system, Site site, int a) {
  LinearEquation result;
  std::map<std::tuple<int, int, int>, double> scale;
  for (const auto& touch : system.touching(site, a)) {
    const int size = touch.family->size();
    const auto part = touch.family->constant_part({system.time_step(), system.lattice().space_step(), 0, 0});
    if (!part) throw NoConvergence("the constant part of the equations is not finite");
    result.constant += part->r0[touch.index];
    for (int m = 0; m < size; ++m) {
      const Site offset = touch.anchor + touch.family->site(m);
      const std::tuple key{offset.time, offset.space, touch.family->values()[m].component};
      const double entry = part->J[touch.index * size + m];
      result.A[key] += entry;
      scale[key] += std::abs(entry);
    }
  }
  std::erase_if(result.A, [&](const auto& e) { return std::abs(e.second) <= 1e-13 * scale[e.first]; });
  return result;
}

/// Even and odd sites of a brick wall as mean and half difference.
template <class Key>
std::map<Key, std::pair<double, double>> mean_and_alternating(const std::map<Key, double>& even,
                                                              const std::map<Key, double>& odd) {
  std::map<Key, std::pair<double, double>> result;
  for (const auto& [key, value] : even) result[key] = {value / 2, value / 2};
  for (const auto& [key, value] : odd) {
    result[key].first += value / 2;
    result[key].second -= value / 2;
  }
  for (auto& [key, value] : result)
    if (std::abs(value.second) <= 1e-13 * std::abs(value.first)) value.second = 0;
  return result;
}

/// Writes A_{m,s} in terms of y_n, the increments and w: with r = shift − 1 − m rows back from n,
///     y_{n−r} = y_n − Σ_{u<r} v_{n−u},        y_{n+1} = y_n + v_n + w
void add_linear_terms(const std::map<std::tuple<int, int, int>, std::pair<double, double>>& A, int a,
                      EquationTerms& equation) {
  using Pair = std::pair<double, double>;
  const auto plus = [](Pair& p, Pair q, double sign) { p.first += sign * q.first, p.second += sign * q.second; };
  std::map<std::tuple<int, int>, Pair> B;          // (s, b): coefficient of y_n
  std::map<std::tuple<int, int, int>, Pair> C, D;  // (u, s, b): of v_{n−u};  (0, s, b): of w
  double scale = 0;
  for (const auto& [key, value] : A) {
    const auto& [m, s, b] = key;
    scale += std::abs(value.first);
    const int r = equation.shift - 1 - m;
    plus(B[{s, b}], value, 1);
    if (r == -1) {
      plus(C[{0, s, b}], value, 1);
      plus(D[{0, s, b}], value, 1);
    }
    for (int u = 0; u < r; ++u) plus(C[{u, s, b}], value, -1);
  }
  const auto negligible = [scale](Pair p) { return std::max(std::abs(p.first), std::abs(p.second)) <= 1e-14 * scale; };
  Pair own{0, 0};
  for (const auto& [key, value] : B) {
    const auto& [s, b] = key;
    if (b == a) plus(own, value, 1);
    if (negligible(value)) continue;
    if (b != a) equation.terms.push_back({Source::value, 0, b, 0, 0, s, value.first, value.second});
    else if (s != 0) equation.terms.push_back({Source::difference, 0, b, 0, 0, s, value.first, value.second});
  }
  if (!negligible(own)) equation.terms.push_back({Source::value, 0, a, 0, 0, 0, own.first, own.second});
  for (const auto& [key, value] : C)
    if (!negligible(value)) {
      const auto& [u, s, b] = key;
      equation.terms.push_back({Source::increment, u, b, 0, 0, s, value.first, value.second});
    }
  for (const auto& [key, value] : D) {
    const auto& [u, s, b] = key;
    equation.terms.push_back({Source::unknown, 0, b, 0, 0, s, value.first, value.second});
  }
}

/// Outputs of every stencil that could touch the site in some row; bricks that are not there are left out later.
void add_output_terms(const LatticeSystem& system, int site, int a, EquationTerms& equation) {
  for (std::size_t f = 0; f < system.families().size(); ++f) {
    const StencilFamily& family = *system.families()[f];
    const SourceTerms& sources = *family.sources();
    const double hk = system.time_step() * system.lattice().space_step();
    for (int i = 0; i < family.size(); ++i) {
      if (family.values()[i].component != a) continue;
      const Site anchor = Site{} - family.site(i);
      if (!has_column(system.lattice(), family.pattern(), site + anchor.space)) continue;
      for (int c = 0; c < sources.outputs(); ++c)
        if (const double w = hk * sources.weight(c, i); w != 0)
          equation.terms.push_back(
              {Source::output, 1 - equation.shift + anchor.time, 0, static_cast<int>(f), c, anchor.space, w, 0});
    }
  }
}

}  // namespace

bool goes_by_rows(const LatticeSystem& system, const SolvePlan& plan) {
  const int d = system.components(), last = system.lattice().sites() - 1;
  if (system.lattice().space() == Space::mesh) return false;
  // Between walls the number of sites is odd, and arcs of an even number of sites do not cover them.
  if (system.placement() == Placement::brick_wall && !system.lattice().is_circle()) return false;
  for (const auto& family : system.families())
    if (!family->sources() || family->size() != family->pattern().size() * d) return false;
  bool one_row = plan.table.regular;
  for (int i : {0, last / 2, last})
    for (int a = 0; a < d; ++a)
      one_row = one_row && plan.offset(i, a, 0) == 0 && plan.offset(i, a, 1) == 0 &&
                plan.shift(i, a, 0) == plan.shift(i, a, 1);
  return one_row;
}

SteppedEquations assemble(const LatticeSystem& system, const SolvePlan& plan) {
  const Lattice& lattice = system.lattice();
  const int d = system.components(), N = lattice.sites();
  const bool bricks = system.placement() == Placement::brick_wall;
  SteppedEquations result;

  const auto equation_at = [&](int site, int a, std::vector<UnknownEntry>& unknowns) {
    EquationTerms equation;
    equation.shift = plan.shift(site, a);
    const LinearEquation even = linear_equation(system, {site % 2, site}, a);
    const LinearEquation odd = bricks ? linear_equation(system, {(site + 1) % 2, site}, a) : even;
    add_linear_terms(mean_and_alternating(even.A, odd.A), a, equation);
    equation.constant = (even.constant + odd.constant) / 2;
    equation.constant_alternating = (even.constant - odd.constant) / 2;
    add_output_terms(system, site, a, equation);
    for (const auto& [key, value] : mean_and_alternating(even.A, odd.A)) {
      const auto& [m, s, b] = key;
      if (m == equation.shift) unknowns.push_back({s, b, value.first, value.second});
    }
    return equation;
  };

  const int width = std::max(1, system.width());
  // A point has no walls either: its equations are those of the bulk.
  const bool uniform = lattice.is_circle() || lattice.space() == Space::point;
  for (int a = 0; a < d; ++a) {
    result.bulk.emplace_back();
    result.unknowns.emplace_back();
    if (uniform || N > 2 * width) result.bulk.back() = equation_at(N / 2, a, result.unknowns.back());
  }
  if (uniform) return result;
  for (int i = 0; i < N; ++i) {
    if (i >= width && i < N - width) {
      i = N - width - 1;
      continue;
    }
    for (int a = 0; a < d; ++a) {
      SiteEquation special{i, a, !plan.solved(i, a), {}, {}};
      if (!special.fixed) special.equation = equation_at(i, a, special.unknowns);
      result.exceptional.push_back(std::move(special));
    }
  }
  return result;
}

}  // namespace delf

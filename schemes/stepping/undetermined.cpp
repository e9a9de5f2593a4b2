// SPDX-License-Identifier: MIT
#include "schemes/stepping/undetermined.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "schemes/solvers/sparse_lu.hpp"
#include "schemes/stepping/gauge.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/system/equation_terms.hpp"
#include "schemes/system/slab_extent.hpp"

namespace delf {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

/// The largest |Jx| over Σ|J||x| where J x = 0 but for rounding, and the relative change that lets a singular J be
/// factored.
constexpr double rounding = 1e-12, change = 1e-13;
constexpr int states = 2, tries = 4;

/// x with J x = 0, |x| = 1 at most: of (J + δJ)x = r with a random r, what is of the null space is 10¹³ times the rest.
/// Nothing where J has full rank. All entries are changed, at random: δJ must join the null vectors of J and of Jᵀ.
std::optional<Vector> null_vector(const Assembly& equations, const std::vector<double>& values, std::mt19937& random) {
  std::uniform_real_distribution<double> number(-1, 1);
  const std::vector<Assembly::Place>& places = equations.places();
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t n = 0; n < values.size(); ++n)
    entries.emplace_back(places[n].equation, places[n].unknown, values[n]);
  Matrix J(equations.size(), equations.size()), nearby(J.rows(), J.cols());
  J.setFromTriplets(entries.begin(), entries.end());
  for (int once = 0; once < tries; ++once) {
    for (std::size_t n = 0; n < values.size(); ++n)
      entries[n] = {places[n].equation, places[n].unknown, values[n] * (1 + change * number(random))};
    nearby.setFromTriplets(entries.begin(), entries.end());
    SparseLU lu;
    if (!factor(lu, nearby)) continue;
    const Vector right = Vector::NullaryExpr(J.cols(), [&] { return number(random); });
    Vector x = lu.solve(right);
    if (!x.allFinite()) continue;
    x /= x.lpNorm<Eigen::Infinity>();
    const double left = (J * x).lpNorm<Eigen::Infinity>();
    if (left <= rounding * (J.cwiseAbs() * x.cwiseAbs()).lpNorm<Eigen::Infinity>()) return x;
  }
  return std::nullopt;
}

/// "a at sites 0, 1, 2, … in the ratio 1 : -1 : 1": of the component that moves most; of others the name.
std::string in_words(const LatticeSystem& system, const Assembly& equations, const Vector& x) {
  constexpr double small = 1e-6;
  constexpr int shown = 3;
  Eigen::Index most = 0;
  x.cwiseAbs().maxCoeff(&most);
  const int component = equations.unknown(static_cast<int>(most)).component;
  std::vector<std::pair<int, double>> own;
  std::vector<std::string> others;
  for (int n = 0; n < equations.size(); ++n) {
    const Node& node = equations.unknown(n);
    if (std::abs(x[n]) < small) continue;
    const std::string& name = system.component(node.component).name;
    if (node.component == component) own.emplace_back(node.site.space, x[n]);
    else if (std::ranges::find(others, name) == others.end()) others.push_back(name);
  }
  std::ranges::sort(own);
  std::string sites, ratio;
  for (std::size_t n = 0; n < own.size() && n < shown; ++n) {
    sites += fmt::format("{}{}", n == 0 ? "" : ", ", own[n].first);
    ratio += fmt::format("{}{:.3g}", n == 0 ? "" : " : ", own[n].second / own[0].second);
  }
  const bool more = own.size() > shown;
  std::string words = fmt::format("{} at {} {}{}", system.component(component).name, own.size() == 1 ? "site" : "sites",
                                  sites, more ? ", …" : "");
  if (own.size() > 1) words += fmt::format(" in the ratio {}{}", ratio, more ? " : …" : "");
  for (const std::string& name : others) words += fmt::format(", and {}", name);
  return words;
}

}  // namespace

void require_determined(const Evolution& evolution) {
  const LatticeSystem& system = evolution.system();
  const SolvePlan plan = with_gauge(system, evolution.plan());
  if (!goes_by_rows(system, plan) || evolution.stepper().layout()) return;
  const SlabExtent extent = slab_extent(system, plan);
  const int past = std::max(plan.history, extent.below + 1);
  const std::size_t row = at(system.lattice().sites() * system.components());
  std::mt19937 random(5489);
  std::uniform_real_distribution<double> value(-1, 1);
  for (int p = 0; p < plan.table.parities; ++p) {
    const Assembly equations(system, Assembly::slab(plan, p, past, extent.above, 0));
    std::optional<Vector> direction;
    for (int state = 0; state < states; ++state) {
      SectionRing ring(past + extent.above + 1, row);
      for (std::int64_t r = p - past; r <= p + extent.above; ++r)
        std::generate_n(ring.row(r), row, [&] { return value(random); });
      std::vector<double> values;
      equations.jacobian(ring, p, values);
      if (!std::ranges::all_of(values, [](double x) { return std::isfinite(x); })) return;
      direction = null_vector(equations, values, random);
      if (!direction) break;
    }
    if (!direction) continue;
    const int N = system.lattice().sites();
    throw BadInput("lattice.sites",
                   fmt::format("lattice.sites = {}: no equation of a step changes with {}: it determines no such wave; "
                               "{}take another lattice.stencil",
                               N, in_words(system, equations, *direction),
                               N % 2 == 0 ? "raise lattice.sites to an odd number, or " : ""));
  }
}

}  // namespace delf

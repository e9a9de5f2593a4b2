// SPDX-License-Identifier: MIT
#include "schemes/verify/region_system.hpp"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>
#include <Eigen/SparseQR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "jets/forms.hpp"
#include "lattice/index.hpp"
#include "schemes/system/conserved.hpp"

namespace delf {

std::vector<StencilPattern> patterns_of(const LatticeSystem& system) {
  std::vector<StencilPattern> patterns;
  for (const auto& family : system.families()) patterns.push_back(family->pattern());
  return patterns;
}

Stencils stencils_of(const LatticeSystem& system) {
  std::vector<const ListedStencils*> lists;
  for (const auto& family : system.families()) lists.push_back(family->listed());
  return {system.lattice(), patterns_of(system), std::move(lists)};
}

/// Reads the multiplier of a constraint: one that is a momentum ties the ends of an element.
bool has_multiplier(const LatticeSystem& system, const StencilFamily& family) {
  return std::ranges::any_of(family.values(), [&](const VertexValue& value) {
    const Component& c = system.component(value.component);
    return c.role == Role::multiplier && !c.momentum;
  });
}

std::vector<RegionSystem::Pair> pairs_of(std::vector<RegionSystem::Values> variations) {
  std::vector<RegionSystem::Pair> pairs;
  for (std::size_t n = 0; n + 1 < variations.size(); n += 2)
    pairs.push_back({std::move(variations[n]), std::move(variations[n + 1])});
  return pairs;
}

RegionSystem::RegionSystem(const LatticeSystem& system, Region region, std::int64_t origin, double monodromy,
                           SlavedValues slaved)
    : system_(system),
      region_(std::make_shared<const Region>(std::move(region))),
      origin_(origin),
      components_(system.components()),
      by_forms_(is_variational(system) || slaved == SlavedValues::known),
      kind_(region_->sites().size(), outside) {
  for (const Site site : region_->interior()) kind_[region_->place(site)] = inside;
  for (const Site site : region_->boundary()) kind_[region_->place(site)] = boundary;
  solved_.assign(nodes(), false);
  held_.assign(nodes(), false);
  const std::size_t C = components_;
  const bool walls_vary = region_->is_data() != nullptr;
  Assembly::Parts parts{.equations = {},
                        .parity = static_cast<int>(origin & 1),
                        .monodromy = monodromy,
                        .stencils = std::vector<Assembly::Anchor>(),
                        .place = [region = region_](Site site) { return static_cast<int>(region->place(site)); }};
  region_->visit_stencils([&](int f, Site anchor, std::span<const std::size_t> places) {
    const Lattice& lattice = system_.lattice();
    parts.stencils->push_back({f, {anchor.time, lattice.home(anchor.space)}});
    for (const VertexValue& value : system_.families()[f]->values()) {
      const std::size_t place = places[value.vertex];
      const std::size_t node = place * C + delf::at(value.component);
      held_[node] = (!walls_vary && system_.is_held(region_->sites()[place].space, value.component)) ||
                    (slaved == SlavedValues::known && system_.component(value.component).role == Role::slaved);
      solved_[node] = kind_[place] == inside && !held_[node];
    }
  });
  for (std::size_t n = 0; n < solved_.size(); ++n)
    if (solved_[n]) equations_.push_back(n), parts.equations.push_back(node(n));
  assembly_.emplace(system_, std::move(parts));
}

Node RegionSystem::node(std::size_t n) const {
  const std::size_t C = components_;
  return {region_->sites()[n / C], static_cast<int>(n % C)};
}

RegionSystem::Values RegionSystem::restricted(const Window& window) const {
  Values values(nodes());
  for (std::size_t n = 0; n < values.size(); ++n) {
    const Node at = node(n);
    values[n] = window(origin_ + at.site.time, at.site.space, at.component);
  }
  return values;
}

void RegionSystem::gather(const Assembly::Local& at, const Values& from, std::vector<double>& to) const {
  Assembly::gather(at, row(from), origin_, to);
}

template <class Visit>
void RegionSystem::each_jacobian(const Values& y, bool at_boundary, const Visit& visit) const {
  assembly_->each_jacobian(row(y), origin_, [&](const Assembly::Local& at) {
    if (!at_boundary || std::ranges::any_of(at.places, [&](int node) { return this->at_boundary(node); }))
      visit(at, at.places, at.derivatives);
  });
}

std::vector<Balance> RegionSystem::residual(const Values& y) const {
  std::vector<Balance> E(nodes()), result;
  assembly_->each_residual(row(y), origin_, [&](const Assembly::Local& at) {
    for (std::size_t i = 0; i < at.places.size(); ++i)
      if (at.family.is_varied(static_cast<int>(i))) E[at.places[i]].add(at.derivatives[i]);
  });
  for (const std::size_t n : equations_) result.push_back(E[n]);
  return result;
}

std::vector<double> RegionSystem::sizes(const Values& y) const {
  std::vector<double> size(nodes(), 0.0);
  each_jacobian(y, false, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    for (std::size_t i = 0; i < read.size(); ++i)
      for (std::size_t m = 0; m < read.size(); ++m) size[read[i]] += std::abs(J[i * read.size() + m] * at.y[m]);
  });
  return size;
}

std::vector<double> RegionSystem::sizes_of_stencils(const Values& y) const {
  std::vector<double> size(nodes(), 0.0);
  each_jacobian(y, false, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    double sum = 0;
    for (std::size_t n = 0; n < J.size(); ++n) sum += std::abs(J[n] * at.y[n % read.size()]);
    for (const int node : read) size[node] += sum;
  });
  return size;
}

std::vector<Balance> RegionSystem::linearised(const Values& y, const Values& V) const {
  Assembly::Variation variation{row(V)};
  std::vector<double> values;
  assembly_->linearised(row(y), origin_, {&variation, 1}, values);
  std::vector<Balance> result;
  for (std::size_t n = 0; n < equations_.size(); ++n) result.push_back({variation.E[n], variation.absolute[n]});
  return result;
}

std::vector<RegionSystem::Values> RegionSystem::first_variations(const Values& y, int count,
                                                                 std::mt19937_64& random) const {
  // The columns of M are the nodes that may vary and that some equation reads. Mᵀ: its columns are the equations.
  std::vector<Eigen::Triplet<double>> entries;
  std::vector<int> row(nodes(), -1), column(nodes(), -1);
  for (std::size_t n = 0; n < equations_.size(); ++n) column[equations_[n]] = static_cast<int>(n);
  std::vector<std::size_t> varied;
  each_jacobian(y, false, [&](const Assembly::Local&, Reads read, std::span<const double> J) {
    for (std::size_t i = 0; i < read.size(); ++i)
      for (std::size_t m = 0; m < read.size() && is_solved(read[i]); ++m) {
        const double entry = J[i * read.size() + m];
        if (entry == 0 || is_held(read[m])) continue;
        if (row[read[m]] < 0) row[read[m]] = static_cast<int>(varied.size()), varied.push_back(read[m]);
        entries.emplace_back(row[read[m]], column[read[i]], entry);
      }
  });
  std::vector<Values> variations(count, Values(nodes(), 0.0));
  std::normal_distribution<double> normal;
  // Values that no equation reads are free.
  for (Values& V : variations)
    for (std::size_t n = 0; n < V.size(); ++n)
      if (!held_[n]) V[n] = normal(random);
  if (varied.empty() || equations_.empty()) return variations;

  Eigen::SparseMatrix<double> transposed(static_cast<Eigen::Index>(varied.size()),
                                         static_cast<Eigen::Index>(equations_.size()));
  transposed.setFromTriplets(entries.begin(), entries.end());
  transposed.makeCompressed();
  // Each equation by its own size: the rank is judged by columns, and theirs may differ by many orders of magnitude.
  for (Eigen::Index n = 0; n < transposed.cols(); ++n)
    if (const double size = transposed.col(n).norm(); size > 0) transposed.col(n) /= size;
  const Eigen::SparseQR<Eigen::SparseMatrix<double>, Eigen::COLAMDOrdering<int>> qr(transposed);
  // Mᵀ P = Q R: the columns of Q after the first rank(M) span the null space of M.
  for (Values& V : variations) {
    Eigen::VectorXd c = Eigen::VectorXd::Zero(transposed.rows());
    for (Eigen::Index n = qr.rank(); n < c.size(); ++n) c[n] = normal(random);
    const Eigen::VectorXd v = qr.matrixQ() * c;
    for (std::size_t n = 0; n < varied.size(); ++n) V[varied[n]] = v[static_cast<Eigen::Index>(n)];
  }
  return variations;
}

std::optional<std::size_t> RegionSystem::coupling_node(const Values& y) const {
  std::vector<double> felt(nodes(), 0.0);
  each_jacobian(y, true, [&](const Assembly::Local&, Reads read, std::span<const double> J) {
    for (std::size_t i = 0; i < read.size(); ++i)
      for (std::size_t m = 0; m < read.size() && is_solved(read[i]); ++m)
        if (at_boundary(read[m]) && !is_held(read[m])) felt[read[m]] += std::abs(J[i * read.size() + m]);
  });
  const auto most = std::ranges::max_element(felt);
  if (most == felt.end() || *most == 0) return std::nullopt;
  return delf::at(most - felt.begin());
}

template <class Wanted>
std::vector<Balance> RegionSystem::form_sums(const Values& y, std::span<const Pair> pairs, const Wanted& wanted) const {
  std::vector<Balance> balances(pairs.size());
  std::vector<double> v, w;
  each_jacobian(y, true, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    if (!wanted(at.family)) return;
    const std::size_t n = read.size();
    for (std::size_t p = 0; p < pairs.size(); ++p) {
      gather(at, pairs[p].V, v);
      gather(at, pairs[p].W, w);
      for (std::size_t i = 0; i < n; ++i) {
        if (by_forms_) {
          if (at_boundary(read[i])) add_form(balances[p], i, J, v, w);
          continue;
        }
        for (std::size_t m = 0; m < n && is_solved(read[i]); ++m)
          if (at_boundary(read[m])) balances[p].add(J[i * n + m] * (w[m] * v[i] - v[m] * w[i]));
      }
    }
  });
  return balances;
}

std::vector<Balance> RegionSystem::form_formula(const Values& y, std::span<const Pair> pairs) const {
  return form_sums(y, pairs, [](const StencilFamily&) { return true; });
}

std::vector<Balance> RegionSystem::form_without_multipliers(const Values& y, std::span<const Pair> pairs) const {
  return form_sums(y, pairs, [&](const StencilFamily& family) { return !has_multiplier(system_, family); });
}

double RegionSystem::form_error(const Values& y, const Pair& pair, double delta) const {
  double sum = 0;
  each_jacobian(y, true, [&](const Assembly::Local&, Reads read, std::span<const double> J) {
    const auto size = [&](std::size_t i) { return std::abs(pair.V[read[i]]) + std::abs(pair.W[read[i]]); };
    for (std::size_t i = 0; i < read.size(); ++i)
      for (std::size_t m = 0; m < read.size(); ++m)
        if (at_boundary(read[by_forms_ ? i : m])) sum += std::abs(J[i * read.size() + m]) * (size(i) + size(m));
  });
  return delta * sum;
}

RegionSystem::LocalDefect RegionSystem::local_identity(const Values& y, const Pair& pair) const {
  LocalDefect worst;
  std::vector<double> v, w;
  each_jacobian(y, false, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    if (!at.family.is_variational()) return;
    gather(at, pair.V, v);
    gather(at, pair.W, w);
    const std::size_t n = read.size();
    Balance balance;
    for (std::size_t i = 0; i < n; ++i) add_form(balance, i, J, v, w);
    if (balance.relative() <= worst.balance.relative() && worst.balance.count > 0) return;
    worst = {balance, at.anchor.family, at.anchor.site, 0, 0};
    double largest = 0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t m = 0; m < i; ++m)
        if (const double d = std::abs(J[i * n + m] - J[m * n + i]); d > largest)
          largest = d, worst.row = static_cast<int>(i), worst.column = static_cast<int>(m);
  });
  return worst;
}

std::optional<RegionSystem::OneWay> RegionSystem::least_mutual(const Values& y) const {
  std::map<std::pair<std::size_t, std::size_t>, double> entries;
  each_jacobian(y, false, [&](const Assembly::Local&, Reads read, std::span<const double> J) {
    for (std::size_t i = 0; i < read.size(); ++i)
      for (std::size_t m = 0; m < read.size(); ++m)
        if (is_solved(read[i]) && is_solved(read[m])) entries[{read[i], read[m]}] += J[i * read.size() + m];
  });
  std::optional<OneWay> worst;
  double most = 0, largest = 0;
  for (const auto& [at, there] : entries) {
    largest = std::max(largest, std::abs(there));
    const auto other = entries.find({at.second, at.first});
    const double back = other == entries.end() ? 0 : other->second;
    if (std::abs(there - back) <= most) continue;
    most = std::abs(there - back);
    worst = OneWay{node(at.first), node(at.second), there, back};
  }
  return most > 1e-12 * largest ? worst : std::nullopt;
}

std::vector<double> RegionSystem::boundary_terms(const Values& y, const Pair& pair) const {
  std::vector<double> terms(region_->sites().size(), 0.0), v, w;
  const std::size_t C = components_;
  each_jacobian(y, true, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    gather(at, pair.V, v);
    gather(at, pair.W, w);
    for (std::size_t i = 0; i < read.size(); ++i)
      if (at_boundary(read[i])) terms[read[i] / C] += multisymplectic_form(static_cast<int>(i), 1, J, v, w);
  });
  for (double& term : terms) term = std::abs(term);
  return terms;
}

Balance RegionSystem::noether(const Values& y, const LinearSymmetry& symmetry, bool up_to_divergence) const {
  Balance balance;
  std::vector<double> xi;
  // A fixed wall has no equation: what flows into it is not zero where the symmetry moves it, and counts as at ∂U.
  const auto flows = [&](int node) { return at_boundary(node) || held_[node]; };
  assembly_->each_residual(row(y), origin_, [&](const Assembly::Local& at) {
    if (!up_to_divergence && std::ranges::none_of(at.places, flows)) return;
    generator(system_, at.family, symmetry, at.y, xi);
    double change = 0;
    for (std::size_t i = 0; i < at.places.size(); ++i) {
      const double J = momentum_map(static_cast<int>(i), 1, at.derivatives, xi);
      if (flows(at.places[i])) balance.add(J);
      change += J;
    }
    if (up_to_divergence) balance.add(-change);
  });
  return balance;
}

double RegionSystem::rounding(const Values& y, const LinearSymmetry& symmetry) const {
  double products = 0;
  std::vector<double> xi;
  each_jacobian(y, true, [&](const Assembly::Local& at, Reads read, std::span<const double> J) {
    generator(system_, at.family, symmetry, at.y, xi);
    const std::size_t n = read.size();
    for (std::size_t i = 0; i < n; ++i)
      if (at_boundary(read[i]))
        for (std::size_t m = 0; m < n; ++m) products += std::abs(J[i * n + m] * at.y[m] * xi[i]);
  });
  return std::numeric_limits<double>::epsilon() * products;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <memory>
#include <random>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "lattice/region_shapes.hpp"
#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/jet_family.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "schemes/verify/region_system.hpp"
#include "tests/verification/experiment.hpp"

namespace delf::testing {

using Family = std::shared_ptr<const StencilFamily>;
using FamilyList = std::vector<Family>;

inline Family make_family(const std::string& theory, const SchemeName& scheme) {
  for (const TheoryEntry* entry : theory_entries())
    if (theory == entry->name) {
      const auto made = make_theory(*entry);
      return scheme.method == "multisymplectic" ? made->variational(scheme.stencil)
                                                : made->comparator(scheme.method == "guo"          ? guo()
                                                                   : scheme.method == "vu-quoc-li" ? vu_quoc_li()
                                                                                                   : damped_leapfrog());
    }
  throw std::invalid_argument(theory);
}

/// A density on any table.
template <Density D>
Family jet_family(StencilTable table, const D& density) {
  return std::make_shared<JetFamily>(std::move(table), std::make_shared<BatchOf<D>>(density));
}

inline std::vector<StencilPattern> patterns(const FamilyList& families) {
  std::vector<StencilPattern> result;
  for (const Family& family : families) result.push_back(family->pattern());
  return result;
}

inline RegionSystem::Values random_values(std::mt19937_64& random, std::size_t size) {
  RegionSystem::Values values(size);
  for (double& value : values) value = std::normal_distribution<double>{}(random);
  return values;
}

/// Sites of four rows and the five columns from `first` on, each of `nodes` nodes of their cells: regions around them
/// have holes, steps and islands.
inline std::vector<Site> random_centres(std::mt19937_64& random, int first, int nodes = 1) {
  std::vector<Site> centres{{2, first + 2}};
  for (int time = 0; time < 4; ++time)
    for (int space = first; space < first + 5; ++space)
      for (int node = 0; node < nodes; ++node)
        if (random() % 2) centres.push_back({time, space, node});
  return centres;
}
/// Across the seam of a circle or at the left wall of an interval.
inline int seam_or_wall(const Lattice& lattice) { return lattice.is_circle() ? lattice.sites() - 3 : 0; }

/// A section of some families on a region.
struct Patch {
  Patch(FamilyList families, double h, const Region& region)
      : system(std::make_shared<const LatticeSystem>(region.lattice(), std::move(families), h)),
        on(*system, region),
        y(on.nodes()) {}
  /// Around some centres.
  Patch(const Lattice& lattice, const FamilyList& families, double h, const std::vector<Site>& centres)
      : Patch(families, h, region_around(lattice, patterns(families), centres)) {}

  std::shared_ptr<const LatticeSystem> system;
  RegionSystem on;
  RegionSystem::Values y;

  const Region& U() const { return on.region(); }
  RegionSystem::Pair variations(std::mt19937_64& random) const {
    auto drawn = on.first_variations(y, 2, random);
    return {std::move(drawn[0]), std::move(drawn[1])};
  }
  Balance form_formula(const RegionSystem::Pair& pair) const { return on.form_formula(y, {&pair, 1}).front(); }
};

/// One field, and the sums of the papers over a set U of sites by plain loops over their definitions, with nothing of
/// the library but the residual of one stencil and its Jacobian: what the library has to agree with. Values are in the
/// order of the sites.
class ByHand {
 public:
  ByHand(const Lattice& lattice, Family family, double h, const std::vector<Site>& U, const std::vector<double>& y)
      : family_(std::move(family)), n_(at(family_->size())) {
    for (const Site site : std::set<Site>(U.begin(), U.end())) place_.emplace(site, place_.size());
    const Cell cell{h, lattice.space_step(), 0, 0};
    const int N = lattice.sites(), first = place_.begin()->first.time, last = place_.rbegin()->first.time;
    std::set<std::size_t> touched, missed;  // by a stencil; by one that is not in U
    for (int j = first - 2; j <= last + 2; ++j)
      for (int i = lattice.is_circle() ? 0 : -2; i < (lattice.is_circle() ? N : N + 2); ++i) {
        if (family_->pattern().placement == Placement::brick_wall && ((i + j) & 1)) continue;
        bool in_lattice = true, in_U = true;
        std::vector<std::size_t> sites;
        for (const Site v : family_->pattern().vertices) {
          Site site{j + v.time, i + v.space};
          if (lattice.is_circle()) site.space = (site.space + N) % N;
          in_lattice = in_lattice && site.space >= 0 && site.space < N;
          if (place_.contains(site)) sites.push_back(place_.at(site));
          else in_U = false;
        }
        if (!in_lattice) continue;
        (in_U ? touched : missed).insert(sites.begin(), sites.end());
        if (!in_U) continue;
        Term term{sites, {}, std::vector<double>(n_), std::vector<double>(n_ * n_)};
        for (const std::size_t site : sites) term.y.push_back(y[site]);
        family_->residual(cell, term.y, term.r);
        family_->jacobian(cell, term.y, term.J);
        terms_.push_back(term);
      }
    for (const auto& [site, a] : place_)
      if (touched.contains(a) && !missed.contains(a)) interior_.insert(a);
    for (const Term& term : terms_)
      for (const std::size_t b : term.sites)
        if (interior_.contains(b))
          for (const std::size_t a : term.sites)
            if (!interior_.contains(a)) boundary_.insert(a);
  }

  std::size_t index(Site site) const { return place_.at(site); }
  const std::set<std::size_t>& interior() const { return interior_; }
  const std::set<std::size_t>& boundary() const { return boundary_; }

  /// E_b = Σ_{l: Δˡ = b} rˡ for b in int U                                                               (5.2)
  Eigen::VectorXd equations() const {
    Eigen::VectorXd E = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(place_.size()));
    for (const Term& term : terms_)
      for (std::size_t l = 0; l < n_; ++l)
        if (interior_.contains(term.sites[l])) E[row(term.sites[l])] += term.r[l];
    return E;
  }
  /// ∂E_b/∂y_a for b in int U, a in U; the rows of all other b are zero.
  Eigen::MatrixXd linearised() const {
    const auto size = static_cast<Eigen::Index>(place_.size());
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(size, size);
    for (const Term& term : terms_)
      for (std::size_t l = 0; l < n_; ++l)
        for (std::size_t m = 0; m < n_ && interior_.contains(term.sites[l]); ++m)
          M(row(term.sites[l]), row(term.sites[m])) += term.J[l * n_ + m];
    return M;
  }

  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Ωˡ(V, W),  Ωˡ(V, W) = −Σ_m ∂²L/∂yˡ∂yᵐ (Vᵐ Wˡ − Wᵐ Vˡ)             (5.6)
  double form_formula(const std::vector<double>& V, const std::vector<double>& W) const {
    double sum = 0;
    for (const Term& term : terms_)
      for (std::size_t l = 0; l < n_; ++l)
        for (std::size_t m = 0; m < n_ && boundary_.contains(term.sites[l]); ++m) {
          const std::size_t a = term.sites[l], c = term.sites[m];
          sum -= term.J[l * n_ + m] * (V[c] * W[a] - W[c] * V[a]);
        }
    return sum;
  }
  /// The same from equations alone, so that those without a Lagrangian can be asked too:
  /// Σ_{b ∈ int U, a ∈ ∂U} ∂E_b/∂y_a (W_a V_b − V_a W_b)
  double defect(const std::vector<double>& V, const std::vector<double>& W) const {
    const Eigen::MatrixXd M = linearised();
    double sum = 0;
    for (const std::size_t b : interior_)
      for (const std::size_t a : boundary_) sum += M(row(b), row(a)) * (W[a] * V[b] - V[a] * W[b]);
    return sum;
  }
  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Jˡ(ξ),  Jˡ(ξ) = ∂L/∂yˡ ξ(yˡ),  for ξ(y) = slope · y + shift         (5.7)
  double noether(double slope, double shift) const {
    double sum = 0;
    for (const Term& term : terms_)
      for (std::size_t l = 0; l < n_; ++l)
        if (boundary_.contains(term.sites[l])) sum += term.r[l] * (slope * term.y[l] + shift);
    return sum;
  }

 private:
  struct Term {
    std::vector<std::size_t> sites;
    std::vector<double> y, r, J;
  };
  static Eigen::Index row(std::size_t n) { return static_cast<Eigen::Index>(n); }

  Family family_;
  std::size_t n_;
  std::map<Site, std::size_t> place_;
  std::vector<Term> terms_;
  std::set<std::size_t> interior_, boundary_;
};
inline ByHand by_hand(const Patch& patch) {
  const LatticeSystem& system = *patch.system;
  return {system.lattice(), system.families().front(), system.time_step(), patch.U().sites(), patch.y};
}

}  // namespace delf::testing

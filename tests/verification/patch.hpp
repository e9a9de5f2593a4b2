// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

#include "jets/forms.hpp"
#include "lattice/region.hpp"
#include "schemes/field_theory.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theory_registry.hpp"
#include "tests/verification/experiment.hpp"

namespace delf::testing {

using Family = std::shared_ptr<const StencilFamily>;

inline Family make_family(const std::string& theory, const SchemeName& scheme, double h, double k) {
  for (const TheoryEntry* entry : theory_entries())
    if (theory == entry->name) {
      const auto made = entry->make(Problem{});
      return scheme.method == "multisymplectic" ? made->variational(scheme.stencil, h, k)
                                                : made->comparator(scheme.method, h, k);
    }
  throw std::invalid_argument(theory);
}

inline Eigen::VectorXd random_vector(std::mt19937& random, Eigen::Index size) {
  return Eigen::VectorXd::NullaryExpr(size, [&] { return std::normal_distribution<double>{}(random); });
}

/// What a sum left, beside the sum of its absolute values.
struct Balance {
  double sum = 0, absolute = 0;

  void add(double term) { sum += term, absolute += std::abs(term); }
  double relative() const { return std::abs(sum) / absolute; }
};

/// U = all stencils that touch some random sites of a small window, so that U is regular: a region with holes, steps
/// and islands, across the seam of a circle or at the left wall of an interval.
inline Region random_region(std::mt19937& random, const Lattice& lattice, const StencilPattern& pattern) {
  const int first = lattice.is_circle() ? lattice.sites() - 3 : 0;
  std::vector<Site> centres{{2, first + 2}};
  for (int time = 0; time < 4; ++time)
    for (int space = first; space < first + 5; ++space)
      if (random() % 2) centres.push_back({time, space});
  const Region around = Region::from_sites(lattice, {pattern}, centres);
  std::vector<Site> sites;
  for (const Site centre : around.sites())
    for (const Stencil& s : around.touching(centre)) sites.insert(sites.end(), s.sites.begin(), s.sites.end());
  return Region::from_sites(lattice, {pattern}, sites);
}

/// A field on a region U, with its equations on int U. Fields and variations are vectors over the sites of U.
class Patch {
 public:
  Patch(Region region, Family family, double time_step)
      : U(std::move(region)), family_(std::move(family)), cell_{time_step, U.lattice().space_step(), 0, 0} {
    for (const Site site : U.sites()) index_.emplace(site, static_cast<Eigen::Index>(index_.size()));
    y = Eigen::VectorXd::Zero(size());
  }

  Region U;
  Eigen::VectorXd y;

  Eigen::Index size() const { return static_cast<Eigen::Index>(index_.size()); }
  Eigen::Index index(Site site) const { return index_.at(site); }

  std::vector<double> on(const Stencil& stencil, const Eigen::VectorXd& values) const {
    std::vector<double> result;
    for (const Site site : stencil.sites) result.push_back(values[index(site)]);
    return result;
  }
  std::vector<double> residual(const Stencil& stencil) const {
    std::vector<double> r(stencil.sites.size());
    family_->residual(cell_, on(stencil, y), r);
    return r;
  }
  std::vector<double> jacobian(const Stencil& stencil) const {
    std::vector<double> J(stencil.sites.size() * stencil.sites.size());
    family_->jacobian(cell_, on(stencil, y), J);
    return J;
  }

  /// E_b = Σ_{l: Δˡ = b} rˡ for b in int U                                                               (5.2)
  Eigen::VectorXd equations() const {
    Eigen::VectorXd E = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(U.interior().size()));
    for (Eigen::Index b = 0; b < E.size(); ++b)
      for (const Stencil& stencil : U.touching(U.interior()[static_cast<std::size_t>(b)]))
        for (int l = 0; l < stencil.size(); ++l)
          if (stencil.vertex(l) == U.interior()[static_cast<std::size_t>(b)])
            E[b] += residual(stencil)[static_cast<std::size_t>(l)];
    return E;
  }
  /// ∂E_b/∂y_a for b in int U, a in U
  Eigen::MatrixXd linearised() const {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(U.interior().size()), size());
    for (Eigen::Index b = 0; b < M.rows(); ++b)
      for (const Stencil& stencil : U.touching(U.interior()[static_cast<std::size_t>(b)])) {
        const auto J = jacobian(stencil);
        for (int l = 0; l < stencil.size(); ++l)
          for (int m = 0; m < stencil.size(); ++m)
            if (stencil.vertex(l) == U.interior()[static_cast<std::size_t>(b)])
              M(b, index(stencil.vertex(m))) += J[static_cast<std::size_t>(l * stencil.size() + m)];
      }
    return M;
  }
  /// A random solution of the linearised equations on int U.
  Eigen::VectorXd first_variation(std::mt19937& random) const {
    const Eigen::MatrixXd M = linearised();
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(M);
    Eigen::VectorXd V = random_vector(random, size());
    for (int refine = 0; refine < 3; ++refine) V -= solver.solve(M * V);
    return V;
  }
  /// Newton's method on int U, from where y is to the nearest solution.
  void solve() {
    for (int n = 0; n < 30; ++n) {
      const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(linearised());
      y -= solver.solve(equations());
    }
  }

  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Ωˡ(V, W)                                                       (5.6)
  Balance form_formula(const Eigen::VectorXd& V, const Eigen::VectorXd& W) const {
    Balance balance;
    for (const Stencil& stencil : U.boundary_stencils()) {
      const auto J = jacobian(stencil), v = on(stencil, V), w = on(stencil, W);
      for (int l = 0; l < stencil.size(); ++l)
        if (U.in_boundary(stencil.vertex(l))) balance.add(multisymplectic_form(l, 1, J, v, w));
    }
    return balance;
  }
  /// The same from equations alone, so that those without a Lagrangian can be asked too:
  /// Σ_{b ∈ int U, a ∈ ∂U} (∂E_b/∂y_a)(W_a V_b − V_a W_b)
  Balance defect(const Eigen::VectorXd& V, const Eigen::VectorXd& W) const {
    Balance balance;
    const Eigen::MatrixXd M = linearised();
    for (Eigen::Index n = 0; n < M.rows(); ++n) {
      const Eigen::Index b = index(U.interior()[static_cast<std::size_t>(n)]);
      for (const Site site : U.boundary()) {
        const Eigen::Index a = index(site);
        if (M(n, a) != 0) balance.add(M(n, a) * (W[a] * V[b] - V[a] * W[b]));
      }
    }
    return balance;
  }
  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{l: Δˡ ∈ ∂U} Jˡ(ξ) for φ → φ + ε                                             (5.7)
  Balance noether() const {
    Balance balance;
    for (const Stencil& stencil : U.boundary_stencils()) {
      const auto r = residual(stencil);
      const std::vector<double> xi(r.size(), 1.0);
      for (int l = 0; l < stencil.size(); ++l)
        if (U.in_boundary(stencil.vertex(l))) balance.add(momentum_map(l, 1, r, xi));
    }
    return balance;
  }

 private:
  Family family_;
  Cell cell_;
  std::map<Site, Eigen::Index> index_;
};

}  // namespace delf::testing

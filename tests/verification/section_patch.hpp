// SPDX-License-Identifier: MIT
#pragma once
#include <Eigen/Dense>
#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "jets/forms.hpp"
#include "lattice/region.hpp"
#include "lattice/solve_plan.hpp"
#include "schemes/stencil_family.hpp"
#include "tests/verification/patch.hpp"

namespace delf::testing {

using FamilyList = std::vector<Family>;

inline std::vector<StencilPattern> patterns_of(const FamilyList& families) {
  std::vector<StencilPattern> patterns;
  for (const Family& family : families) patterns.push_back(family->pattern());
  return patterns;
}

/// The union of all stencils that touch one of the sites: they are interior to it, and it is regular.
inline Region region_around(const Lattice& lattice, const FamilyList& families, const std::vector<Site>& centres) {
  const Stencils all(lattice, patterns_of(families));
  std::vector<Site> sites;
  for (const Site centre : centres)
    for (const Stencil& s : all.touching(centre)) sites.insert(sites.end(), s.sites.begin(), s.sites.end());
  return Region::from_sites(lattice, patterns_of(families), sites);
}

/// Around random sites of four rows and the five columns from `first` on, each of `nodes` nodes of their cells.
inline Region random_region(std::mt19937& random, const Lattice& lattice, const FamilyList& families, int first,
                            int nodes = 1) {
  std::vector<Site> centres{{2, first + 2}};
  for (int time = 0; time < 4; ++time)
    for (int space = first; space < first + 5; ++space)
      for (int node = 0; node < nodes; ++node)
        if (random() % 2) centres.push_back({time, space, node});
  return region_around(lattice, families, centres);
}

/// A section of several components on a region U of some stencil families, with its equations at all nodes of int U. A
/// node is a component at a site that some stencil in U reads; sections and variations are vectors over the nodes.
class SectionPatch {
 public:
  SectionPatch(Region region, FamilyList families, double time_step)
      : U(std::move(region)), families_(std::move(families)), time_step_(time_step), stencils_(U.stencils()) {
    for (const Stencil& stencil : stencils_)
      for (int i = 0; i < family(stencil).size(); ++i) index_.emplace(node(stencil, i), 0);
    for (auto& [node, n] : index_) {
      n = static_cast<Eigen::Index>(nodes_.size());
      nodes_.push_back(node);
      if (U.in_interior(node.site)) equation_.emplace(n, static_cast<Eigen::Index>(equation_.size()));
    }
    y = Eigen::VectorXd::Zero(size());
  }

  Region U;
  Eigen::VectorXd y;

  Eigen::Index size() const { return static_cast<Eigen::Index>(nodes_.size()); }
  Eigen::Index equations() const { return static_cast<Eigen::Index>(equation_.size()); }
  const std::vector<Node>& nodes() const { return nodes_; }

  /// ∂E_b/∂y_a for nodes b in int U and a in U
  Eigen::MatrixXd linearised() const {
    Eigen::MatrixXd M = Eigen::MatrixXd::Zero(equations(), size());
    for (const Stencil& stencil : stencils_) {
      const auto J = jacobian(stencil);
      const int n = family(stencil).size();
      for (int i = 0; i < n; ++i) {
        const auto row = equation_.find(index(stencil, i));
        if (row == equation_.end()) continue;
        for (int m = 0; m < n; ++m) M(row->second, index(stencil, m)) += J[static_cast<std::size_t>(i * n + m)];
      }
    }
    return M;
  }
  /// A random solution of the linearised equations at the nodes of int U.
  Eigen::VectorXd first_variation(std::mt19937& random) const {
    const Eigen::MatrixXd M = linearised();
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver(M);
    Eigen::VectorXd V = random_vector(random, size());
    for (int refine = 0; refine < 3; ++refine) V -= solver.solve(M * V);
    return V;
  }
  /// The node of ∂U that the equations of int U feel most.
  std::optional<Eigen::Index> coupling_node() const {
    const Eigen::MatrixXd M = linearised();
    std::optional<Eigen::Index> best;
    for (Eigen::Index a = 0; a < size(); ++a)
      if (U.in_boundary(nodes_[static_cast<std::size_t>(a)].site) && !M.col(a).isZero() &&
          (!best || M.col(a).norm() > M.col(*best).norm()))
        best = a;
    return best;
  }

  /// Σ_{Δ ⊂ U, Δ ∩ ∂U ≠ ∅} Σ_{i: site of yⁱ in ∂U} Ωⁱ(V, W)                                              (5.6)
  Balance form_formula(const Eigen::VectorXd& V, const Eigen::VectorXd& W) const {
    Balance balance;
    for (const Stencil& stencil : U.boundary_stencils()) {
      const auto J = jacobian(stencil), v = on(stencil, V), w = on(stencil, W);
      for (int i = 0; i < family(stencil).size(); ++i)
        if (U.in_boundary(node(stencil, i).site)) balance.add(multisymplectic_form(i, 1, J, v, w));
    }
    return balance;
  }

 private:
  const StencilFamily& family(const Stencil& stencil) const {
    return *families_[static_cast<std::size_t>(stencil.family)];
  }
  Node node(const Stencil& stencil, int i) const {
    const VertexValue value = family(stencil).values()[static_cast<std::size_t>(i)];
    return {stencil.vertex(value.vertex), value.component};
  }
  Eigen::Index index(const Stencil& stencil, int i) const { return index_.at(node(stencil, i)); }
  std::vector<double> on(const Stencil& stencil, const Eigen::VectorXd& values) const {
    std::vector<double> result;
    for (int i = 0; i < family(stencil).size(); ++i) result.push_back(values[index(stencil, i)]);
    return result;
  }
  std::vector<double> jacobian(const Stencil& stencil) const {
    const auto y_here = on(stencil, y);
    std::vector<double> J(y_here.size() * y_here.size());
    const Cell cell{time_step_, U.lattice().space_step(), stencil.anchor.time * time_step_,
                    U.lattice().position(stencil.anchor.space)};
    family(stencil).jacobian(cell, y_here, J);
    return J;
  }

  FamilyList families_;
  double time_step_;
  std::vector<Stencil> stencils_;
  std::map<Node, Eigen::Index> index_;
  std::vector<Node> nodes_;
  std::map<Eigen::Index, Eigen::Index> equation_;  ///< of a node of int U
};

}  // namespace delf::testing

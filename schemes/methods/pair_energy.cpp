// SPDX-License-Identifier: MIT
#include <Eigen/LU>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <vector>

#include "jets/tables/pair_element.hpp"
#include "schemes/methods/own_energy.hpp"
#include "schemes/methods/pair_parts.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/turn.hpp"

namespace delf {
namespace {

constexpr std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr const char* formula =
    "H(q, p) = p'p/2km - k sum l(q, 0, D), on the pairs of the scheme's own order, p of its own Legendre transform: "
    "kept to the order of the steps";

/// hk Σ ℓ(φ, 0, φ_x) of one row, over the points of the table of space, at walls too.
class RowAction {
 public:
  RowAction(const FieldTheory& theory, const Lattice& lattice, const StencilTable& space)
      : families_{theory.on_table(space)} {
    for (StencilTable& at_wall : at_both_walls(space, lattice))
      families_.push_back(theory.on_table(std::move(at_wall)));
  }

  double operator()(const RowsInTime& rows) const {
    const Lattice& lattice = rows.system.lattice();
    const double h = rows.time_step;
    double sum = 0;
    for (const auto& family : families_) {
      std::vector<int> cells;
      for (int i = 0; i < lattice.sites(); ++i)
        if (rows.system.has_stencil(*family, rows.newest, i)) cells.push_back(i);
      if (cells.empty()) continue;
      const int n = static_cast<int>(cells.size()), packs = (n + lanes - 1) / lanes, padded = packs * lanes;
      std::vector<Pack> y(at(packs * family->size())), x(at(packs)), L(at(packs));
      auto *values = reinterpret_cast<double*>(y.data()), *places = reinterpret_cast<double*>(x.data());
      for (int s = 0; s < padded; ++s) {
        const int cell = cells[at(std::min(s, n - 1))];  // the last pack is filled up
        places[s] = lattice.position(cell);
        for (int m = 0; m < family->size(); ++m)
          values[m * padded + s] =
              rows.rows(rows.newest, cell + family->site(m).space, family->values()[at(m)].component);
      }
      const Cell cell{h, lattice.space_step(), static_cast<double>(rows.newest) * h, 0};
      family->lagrangian({cell, padded, places, values}, reinterpret_cast<double*>(L.data()));
      for (int s = 0; s < n; ++s) sum += reinterpret_cast<const double*>(L.data())[s];
    }
    return sum;
  }

 private:
  std::vector<std::shared_ptr<const StencilFamily>> families_;
};

/// The momenta ∂L/∂y at a row, of the stencils below it.
class MomentaBelow {
 public:
  MomentaBelow(const LatticeSystem& system, double turn) : assembly_(system, parts(system, turn)) {}

  std::vector<double> operator()(const RowsInTime& rows) const {
    std::vector<double> p;
    assembly_.residual(SectionRing(rows.rows, rows.newest - 1, rows.newest), rows.newest, p);
    return p;
  }

 private:
  static Assembly::Parts parts(const LatticeSystem& system, double turn) {
    const int N = system.lattice().sites();
    std::vector<Assembly::Anchor> below;
    for (std::size_t f = 0; f < system.families().size(); ++f)
      for (int i = 0; i < N; ++i)
        if (system.has_stencil(*system.families()[f], -1, i)) below.push_back({static_cast<int>(f), {-1, i}});
    Assembly::Parts parts{.equations = {}, .past = 1, .turn = turn, .stencils = below};
    for (int i = 0; i < N; ++i)
      for (int c = 0; c < system.fields(); ++c) parts.equations.push_back({{0, i}, c});
    return parts;
  }
  Assembly assembly_;
};

/// Kinetic energy is ½ φ_tᵀ M φ_t with a constant M: φ_t stands in no other term.
bool is_plainly_kinetic(const BatchDensity& density) {
  const int d = density.components();
  for (int a = 0; a < d; ++a) {
    if (density.constant_gradient()[at(d + a)] != 0) return false;
    for (int b = 0; b < density.variables(); ++b) {
      const bool kinetic = b >= d && b < 2 * d;
      if (kinetic ? !density.is_constant(d + a, b) : !density.is_zero(d + a, b)) return false;
    }
  }
  return true;
}

/// H = Σ_i pᵢᵀ M⁻¹ pᵢ/(2 k wᵢ) − k Σ ℓ(φ, 0, D_m)
///
/// over the pairs of the scheme itself, with the momenta of its own discrete Legendre transform; wᵢ = ½ at a natural wall.
std::optional<OwnEnergy> make(const FieldTheory& theory, const LatticeSystem& system, const Problem& p) {
  const BatchDensity& density = theory.density();
  if (p.lattice.space() == Space::point)
    return OwnEnergy{"H(q, p) of the composition", formula, false,
                     [momenta = std::make_shared<const MomentaBelow>(system, turn_of(p))](const RowsInTime& rows) {
                       std::vector<double> q;
                       for (int a = 0; a < rows.theory.components(); ++a) q.push_back(rows.rows(rows.newest, 0, a));
                       std::vector<double> below = (*momenta)(rows);
                       below.resize(q.size());  // the rows between sub-steps have none
                       return hamiltonian(rows.theory.density(), q, below,
                                          static_cast<double>(rows.newest) * rows.time_step);
                     }};
  if (!is_plainly_kinetic(density)) return std::nullopt;
  const int d = density.components();
  Eigen::MatrixXd M(d, d);
  for (int a = 0; a < d; ++a)
    for (int b = 0; b < d; ++b) M(a, b) = density.constant_hessian()[at((d + a) * density.variables() + d + b)];
  const Eigen::MatrixXd inverse = M.inverse();
  const int order = space_order_of(p);
  const auto action = std::make_shared<const RowAction>(
      theory, system.lattice(), pair_space(pair_weights(pairs_of_order(p, "lattice.space_order", order))));
  const auto momenta = std::make_shared<const MomentaBelow>(system, turn_of(p));
  return OwnEnergy{"H(q, p) of the composition", formula, false, [=](const RowsInTime& rows) {
                     const Lattice& lattice = rows.system.lattice();
                     const std::vector<double> below = (*momenta)(rows);
                     double kinetic = 0;
                     for (int i = 0; i < lattice.sites(); ++i) {
                       if (lattice.is_fixed(i)) continue;
                       const bool end = lattice.space() == Space::interval && (i == 0 || i == lattice.sites() - 1);
                       const Eigen::Map<const Eigen::VectorXd> one(&below[at(i * d)], d);
                       kinetic += one.dot(inverse * one) / (2 * lattice.space_step() * (end ? 0.5 : 1));
                     }
                     return kinetic - (*action)(rows) / rows.time_step;
                   }};
}

}  // namespace

extern const OwnEnergyEntry composition_energy;
const OwnEnergyEntry composition_energy{"composition", formula, make};

}  // namespace delf

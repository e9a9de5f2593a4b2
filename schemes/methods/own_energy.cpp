// SPDX-License-Identifier: MIT
#include "schemes/methods/own_energy.hpp"

#include <Eigen/SparseCore>
#include <algorithm>
#include <limits>
#include <memory>
#include <vector>

#include "schemes/stepping/evolution.hpp"
#include "schemes/system/assembly.hpp"
#include "schemes/turn.hpp"

namespace delf {
namespace {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

/// The equations of a row, A y₊ + B y + Aᵀ y₋ + c.
struct LinearRow {
  Sparse A, B;
  Vector c;
};

bool is_linear(const LatticeSystem& system) {
  return std::ranges::all_of(system.families(), [&](const auto& family) {
    const auto part = family->constant_part({system.time_step(), system.lattice().space_step(), 0, 0});
    return part && part->is_all && !family->is_placed();
  });
}

std::optional<LinearRow> linear_row(const LatticeSystem& system) {
  const int size = system.lattice().sites() * system.components();
  Assembly::Parts parts{.equations = {}, .parity = 0, .past = 1, .future = 1};
  for (int dt : {0, 1})
    for (int i = 0; i < system.lattice().sites(); ++i)
      for (int c = 0; c < system.components(); ++c) {
        if (dt == 0) parts.equations.push_back({{0, i}, c});
        parts.unknowns.push_back({{dt, i}, c});
      }
  const Assembly assembly(system, parts);
  std::vector<double> values;
  if (!assembly.constant_jacobian(values)) return std::nullopt;
  std::vector<Eigen::Triplet<double>> above, here;
  for (std::size_t n = 0; n < values.size(); ++n) {
    const auto [equation, unknown] = assembly.places()[n];
    if (unknown < size) here.emplace_back(equation, unknown, values[n]);
    else above.emplace_back(equation, unknown - size, values[n]);
  }
  LinearRow row{Sparse(size, size), Sparse(size, size), {}};
  row.A.setFromTriplets(above.begin(), above.end());
  row.B.setFromTriplets(here.begin(), here.end());
  std::vector<double> at_zero;
  assembly.residual(SectionRing(3, static_cast<std::size_t>(size)), 0, at_zero);
  row.c = Eigen::Map<const Vector>(at_zero.data(), size);
  return row;
}

}  // namespace

std::optional<OwnEnergy> quadratic_invariant(const LatticeSystem& system, int winding) {
  const auto is_field = [](const Component& c) { return c.role == Role::field && !c.position; };
  if (winding != 0 || system.height() != 1 || system.placement() != Placement::every_site || !is_variational(system) ||
      !std::ranges::all_of(system.all_components(), is_field) || !is_linear(system))
    return std::nullopt;
  const auto row = linear_row(system);
  if (!row) return std::nullopt;
  const double h = system.time_step();
  const Sparse twice = row->A + Sparse(row->A.transpose());  // 2Aₛ
  const auto of_steps = std::make_shared<const Sparse>((row->B - twice) / (8 * h)),
             of_means = std::make_shared<const Sparse>((row->B + twice) / (-2 * h));
  const auto force = std::make_shared<const Vector>(row->c / -h);
  return OwnEnergy{"quadratic invariant", quadratic_invariant_formula, true, [=](const RowsInTime& rows) {
                     const std::vector<double>&before = rows.rows.rows.front(), &newest = rows.rows.rows.back();
                     const auto size = static_cast<Eigen::Index>(newest.size());
                     const Eigen::Map<const Vector> below(before.data(), size), above(newest.data(), size);
                     const Vector v = above - below, mean = 0.5 * (above + below);
                     return v.dot(*of_steps * v) + mean.dot(*of_means * mean) + force->dot(mean);
                   }};
}

extern const OwnEnergyEntry vu_quoc_li_energy, guo_energy, composition_energy;
const std::vector<const OwnEnergyEntry*>& own_energy_entries() {
  static const std::vector<const OwnEnergyEntry*> all{&vu_quoc_li_energy, &guo_energy, &composition_energy};
  return all;
}

std::optional<OwnEnergy> own_energy(const Simulation& simulation, const Problem& given) {
  const Problem problem = completed(given);
  const LatticeSystem& system = simulation.evolution().system();
  if (system.moves() || simulation.is_processed()) return std::nullopt;
  for (const OwnEnergyEntry* entry : own_energy_entries())
    if (entry->method == problem.method)
      if (auto own = entry->make(simulation.theory(), system, problem)) return own;
  if (find_method(problem.method).energy || gain_of(problem.parameters) != 0) return std::nullopt;
  return quadratic_invariant(system, problem.winding);
}

double newest_own_energy(const OwnEnergy& own, const Simulation& simulation) {
  const LatticeSystem& system = simulation.evolution().system();
  const Stepper& stepper = simulation.evolution().stepper();
  if (stepper.newest() < 1) return std::numeric_limits<double>::quiet_NaN();
  return own.value({simulation.theory(), system, stepper.window(2), stepper.newest(), system.time_step()});
}

}  // namespace delf

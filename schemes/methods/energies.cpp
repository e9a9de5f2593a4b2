// SPDX-License-Identifier: MIT
#include "schemes/methods/energies.hpp"

#include <cstddef>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "lattice/index.hpp"
#include "schemes/driven_ends.hpp"
#include "schemes/methods/element_parts.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/stepping/evolution.hpp"
#include "schemes/system/legendre.hpp"
#include "schemes/system/momenta.hpp"

namespace delf {
namespace {

/// Momenta ∂L/∂y of a row, of the stencils below it. Of the system at hand: one that a check plants faults in has families
/// that do not say what they are made of.
std::shared_ptr<const HalfEquations> momenta_below(const LatticeSystem& system, const Problem& problem) {
  return std::make_shared<const HalfEquations>(system, Side::below, monodromy_of(problem));
}

}  // namespace

extern const EnergyEntry rectangle_energy, midway_energy, quadratic_invariant, vu_quoc_li_energy, guo_energy,
    composition_energy;

const EnergyEntry rectangle_energy{"jets of the symmetric rectangle", energy_formula,
                                   "Marsden-Patrick-Shkoller, footnote 4, of any density", ""};
const EnergyEntry midway_energy{
    "the midpoint of two rows",
    "q_t ∂ℓ/∂q_t − ℓ, midway between the last two rows, q_t = (q⁺ − q)/h, whatever the scheme; order 2 in h",
    "the same on one site", ""};
const EnergyEntry hamiltonian_of_row{
    "H of a row", "H of the last row, with the momenta and the quadrature of scheme.method = {} itself",
    "discrete Legendre transform, Marsden-West 1.5", "",
    [](const FieldTheory&, const LatticeSystem& system, const Problem& problem) -> EnergyOfRows {
      return [momenta = momenta_below(system, problem)](const RowsInTime& rows) {
        return LegendreTransform(rows.system, rows.rows, rows.newest)
            .energy((*momenta)(with_low_parts(rows.rows), rows.newest));
      };
    }};
const EnergyEntry composition_energy{
    "H(q, p) of the composition",
    "H(q, p) = p'p/2km - k sum l(q, 0, D), on the pairs of the scheme's own order, p of its own Legendre transform: "
    "kept to the order of the steps",
    "discrete Legendre transform, Marsden-West 1.5", "composition",
    [](const FieldTheory&, const LatticeSystem& system, const Problem& problem) -> EnergyOfRows {
      return [&system, momenta = momenta_below(system, problem)](const RowsInTime& rows) {
        return LegendreTransform(system, rows.rows, rows.newest).energy((*momenta)(rows.rows, rows.newest));
      };
    }};

const std::vector<const EnergyEntry*>& energy_entries() {
  static const std::vector<const EnergyEntry*> all{&rectangle_energy,    &midway_energy,     &hamiltonian_of_row,
                                                   &quadratic_invariant, &vu_quoc_li_energy, &guo_energy,
                                                   &composition_energy};
  return all;
}

const EnergyEntry& energy_of_run(const Problem& problem) {
  const MethodEntry& method = find_method(problem.method);
  if (method.energy) return *method.energy;
  // The work of driven ends on sub-steps is known up to a row.
  if (method.own_energy == &composition_energy && !key_of_driven_end(problem).empty()) return *method.own_energy;
  return problem.lattice.space() == Space::point ? midway_energy : rectangle_energy;
}

std::optional<OwnEnergy> own_energy(const Simulation& simulation, const Problem& given) {
  const Problem problem = completed(given);
  const LatticeSystem& system = simulation.evolution().system();
  if (system.moves() || simulation.is_processed()) return std::nullopt;
  const MethodEntry& method = find_method(problem.method);
  const bool any = !method.energy && gain_of(problem.parameters) == 0;
  for (const EnergyEntry* entry : {method.own_energy, any ? &quadratic_invariant : nullptr})
    if (entry)
      if (EnergyOfRows value = entry->make(simulation.theory(), system, problem)) return OwnEnergy{entry, value};
  return std::nullopt;
}

double newest_own_energy(const OwnEnergy& own, const Simulation& simulation) {
  const LatticeSystem& system = simulation.evolution().system();
  const Stepper& stepper = simulation.evolution().stepper();
  if (stepper.newest() < 1) return std::numeric_limits<double>::quiet_NaN();
  return own.value({simulation.theory(), system, stepper.window(2), stepper.newest(), system.time_step()}).energy;
}

}  // namespace delf

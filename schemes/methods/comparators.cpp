// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "lattice/error.hpp"
#include "schemes/families/damped_leapfrog.hpp"
#include "schemes/families/guo.hpp"
#include "schemes/families/vu_quoc_li.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

/// ℓ = Σ_a ½(φ_tᵃ)² − ½(φ_xᵃ)² + N(φ), by its Hessian: the equations of comparators are written for no other.
bool is_of_plain_waves(const BatchDensity& density) {
  const int d = density.components(), m = density.variables();
  for (int i = d; i < m; ++i)
    for (int j = 0; j < m; ++j) {
      const double wanted = i != j ? 0 : i < 2 * d ? 1 : i < 3 * d ? -1 : 0;
      const double given = density.constant_hessian()[i * m + j];
      if (!density.is_constant(i, j) || std::abs(given - wanted) > 1e-12) return false;
    }
  return true;
}

SchemeParts comparator_parts(const FieldTheory& theory, const Problem& p, DirectResidual stencil) {
  auto family = theory.comparator(std::move(stencil));
  if (!family)
    throw BadInput("scheme.method", fmt::format("scheme.method = {}: not written for theory.name = {}, whose potential "
                                                "depends on more than the field; use scheme.method = multisymplectic",
                                                p.method, p.theory));
  if (!is_of_plain_waves(theory.density()))
    throw BadInput(
        "scheme.method",
        fmt::format("scheme.method = {}: written for phi_t^2/2 - phi_x^2/2 + N(phi), and theory.name = {} has "
                    "other derivatives; choose units in which the speed is 1, or use scheme.method = "
                    "multisymplectic",
                    p.method, p.theory));
  if (p.lattice.space() == Space::point)
    throw BadInput("scheme.method",
                   fmt::format("scheme.method = {}: a scheme for fields, and lattice.space = point has "
                               "none; use scheme.method = multisymplectic",
                               p.method));
  if (!p.lattice.is_circle() && (p.lattice.left() == Wall::natural || p.lattice.right() == Wall::natural))
    throw BadInput(
        p.lattice.left() == Wall::natural ? "boundary.left" : "boundary.right",
        fmt::format("a natural wall varies the action, and scheme.method = {} has none; use fixed walls", p.method));
  return {{std::move(family)}, theory.fields()};
}

std::optional<int> second(const Problem&) { return 2; }

}  // namespace

extern const EnergyEntry guo_energy, vu_quoc_li_energy;
extern const MethodEntry vu_quoc_li_method, guo_method, damped_method;
const MethodEntry vu_quoc_li_method{
    .name = "vu-quoc-li",
    .formula = "comparator (5.14): conserves an energy, is not multisymplectic",
    .build = [](const FieldTheory& theory, const Problem& p) { return comparator_parts(theory, p, vu_quoc_li()); },
    .own_energy = &vu_quoc_li_energy,
    .order = second,
    .words = [](const Problem&) -> std::string { return "the energy-conserving difference scheme of Vu-Quoc and Li"; },
    .sources = {"vu-quoc-li-1993", "marsden-patrick-shkoller-1998"}};
const MethodEntry guo_method{
    .name = "guo",
    .formula = "comparator (5.15): conserves an energy, is not multisymplectic",
    .build = [](const FieldTheory& theory, const Problem& p) { return comparator_parts(theory, p, guo()); },
    .own_energy = &guo_energy,
    .order = second,
    .words = [](const Problem&) -> std::string {
      return "the energy-conserving difference scheme of Guo, Pascual, Rodriguez and Vázquez";
    },
    .sources = {"guo-1986", "marsden-patrick-shkoller-1998"}};
const MethodEntry damped_method{
    .name = "damped",
    .formula = "comparator: leapfrog with friction 0.1, loses energy; for checks to fail on",
    .build = [](const FieldTheory& theory, const Problem& p) { return comparator_parts(theory, p, damped_leapfrog()); },
    .words = [](const Problem&) -> std::string { return "leapfrog with friction 0.1, a comparator that loses energy"; },
    .sources = {"delf"}};

}  // namespace delf

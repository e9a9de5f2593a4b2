// SPDX-License-Identifier: MIT
#include "schemes/families/r_adaptive.hpp"

#include <fmt/format.h>

#include <limits>

#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/stepping/energy.hpp"
#include "schemes/simulation.hpp"
#include "schemes/theories/field_theory.hpp"

namespace delf {
namespace {

SchemeParts build(const FieldTheory&, const Problem& p) {
  if (p.theory != "sine-gordon" || p.parameters.get<double>("theory.mass") != 1)
    throw BadInput("theory.name", "scheme.method = r-adaptive: written for sine-gordon with mass 1; use that theory");
  if (p.lattice.space() != Space::interval || p.lattice.left() != Wall::fixed || p.lattice.right() != Wall::fixed)
    throw BadInput("lattice.space",
                   "scheme.method = r-adaptive: the mesh moves between two fixed walls; use "
                   "lattice.space = interval and fixed walls");
  return {{std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
           std::make_shared<LagrangianFamily<ArclengthConstraint>>(
               ArclengthConstraint{p.parameters.get<double>("scheme.alpha")})},
          {{"phi"}, {"X", Role::field, {}, true}, {"lambda", Role::multiplier, {}}}};
}

// not a number: the sites move, and the symmetric rectangle's jets are none of the mesh
EnergyMomentum no_energy(const RowsInTime&) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  return {none, none};
}

std::string label(const Problem& p) {
  return fmt::format("r-adaptive, alpha = {:g}", p.parameters.get<double>("scheme.alpha"));
}

}  // namespace

extern const MethodEntry r_adaptive_method;
const MethodEntry r_adaptive_method{
    .name = "r-adaptive",
    .formula = "moving mesh, arclength constraint by multipliers, trapezoidal: Tyranowski-Desbrun (154)-(160)",
    .build = build,
    .parameters = {{.key = "scheme.alpha",
                    .fallback = 1.0,
                    .help = "how much the mesh follows the field",
                    .range = {.low = 0, .open = true}}},
    .label = label,
    .energy = no_energy};

}  // namespace delf

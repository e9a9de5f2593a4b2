// SPDX-License-Identifier: MIT
#include "schemes/families/r_adaptive.hpp"

#include "lattice/error.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/methods/method_registry.hpp"
#include "schemes/simulation.hpp"

namespace delf {
namespace {

SchemeParts build(const FieldTheory&, const Problem& p) {
  if (p.theory != "sine-gordon" || p.mass != 1)
    throw BadInput("theory.name", "scheme.method = r-adaptive: written for sine-gordon with mass 1; use that theory");
  if (p.lattice.space() != Space::interval || p.lattice.left() != Wall::fixed || p.lattice.right() != Wall::fixed)
    throw BadInput("lattice.space", "scheme.method = r-adaptive: the mesh moves between two fixed walls; use "
                                    "lattice.space = interval and fixed walls");
  return {{std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{}),
           std::make_shared<LagrangianFamily<ArclengthConstraint>>(ArclengthConstraint{p.alpha})},
          {{"phi"}, {"X", Role::field, {}, true}, {"lambda", Role::multiplier, {}}}};
}

}  // namespace

extern const MethodEntry r_adaptive_method;
const MethodEntry r_adaptive_method{
    "r-adaptive", "moving mesh, arclength constraint by multipliers, trapezoidal: Tyranowski-Desbrun (154)-(160)",
    build};

}  // namespace delf

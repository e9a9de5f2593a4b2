// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/guiding_centre.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry guiding_centre_theory;
const TheoryEntry guiding_centre_theory{
    .name = "guiding-centre",
    .formula = "a guiding centre in an axisymmetric tokamak, q = (R, Z, φ, u)",
    .parameters = {},
    .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<GuidingCentre>>(GuidingCentre{});
    },
    .words = "the guiding-centre motion of a charged particle in an axisymmetric tokamak",
    .sources = {"littlejohn-1983", "qin-guan-2008"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/guiding_centre.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry guiding_centre_theory;
const TheoryEntry guiding_centre_theory{"guiding-centre",
                                        "a guiding centre in an axisymmetric tokamak, q = (R, Z, φ, u)",
                                        {},
                                        [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                          return std::make_unique<TheoryOf<GuidingCentre>>(GuidingCentre{});
                                        }};

}  // namespace delf

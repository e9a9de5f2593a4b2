// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/charged_particle.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry charged_particle_theory;
const TheoryEntry charged_particle_theory{.name = "charged-particle",
                                          .formula = "θ = ½(1 + x² + y²)(−y, x), H = cos x + sin y",
                                          .parameters = {},
                                          .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                            return std::make_unique<TheoryOf<ChargedParticle>>(ChargedParticle{});
                                          },
                                          .words = "a massless charged particle in a magnetic field",
                                          .sources = {"kraus-2017"}};

}  // namespace delf

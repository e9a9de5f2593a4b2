// SPDX-License-Identifier: MIT
#include "schemes/theories/klein_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry klein_gordon_theory;
const TheoryEntry klein_gordon_theory{
    .name = "klein-gordon",
    .formula = "φ_tt − φ_xx + m²φ = 0",
    .parameters = {mass_parameter()},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<KleinGordon>>(KleinGordon{p.get<double>("theory.mass")});
    },
    .vacuum = 0.0,
    .words = "the Klein–Gordon equation",
    .sources = {"klein-1926", "gordon-1926"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/complex_klein_gordon.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry complex_klein_gordon_theory;
const TheoryEntry complex_klein_gordon_theory{
    .name = "complex-klein-gordon",
    .formula = "φ_tt − φ_xx + m²φ + λ|φ|²φ = 0",
    .parameters = {mass_parameter(), lambda_parameter()},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<ComplexKleinGordon>>(
          ComplexKleinGordon{p.get<double>("theory.mass"), p.get<double>("theory.lambda")});
    },
    .vacuum = 0.0,
    .words = "the complex Klein–Gordon equation with a cubic term",
    .sources = {"klein-1926", "gordon-1926"}};

}  // namespace delf

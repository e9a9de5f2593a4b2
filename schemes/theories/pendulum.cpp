// SPDX-License-Identifier: MIT
#include "schemes/theories/pendulum.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry pendulum_theory;
const TheoryEntry pendulum_theory{"pendulum",
                                  "q_tt + m² sin q = 0",
                                  {mass_parameter()},
                                  [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                    return std::make_unique<TheoryOf<Pendulum>>(Pendulum{p.get<double>("theory.mass")});
                                  },
                                  true, 0.0};

}  // namespace delf

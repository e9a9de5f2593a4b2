// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/kepler.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry kepler_theory;
const TheoryEntry kepler_theory{.name = "kepler",
                                .formula = "q_tt + μ q/|q|³ = 0",
                                .parameters = {{.key = "theory.gm",
                                                .fallback = 1.0,
                                                .help = "μ = GM of the centre",
                                                .unit = "length^3/time^2",
                                                .range = {.low = 0}}},
                                .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
                                  return std::make_unique<TheoryOf<Kepler>>(Kepler{p.get<double>("theory.gm")});
                                },
                                .words = "the Kepler problem",
                                .sources = {"hairer-lubich-wanner-2006"}};

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "schemes/theories/wave_map.hpp"

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry wave_map_theory;
const TheoryEntry wave_map_theory{.name = "wave-map",
                                  .formula = "u_tt − u_xx + (|u_t|² − |u_x|²)u = 0, |u| = 1",
                                  .parameters = {},
                                  .make = [](const ParameterValues&) -> std::unique_ptr<FieldTheory> {
                                    return std::make_unique<TheoryOf<WaveMap>>(WaveMap{});
                                  },
                                  .words = "the equation of wave maps into the sphere",
                                  .sources = {"shatah-struwe-1998"}};

}  // namespace delf

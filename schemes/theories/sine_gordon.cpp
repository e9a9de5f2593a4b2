// SPDX-License-Identifier: MIT
#include "schemes/theories/sine_gordon.hpp"

#include "schemes/families/r_adaptive.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {

extern const TheoryEntry sine_gordon_theory;
const TheoryEntry sine_gordon_theory{
    .name = "sine-gordon",
    .formula = "φ_tt − φ_xx + m² sin φ = 0",
    .parameters = {mass_parameter()},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      return std::make_unique<TheoryOf<SineGordon>>(SineGordon{p.get<double>("theory.mass")});
    },
    .angle = true,
    .vacuum = 0.0,
    .moving_rectangle = [](const ParameterValues& p) -> std::shared_ptr<const StencilFamily> {
      return std::make_shared<LagrangianFamily<MovingRectangle>>(MovingRectangle{p.get<double>("theory.mass")});
    },
    .moving_stage = [](const ParameterValues& p, double weight) -> std::shared_ptr<const StencilFamily> {
      return std::make_shared<LagrangianFamily<MovingStage>>(MovingStage{{p.get<double>("theory.mass")}, weight});
    },
    .words = "the sine-Gordon equation",
    .sources = {"perring-skyrme-1962", "scott-chu-mclaughlin-1973"}};

}  // namespace delf

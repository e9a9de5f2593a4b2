// SPDX-License-Identifier: MIT
#include "schemes/theories/mechanics/lotka_volterra.hpp"

#include <string>

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {
namespace {

template <LotkaVolterraGauge gauge>
std::unique_ptr<FieldTheory> in_gauge() {
  return std::make_unique<TheoryOf<LotkaVolterra<gauge>>>(LotkaVolterra<gauge>{});
}

}  // namespace

extern const TheoryEntry lotka_volterra_theory;
const TheoryEntry lotka_volterra_theory{
    .name = "lotka-volterra",
    .formula = "q₁_t = q₁(q₂ − 2), q₂_t = q₂(1 − q₁)",
    .parameters =
        {{.key = "theory.gauge",
          .fallback = std::string("full"),
          .help =
              "theta, up to a total derivative: (q2 + log(q2)/q1, q1), (log(q2)/q1, 0), or half of the latter in each",
          .choices = {"full", "x", "symmetric"}}},
    .make = [](const ParameterValues& p) -> std::unique_ptr<FieldTheory> {
      using enum LotkaVolterraGauge;
      const auto gauge = p.get<std::string>("theory.gauge");
      return gauge == "x" ? in_gauge<x>() : gauge == "symmetric" ? in_gauge<symmetric>() : in_gauge<full>();
    },
    .words = "the Lotka–Volterra equations",
    .sources = {"kraus-2017"}};

}  // namespace delf

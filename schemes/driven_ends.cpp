// SPDX-License-Identifier: MIT
#include "schemes/driven_ends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "lattice/error.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/families/driven_end.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theory_numbers.hpp"

namespace delf {
namespace {

std::string text_of_end(const Problem& p, const char* key) {
  return p.lattice.space() == Space::interval ? p.parameters.maybe<std::string>(key).value_or("") : "";
}

/// Formulas of t, with the numbers that the theory declares.
FormulasOfTime formulas_of(const FieldTheory& theory, const Problem& p, const std::string& text,
                           const std::string& key) {
  const auto numbers = theory_numbers(p.parameters);
  FormulasOfTime formulas;
  for (const std::string& part : parts_of(text, ';'))
    formulas.push_back({key, text, std::make_shared<const Formula>(part, numbers, key)});
  if (static_cast<int>(formulas.size()) != theory.components())
    throw BadInput(key, fmt::format("{} = {}: gives {}, and there are {} fields; give a formula for each, separated by "
                                    "semicolons",
                                    key, text, formulas.size(), theory.components()));
  return formulas;
}

}  // namespace

std::string key_of_driven_end(const Problem& p) {
  for (const char* key : {left_end, right_end, left_flux, right_flux})
    if (!text_of_end(p, key).empty()) return key;
  return {};
}

FormulasOfTime motion_of_end(const FieldTheory& theory, const Problem& p, const char* key) {
  const std::string motion = text_of_end(p, key);
  return motion.empty() ? FormulasOfTime() : formulas_of(theory, p, motion, key);
}

std::vector<EndFlux> end_fluxes(const FieldTheory& theory, const Problem& p) {
  std::vector<EndFlux> fluxes;
  for (const auto& [key, column] : {std::pair{left_flux, 0}, {right_flux, p.lattice.sites() - 1}})
    if (const std::string flux = text_of_end(p, key); !flux.empty())
      fluxes.push_back({column, formulas_of(theory, p, flux, key)});
  return fluxes;
}

void add_driven_ends(SchemeParts& parts, const FieldTheory& theory, const Problem& p) {
  const std::string key = key_of_driven_end(p);
  if (key.empty()) return;
  const bool of_fields = std::ranges::all_of(parts.components, [](const Component& c) {
    return (c.role == Role::field || c.role == Role::multiplier) && !c.position;
  });
  const bool mirrored = std::ranges::any_of(
      parts.families, [](const auto& family) { return family->pattern().placement == Placement::left_mirror; });
  const std::vector<EndFlux> fluxes = end_fluxes(theory, p);
  if (!of_fields || mirrored || !parts.processor.empty() || find_method(p.method).energy)
    throw BadInput(
        key, fmt::format("{}: scheme.method = {} has no such end; use scheme.method = multisymplectic", key, p.method));
  for (const auto& [end, wall] : {std::pair{left_end, Placement::left_wall}, {right_end, Placement::right_wall}})
    if (FormulasOfTime motion = motion_of_end(theory, p, end); !motion.empty())
      parts.families.push_back(std::make_shared<DrivenEnd>(wall, std::move(motion)));
  for (const auto& [column, flux] : fluxes)
    parts.families.push_back(std::make_shared<LagrangianFamily<WallFlux>>(
        WallFlux{column == 0 ? Placement::left_wall : Placement::right_wall, flux}));
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <regex>
#include <string_view>
#include <utility>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/generator.hpp"
#include "jets/expressions/helmholtz.hpp"
#include "jets/expressions/stencil_expression.hpp"
#include "jets/simd/pack.hpp"
#include "lattice/error.hpp"
#include "lattice/text_parts.hpp"
#include "schemes/families/lagrangian_family.hpp"
#include "schemes/theories/angles.hpp"
#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/mirrored_in_time.hpp"
#include "schemes/theories/theory_registry.hpp"

namespace delf {
namespace {

constexpr auto density_key = "theory.density", fields_key = "theory.fields", parameters_key = "theory.parameters",
               constraint_key = "theory.constraint", symmetry_key = "theory.symmetry", equation_key = "theory.equation";

/// Names with a meaning in other formulas of a scene, where a parameter would be read instead.
constexpr std::pair<std::string_view, std::string_view> names_elsewhere[] = {
    {"L", "the length of space"}, {"y", "a coordinate of space"},          {"z", "a coordinate of space"},
    {"h", "the time step"},       {"k", "the distance between the sites"}, {"X", "the position of a site"}};

/// Fields, and parameters with the numbers that theory.parameters gives them.
ExpressionNames names_of(const ParameterValues& values) {
  ExpressionNames names;
  if (const auto fields = values.maybe<std::string>(fields_key)) names.fields = parts_of(*fields);
  if (const auto parameters = values.maybe<std::string>(parameters_key))
    for (const std::string& part : parts_of(*parameters)) {
      const auto equals = part.find('=');
      if (equals == std::string::npos)
        throw BadInput(parameters_key, std::string(parameters_key) + ": \"" + part.substr(0, 60) +
                                           "\" is not NAME = NUMBER; write a list like m = 1, g = 0.3");
      names.parameters.emplace_back(trimmed(std::string_view(part).substr(0, equals)),
                                    number_of(std::string_view(part).substr(equals + 1), parameters_key));
    }
  check_names(names, fields_key, parameters_key);
  for (const auto& [name, number] : names.parameters)
    for (const auto& [taken, meaning] : names_elsewhere)
      if (name == taken)
        throw BadInput(parameters_key,
                       fmt::format("{}: \"{}\" is {} in formulas of a scene; choose another name, such as "
                                   "{}0",
                                   parameters_key, name, meaning, name));
  return names;
}

std::string key_of(const std::string& parameter) { return "theory." + parameter; }

std::vector<Parameter> further(const ParameterValues& values) {
  std::vector<Parameter> parameters;
  for (const auto& [name, number] : names_of(values).parameters) {
    for (const char* taken : {density_key, fields_key, parameters_key, constraint_key, symmetry_key, equation_key,
                              angles_key, "theory.name", "theory.fibre", "theory.lagrangian"})
      if (key_of(name) == taken)
        throw BadInput(parameters_key, std::string(parameters_key) + ": the key " + taken +
                                           " has a meaning already; choose another name than " + name);
    parameters.push_back(
        {.key = key_of(name), .fallback = number, .help = name + ", as theory.parameters declares it"});
  }
  return parameters;
}

/// The constraint, and the symmetries, separated by semicolons; each is tried on the density and the constraint.
BesidesDensity besides(const ParameterValues& values, const ExpressionNames& names, const std::string& density,
                       const std::string& constraint) {
  BesidesDensity all{.constraint = constraint};
  const auto given = values.maybe<std::string>(symmetry_key);
  if (!given) return all;
  const std::vector<std::string> parts = parts_of(*given, ';');
  for (const std::string& part : parts) {
    const std::size_t number = all.symmetries.size() + all.up_to_divergence.size() + 1;
    LinearSymmetry symmetry =
        generator_of(part, names, parts.size() == 1 ? "symmetry" : fmt::format("symmetry_{}", number), symmetry_key);
    const bool exact = require_symmetry(symmetry, density, constraint, names, symmetry_key);
    (exact ? all.symmetries : all.up_to_divergence).push_back(std::move(symmetry));
  }
  return all;
}

/// True if ∂ℓ/∂(jet), at jets that are tried, is the same where a field is larger by that much.
bool has_period(const BatchDensity& density, int field, double period) {
  constexpr int count = 4 * lanes;
  constexpr double rounding = 1e-9;
  struct alignas(64) Numbers : std::array<double, count> {};
  const std::size_t variables = density.variables();
  Numbers place{};
  const auto gradient = [&](double more) {
    std::vector<Numbers> jets(variables), g(variables);
    std::vector<const double*> slots;
    std::vector<double*> to;
    for (std::size_t a = 0; a < variables; ++a) {
      for (std::size_t i = 0; i < count; ++i)
        jets[a][i] = std::sin(1.0 + 2.3 * static_cast<double>(a) + 3.7 * static_cast<double>(i));
      slots.push_back(jets[a].data()), to.push_back(g[a].data());
    }
    for (double& phi : jets[field]) phi += more;
    density.gradient({count, slots.data(), 0, place.data()}, to.data());
    return g;
  };
  const std::vector<Numbers> here = gradient(0), there = gradient(period);
  for (std::size_t a = 0; a < variables; ++a)
    for (std::size_t i = 0; i < count; ++i)
      if (std::abs(there[a][i] - here[a][i]) > rounding * (1 + std::abs(here[a][i]))) return false;
  return true;
}

/// Every name of theory.angles is that of a field, in which the gradient of the density has the period 2π.
void require_angles(const ParameterValues& values, const ExpressionNames& names, const BatchDensity& density) {
  const auto given = values.maybe<std::string>(angles_key);
  for (const std::string& name : given ? parts_of(*given) : std::vector<std::string>()) {
    const auto field = std::ranges::find(names.fields, name);
    if (field == names.fields.end())
      throw BadInput(angles_key, fmt::format("{}: \"{}\" is none of the fields {}; correct it", angles_key, name,
                                             fmt::join(names.fields, ", ")));
    if (!has_period(density, static_cast<int>(field - names.fields.begin()), 2 * std::numbers::pi))
      throw BadInput(angles_key, fmt::format("{}: the field equations change where {} grows by 2 pi, so that it is no "
                                             "angle; leave it out",
                                             angles_key, name));
  }
}

std::unique_ptr<FieldTheory> make(const ParameterValues& values) {
  const auto text = values.maybe<std::string>(density_key), equation = values.maybe<std::string>(equation_key);
  ExpressionNames names = names_of(values);
  for (auto& [name, number] : names.parameters) number = values.maybe<double>(key_of(name)).value_or(number);
  if (equation) require_lagrangian(*equation, names, equation_key);
  if (!text && equation)
    throw BadInput(equation_key, std::string(equation_key) +
                                     ": a Lagrangian density has this equation, but is not found from it; give it as " +
                                     density_key + ", and it is tested");
  if (!text)
    throw BadInput(density_key, std::string(density_key) + ": must be given; write one like 0.5*phi_t^2 - 0.5*phi_x^2");
  if (equation) require_field_equations(*equation, *text, names, equation_key);
  std::vector<Component> components = fields(static_cast<int>(names.fields.size()));
  for (std::size_t a = 0; a < components.size(); ++a) components[a].name = names.fields[a];
  const auto constraint = values.maybe<std::string>(constraint_key);
  // A constraint that is none is named as such, before symmetries are tried on it.
  auto kept = constraint ? std::make_shared<LagrangianFamily<StencilExpression>>(
                               StencilExpression::constraint(*constraint, names, constraint_key))
                         : nullptr;
  auto density = expression(*text, names, density_key, besides(values, names, *text, constraint.value_or("")));
  require_angles(values, names, *density);
  return std::make_unique<FieldTheory>(std::move(density), std::move(kept), std::move(components));
}

}  // namespace

extern const TheoryEntry text_theory;
const TheoryEntry text_theory{
    .name = "text",
    .formula = "the field equations of theory.density",
    .parameters =
        {{.key = density_key,
          .fallback = std::string(),
          .help = "a Lagrangian density as text, in place of theory.name; see `delf help lagrangians`",
          .otherwise = "none"},
         {.key = fields_key, .fallback = std::string("phi"), .help = "the fields of theory.density: u, v"},
         {.key = parameters_key,
          .fallback = std::string(),
          .help = "numbers that theory.density reads, each a key theory.NAME: m = 1, g = 0.3",
          .otherwise = "none"},
         {.key = constraint_key,
          .fallback = std::string(),
          .help =
              "an expression of the fields that is kept at 0 at every site, by a multiplier: u^2 + v^2 - 1; several "
              "are separated by semicolons",
          .otherwise = "none"},
         {.key = symmetry_key,
          .fallback = std::string(),
          .help = "changes of the fields that leave theory.density as it is, for Noether's theorem: -v, u; several "
                  "are separated by semicolons",
          .otherwise = "none"},
         {.key = angles_key,
          .fallback = std::string(),
          .help = "the fields of theory.density that are angles: values 2 pi apart are the same state; sections, "
                  "measures and figures then count modulo 2 pi",
          .otherwise = "none"},
         {.key = equation_key,
          .fallback = std::string(),
          .help =
              "the field equations that theory.density is to have: phi_tt - phi_xx + sin(phi) = 0, several separated "
              "by semicolons; refused if they are others, or if no density has them",
          .otherwise = "none"}},
    .make = make,
    .chosen_by = {density_key, equation_key},
    .further = further,
    .sources = {"delf"}};

Problem mirrored_in_time(Problem problem, double T) {
  const auto is_end = [](const std::string& key) {  // ends that move as formulas of t
    return key.starts_with("boundary.left") || key.starts_with("boundary.right");
  };
  static const std::regex time("\\bt\\b");
  ParameterValues values;
  for (const auto& [key, value] : problem.parameters) {
    if (key == equation_key) continue;  // the density was tested with it, and it is that of the other direction
    values[key] = key == density_key || key == constraint_key || is_end(key)
                      ? std::regex_replace(std::get<std::string>(value), time, fmt::format("({:.17g}-t)", T))
                      : value;
  }
  problem.parameters = std::move(values);
  return problem;
}

}  // namespace delf

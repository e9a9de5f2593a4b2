// SPDX-License-Identifier: MIT
#include "schemes/driven_ends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

#include "jets/tables/density_on_table.hpp"
#include "jets/tables/table_product.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/space/mesh_space.hpp"
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
    throw BadInput(key,
                   fmt::format("{} = {}: the number of its formulas is {}, and that of the fields {}; give one for "
                               "each, separated by semicolons",
                               key, text, formulas.size(), theory.components()));
  return formulas;
}

/// The element in time that the action goes by, on one site; none: it goes from row to row.
std::optional<StencilTable> element_in_time(const SchemeParts& parts) {
  for (const auto& family : parts.families)
    if (const DensityOnTable* jets = family->made_of(); jets && !jets->table.lower_side.empty())
      return at_one_site(jets->table);
  return std::nullopt;
}

/// Sites beyond a wall are there as their mirror images.
bool is_image(const StencilFamily& family) {
  return family.pattern().placement == Placement::left_mirror && family.made_of() &&
         !family.made_of()->table.points.empty();
}

/// The vertices that points read.
std::set<int> read_vertices(const StencilTable& time) {
  std::set<int> read;
  for (const TablePoint& point : time.points)
    for (const JetSlot slot : {JetSlot::phi, JetSlot::phi_t})
      for (const auto& entry : point[slot]) read.insert(entry.vertex);
  return read;
}

/// Σ_j ψ_j(c) τ_jᵐ = cᵐ at the points, up to the highest power that the functions can have: a coefficient is then the value at
/// its node τ_j.
bool has_values_at_nodes(const StencilTable& time) {
  constexpr double rounding = 1e-9;
  const std::set<int> read = read_vertices(time);
  const auto place = [&](int vertex) {
    const Site& v = time.pattern.vertices[at(vertex)];
    return v.time + time.nodes[at(v.node)].time;
  };
  for (const TablePoint& point : time.points)
    for (std::size_t power = 1; power < read.size(); ++power) {
      double sum = 0;
      for (const auto& [vertex, psi] : point[JetSlot::phi]) sum += psi * std::pow(place(vertex), power);
      if (!(std::abs(sum - std::pow(point.time, power)) <= rounding)) return false;
    }
  return true;
}

}  // namespace

std::string key_of_driven_end(const Problem& p) {
  for (const char* key : {left_end, right_end, left_flux, right_flux})
    if (!text_of_end(p, key).empty()) return key;
  return {};
}

bool has_driven_boundary(const Problem& p) {
  const auto& mesh = p.lattice.mesh();
  return mesh ? mesh->boundary_works() : !key_of_driven_end(p).empty();
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
  const std::optional<StencilTable> element = element_in_time(parts);
  if (!parts.processor.empty())
    throw BadInput(key, fmt::format("{}: rows of scheme.method = {} are those of a kernel, and not the field; use "
                                    "scheme.method = composition and lattice.space_order = 2",
                                    key, p.method));
  if (std::ranges::any_of(parts.families, [](const auto& family) { return is_image(*family); }))
    throw BadInput(key,
                   fmt::format("{}: wide stencils go on beyond a wall by mirror images, which such an end has not; "
                               "use lattice.space_order = 2",
                               key));
  if (element && !has_values_at_nodes(*element))
    throw BadInput(key,
                   fmt::format("{}: the coefficients of this basis are not values of the field; use scheme.basis = "
                               "lagrange-lobatto",
                               key));
  const std::set<int> read = element ? read_vertices(*element) : std::set<int>();
  const int broken = read.contains(0) ? 0 : static_cast<int>(read.size());  // points read no vertex of a row
  const std::vector<EndFlux> fluxes = end_fluxes(theory, p);
  for (const auto& [end, wall] : {std::pair{left_end, Placement::left_wall}, {right_end, Placement::right_wall}})
    if (FormulasOfTime motion = motion_of_end(theory, p, end); !motion.empty())
      parts.families.push_back(std::make_shared<DrivenEnd>(wall, std::move(motion), broken));
  for (const auto& [column, flux] : fluxes)
    parts.families.push_back(std::make_shared<LagrangianFamily<WallFlux>>(
        WallFlux{column == 0 ? Placement::left_wall : Placement::right_wall, flux,
                 element ? *element : WallFlux::trapezoidal()}));
}

}  // namespace delf

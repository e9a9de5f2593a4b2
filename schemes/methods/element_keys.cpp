// SPDX-License-Identifier: MIT
#include "schemes/methods/element_keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "lattice/error.hpp"
#include "schemes/declared.hpp"

namespace delf {

ElementKeys::ElementKeys(const ParameterValues& values) {
  read(values);
  points = values.maybe<int>("scheme.points").value_or(functions);
  basis = named_basis().make(functions);
}

void ElementKeys::read(const ParameterValues& values) {
  basis_name = values.maybe<std::string>("scheme.basis").value_or(basis_name);
  functions = values.maybe<int>("scheme.functions").value_or(functions);
  quadrature = values.maybe<std::string>("scheme.quadrature").value_or(quadrature);
}

const NamedLineBasis& ElementKeys::named_basis() const {
  const NamedLineBasis& named = *std::ranges::find(named_line_bases(), basis_name, &NamedLineBasis::name);
  if (functions < named.fewest)
    throw BadInput("scheme.functions", fmt::format("scheme.functions = {}: the basis {} has {} functions at least; "
                                                   "raise scheme.functions, or use lagrange-gauss",
                                                   functions, basis_name, named.fewest));
  return named;
}

LineRule ElementKeys::rule() const {
  const auto named = std::ranges::find(named_line_rules(), quadrature, &NamedLineRule::name);
  if (points < named->fewest)
    throw BadInput("scheme.points", fmt::format("scheme.points = {}: the rule {} has {} points at least; raise "
                                                "scheme.points",
                                                points, quadrature, named->fewest));
  return named->make(points);
}

Parameter basis_parameter(const std::string& fallback) {
  return {.key = "scheme.basis",
          .fallback = fallback,
          .help = "the functions on a step",
          .choices = names_of(named_line_bases())};
}
Parameter functions_parameter(int fallback, int fewest) {
  return {.key = "scheme.functions",
          .fallback = fallback,
          .help = "S: how many; their degree is S - 1",
          .range = {.low = static_cast<double>(fewest), .high = 20}};
}
Parameter quadrature_parameter() {
  return {.key = "scheme.quadrature",
          .fallback = "gauss",
          .help = "the quadrature in time",
          .choices = names_of(named_line_rules())};
}
Parameter points_parameter(const std::string& otherwise, int fallback) {
  return {.key = "scheme.points",
          .fallback = fallback,
          .help = "R: points of the quadrature, on every span of a b-spline",
          .range = {.low = 1, .high = 40},
          .otherwise = otherwise};
}

std::vector<Component> momentum_components(const char* name, int d) {
  std::vector<Component> list;
  for (const Component& field : fields(d))
    list.push_back({fmt::format("{} of {}", name, field.name), Role::multiplier, {}, false, field.field, true});
  return list;
}

}  // namespace delf

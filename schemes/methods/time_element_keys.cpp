// SPDX-License-Identifier: MIT
#include "schemes/methods/time_element_keys.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "jets/tables/time_tableau.hpp"
#include "lattice/error.hpp"
#include "schemes/declared.hpp"

namespace delf {
namespace {

constexpr const char* stood_for[] = {"scheme.basis", "scheme.functions", "scheme.degree", "scheme.quadrature",
                                     "scheme.points"};

}  // namespace

TimeElementKeys::TimeElementKeys(const ParameterValues& values)
    : tableau(values.maybe<std::string>("scheme.tableau").value_or("")) {
  if (!tableau.empty()) {
    for (const char* key : stood_for)
      if (values.has(key))
        throw BadInput("scheme.tableau",
                       fmt::format("scheme.tableau = {}: stands for {} too; give one of the two", tableau, key));
    const TimeTableau& t = *std::ranges::find(time_tableaux(), tableau, &TimeTableau::name);
    basis_name = t.basis, functions = t.functions, quadrature = t.quadrature, points = t.points;
    degree = functions - 1;
  } else {
    read(values);
  }
  const NamedLineBasis& named = named_basis();
  if (tableau.empty()) {
    degree = values.maybe<int>("scheme.degree").value_or(named.of_degree ? std::min(3, functions - 1) : functions - 1);
    if (degree != functions - 1 && !named.of_degree)
      throw BadInput("scheme.degree",
                     fmt::format("scheme.degree = {}: {} functions of {} are polynomials of degree {}; "
                                 "leave it out, or use scheme.basis = b-spline",
                                 degree, functions, basis_name, functions - 1));
    if (degree > functions - 1)
      throw BadInput("scheme.degree", fmt::format("scheme.degree = {}: B-splines of degree p are p + 1 functions at "
                                                  "least; raise scheme.functions",
                                                  degree));
    points = values.maybe<int>("scheme.points").value_or(degree);
  }
  basis = named.of_degree ? named.of_degree(functions, degree) : named.make(functions);
  const auto given = values.maybe<std::string>("scheme.continuity");
  continuity = (given ? *given == "shared" : basis.has_end_nodes()) ? Continuity::shared : Continuity::multipliers;
}

std::string TimeElementKeys::in_words() const {
  return (tableau.empty()
              ? fmt::format("{} {} functions{}, {} {} points", basis_name, functions,
                            degree == functions - 1 ? "" : fmt::format(" of degree {}", degree), quadrature, points)
              : tableau) +
         (continuity == Continuity::shared ? ", shared" : ", multipliers");
}

std::vector<Parameter> TimeElementKeys::parameters() {
  // what a tableau stands for has no default beside it
  const auto otherwise = [](Parameter parameter, const char* words) {
    parameter.otherwise = words;
    return parameter;
  };
  return {{.key = "scheme.tableau",
           .fallback = std::string(),
           .help = "a Runge-Kutta method by its name, in place of basis, functions, quadrature and points",
           .choices = names_of(time_tableaux()),
           .otherwise = "none"},
          otherwise(basis_parameter("lagrange-lobatto"), "lagrange-lobatto"),
          otherwise(functions_parameter(3, 2), "3"),
          {.key = "scheme.degree",
           .fallback = 3,
           .help = "basis = b-spline: the degree of its pieces",
           .range = {.low = 1, .high = 19},
           .otherwise = "functions - 1, of b-spline 3 at most"},
          otherwise(quadrature_parameter(), "gauss"),
          points_parameter("the degree of the functions", 2),
          {.key = "scheme.continuity",
           .fallback = "shared",
           .help = "what joins the steps: end nodes that they share, or multipliers",
           .choices = {"shared", "multipliers"},
           .otherwise = "shared where the basis has a node at both ends, or else multipliers"}};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "jets/tables/radau_element.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "jets/tables/line_basis.hpp"
#include "jets/tables/line_rule.hpp"
#include "jets/tables/space_table.hpp"

namespace delf {

StencilTable radau_element(int stages) {
  const std::size_t s = stages;
  LineRule rule = radau_rule(stages);  // mirrored: the right end is a point
  std::ranges::reverse(rule.points), std::ranges::reverse(rule.weights);
  for (double& c : rule.points) c = 1 - c;
  const std::vector<double>&c = rule.points, &b = rule.weights;

  // a_ij = ∫₀^{c_i} ℓ_j with ℓ_j the Lagrange basis of the stages
  const LagrangeBasis of_stages(c);
  const LineRule gauss = gauss_rule(stages);
  std::vector a(s, std::vector(s, 0.0));
  for (std::size_t i = 0; i < s; ++i)
    for (std::size_t g = 0; g < gauss.points.size(); ++g) {
      const std::vector<double> values = of_stages.values(c[i] * gauss.points[g]);
      for (std::size_t j = 0; j < s; ++j) a[i][j] += c[i] * gauss.weights[g] * values[j];
    }

  StencilTable element{.pattern = {}, .points = {}, .nodes = {{}}};
  std::vector<double> places{0};
  for (std::size_t i = 0; i + 1 < s; ++i) element.nodes.push_back({.time = c[i]});
  for (int l = 0; l <= stages; ++l)
    element.pattern.vertices.push_back({.time = l / stages, .space = 0, .node = l % stages});
  places.insert(places.end(), c.begin(), c.end());
  const LagrangeBasis Q(places);
  for (std::size_t j = 0; j < s; ++j) {
    TablePoint point{.weight = b[j], .time = c[j], .slots = {}}, test = point;
    point.set(JetSlot::phi, Q.values(c[j])), point.set(JetSlot::phi_t, Q.slopes(c[j]));
    // Point j has the weight h b_j in the residuals, and slot φ_t the factor 1/h.
    std::vector<double> of_F(s + 1, 0.0), of_P = of_F;
    of_F[0] = 1;
    for (std::size_t i = 0; i + 1 < s; ++i) of_F[i + 1] = 1 - a[i][j] / b[j];
    if (j + 1 < s) of_P[j + 1] = 1 / b[j];
    else {
      std::fill_n(of_P.begin(), s, -1 / b[j]);
      of_P[s] = 1 / b[j];
    }
    test.set(JetSlot::phi, of_F), test.set(JetSlot::phi_t, of_P);
    element.points.push_back(std::move(point)), element.tests.push_back(std::move(test));
  }
  element.lower_side = point_space().points;
  return element;
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "tools/complex/place_formula.hpp"

#include "jets/expressions/parse.hpp"

namespace delf {

PlaceFormula::PlaceFormula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
                           const std::string& key) {
  expressions::Graph graph;
  const int root = expressions::parse(graph, text, {{{"t", 0}, {"x", 1}, {"y", 2}, {"z", 3}}, parameters}, key);
  value_ = expressions::Evaluation(graph, root);
  const int by_t = graph.differentiate(root, 0);
  by_t_ = expressions::Evaluation(graph, by_t);
  reads_time_ = !graph.is_constant(by_t, 0);
}

double PlaceFormula::evaluated(const expressions::Evaluation& formula, double t, const Mesh::Point& p) {
  return formula.operator()<double>([&](int v) { return v == 0 ? t : p[v - 1]; });
}

}  // namespace delf

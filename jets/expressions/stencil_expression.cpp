// SPDX-License-Identifier: MIT
#include "jets/expressions/stencil_expression.hpp"

#include "jets/expressions/constraints.hpp"
#include "jets/expressions/parse.hpp"
#include "lattice/error.hpp"
#include "lattice/text_parts.hpp"

namespace delf {

using namespace expressions;

StencilExpression::StencilExpression(StencilPattern pattern, std::vector<VertexValue> values, const Graph& graph,
                                     int root)
    : pattern_(std::move(pattern)),
      values_(std::move(values)),
      evaluation_(std::make_shared<const Evaluation>(graph, root)) {}

StencilExpression StencilExpression::constraint(std::string_view text, const ExpressionNames& given,
                                                const std::string& key) {
  const int d = static_cast<int>(given.fields.size());
  Names names{{}, given.parameters};
  std::vector<VertexValue> values;
  for (int a = 0; a < d; ++a) names.variables.emplace_back(given.fields[a], a);
  for (int a = 0; a < d; ++a) values.push_back({0, a});
  Graph graph;
  int sum = graph.constant(0);
  for (const std::string& constraint : constraints_of(text)) {
    if (trimmed(constraint).empty() || trimmed(constraint).ends_with(';'))
      throw BadInput(key, key + ": constraint " + std::to_string(values.size() - given.fields.size() + 1) +
                              " is empty; write it, or remove the semicolon");
    const int G = parse(graph, constraint, names, key), multiplier = static_cast<int>(values.size());
    const Evaluation of_G(graph, G);
    bool any = false;
    for (int a = 0; a < d; ++a) any = any || of_G.reads(a);
    if (!any)
      throw BadInput(
          key, key + ": is a number and no condition on the fields; write one like u^2 + v^2 - 1, which is kept at 0");
    values.push_back({0, multiplier});
    sum = graph.add(sum, graph.multiply(graph.variable(multiplier), G));
  }
  return {StencilPattern({{0, 0}}), std::move(values), graph, sum};
}

StencilExpression StencilExpression::lagrangian(std::string_view text, StencilPattern pattern,
                                                const std::vector<std::pair<std::string, double>>& parameters,
                                                const std::string& key) {
  Names names{{}, parameters};
  std::vector<VertexValue> values;
  const int n = pattern.size();
  for (int l = 0; l < n; ++l) {
    names.variables.emplace_back(std::string(1, 'y').append(std::to_string(l + 1)), l);
    values.push_back({l, 0});
  }
  names.variables.emplace_back("h", n);
  names.variables.emplace_back("k", n + 1);
  Graph graph;
  const int L = parse(graph, text, names, key);
  return {std::move(pattern), std::move(values), graph, L};
}

}  // namespace delf

// SPDX-License-Identifier: MIT
#include "jets/expressions/euler_lagrange.hpp"

#include <algorithm>
#include <stdexcept>

#include "lattice/index.hpp"

namespace delf::expressions {

JetVariables::JetVariables(const ExpressionNames& given)
    : d(static_cast<int>(given.fields.size())), parameters(static_cast<int>(given.parameters.size())) {
  for (int a = 0; a < d; ++a)
    for (int order = 0; order <= 2; ++order)
      for (int in_x = 0; in_x <= order; ++in_x)
        names.variables.emplace_back(
            given.fields[a] + (order ? "_" : "") + std::string(at(order - in_x), 't') + std::string(at(in_x), 'x'),
            derivative(a, order - in_x, in_x));
  if (std::ranges::find(given.fields, "x") == given.fields.end()) names.variables.emplace_back("x", x());
  names.variables.emplace_back("t", t());
  for (std::size_t p = 0; p < given.parameters.size(); ++p)
    names.variables.emplace_back(given.parameters[p].first, parameter(static_cast<int>(p)));
}

JetVariables::Derivative JetVariables::of(int variable) const {
  const int slot = variable / d;
  int order = 0;
  while ((order + 1) * (order + 2) / 2 <= slot) ++order;
  const int in_x = slot - order * (order + 1) / 2;
  return {variable % d, order - in_x, in_x};
}

int total_derivative(Graph& graph, int root, const JetVariables& variables, bool in_t) {
  const std::vector<bool> wanted = graph.reachable({root});
  std::vector<int> read;
  for (int i = 0; i <= root; ++i)
    if (wanted[i] && graph[i].operation == Operation::variable) read.push_back(graph[i].a);
  // d/dt = ∂/∂t + Σ v_t ∂/∂v over the fields and their derivatives v
  int sum = graph.differentiate(root, in_t ? variables.t() : variables.x());
  for (const int v : read) {
    if (!variables.is_derivative(v)) continue;
    const auto [a, of_t, of_x] = variables.of(v);
    if (of_t + of_x >= JetVariables::highest_order) throw std::logic_error("a derivative beyond the fourth order");
    const int next = graph.variable(variables.derivative(a, of_t + (in_t ? 1 : 0), of_x + (in_t ? 0 : 1)));
    sum = graph.add(sum, graph.multiply(graph.differentiate(root, v), next));
  }
  return sum;
}

std::vector<int> euler_lagrange(Graph& graph, int l, int a, const JetVariables& variables) {
  std::vector<int> terms;
  // −Σ (−D)ᵏ ∂ℓ/∂(Dᵏφ), from second derivatives to none
  for (const auto& [in_t, in_x] : {std::pair{2, 0}, {1, 1}, {0, 2}, {1, 0}, {0, 1}, {0, 0}}) {
    int term = graph.differentiate(l, variables.derivative(a, in_t, in_x));
    for (int n = 0; n < in_t; ++n) term = total_derivative(graph, term, variables, true);
    for (int n = 0; n < in_x; ++n) term = total_derivative(graph, term, variables, false);
    if (!graph.is_constant(term, 0)) terms.push_back((in_t + in_x) % 2 == 0 ? graph.negate(term) : term);
  }
  return terms;
}

}  // namespace delf::expressions

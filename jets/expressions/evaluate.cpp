// SPDX-License-Identifier: MIT
#include "jets/expressions/evaluate.hpp"

#include <algorithm>

#include "lattice/index.hpp"

namespace delf::expressions {

Evaluation::Evaluation(const Graph& graph, int root) {
  const auto index = [](int i) { return at(i); };
  const std::vector<bool> wanted = graph.reachable({root});
  std::vector<int> last_use(index(root + 1), -1), place(last_use), free;
  const auto has_operands = [](const Node& n) {
    return n.operation != Operation::constant && n.operation != Operation::variable;
  };
  for (int i = 0; i <= root; ++i) {
    if (!wanted[index(i)] || !has_operands(graph[i])) continue;
    last_use[index(graph[i].a)] = i;
    if (has_two_operands(graph[i].operation)) last_use[index(graph[i].b)] = i;
  }
  for (int i = 0; i <= root; ++i) {
    if (!wanted[index(i)]) continue;
    Step step{graph[i], 0, -1, -1};
    if (free.empty()) free.push_back(places_++);
    step.to = place[index(i)] = free.back();  // never that of an operand, which is let go below
    free.pop_back();
    if (has_operands(step.node)) {
      step.a = place[index(step.node.a)];
      if (has_two_operands(step.node.operation)) step.b = place[index(step.node.b)];
      if (last_use[index(step.node.a)] == i) free.push_back(step.a);
      if (step.b >= 0 && step.b != step.a && last_use[index(step.node.b)] == i) free.push_back(step.b);
    }
    steps_.push_back(step);
  }
}

bool Evaluation::reads(int variable) const {
  return std::ranges::any_of(steps_, [variable](const Step& step) {
    return step.node.operation == Operation::variable && step.node.a == variable;
  });
}

}  // namespace delf::expressions

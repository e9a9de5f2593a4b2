// SPDX-License-Identifier: MIT
#include "jets/expressions/random_jets.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "jets/expressions/evaluate.hpp"

namespace delf::expressions {

void at_random_jets(const JetVariables& variables, const ExpressionNames& names,
                    const std::function<void(std::span<const double> jet)>& visit) {
  std::mt19937_64 random(1);
  constexpr int jets = 40;
  for (int n = 0; n < jets; ++n) {
    std::uniform_real_distribution<double> uniform(n % 2 ? -1 : 0, n % 2 ? 1 : 2);
    std::vector<double> jet(variables.parameter(0));
    for (double& value : jet) value = uniform(random);
    for (const auto& parameter : names.parameters) jet.push_back(parameter.second);
    visit(jet);
  }
}

std::optional<double> largest_sum(const Graph& graph, const std::vector<int>& terms, const JetVariables& variables,
                                  const ExpressionNames& names) {
  std::vector<Evaluation> evaluations;
  for (const int term : terms) evaluations.emplace_back(graph, term);
  std::optional<double> worst;
  at_random_jets(variables, names, [&](std::span<const double> jet) {
    double sum = 0, absolute = 0;
    for (const Evaluation& evaluation : evaluations) {
      const double term = evaluation.operator()<double>([&](int v) { return jet[v]; });
      sum += term, absolute += std::abs(term);
    }
    if (std::isfinite(absolute)) worst = std::max(worst.value_or(0), absolute == 0 ? 0 : std::abs(sum) / absolute);
  });
  return worst;
}

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#include "tools/complex/place_formula.hpp"

#include "jets/expressions/parse.hpp"

namespace delf {

PlaceFormula::PlaceFormula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters,
                           const std::string& key)
    : root_(expressions::parse(graph_, text, {{{"t", 0}, {"x", 1}, {"y", 2}, {"z", 3}}, parameters}, key)),
      value_(graph_, root_) {}

PlaceFormula PlaceFormula::by(int variable) const {
  expressions::Graph graph = graph_;
  const int root = graph.differentiate(root_, variable);
  return {std::move(graph), root};
}

bool PlaceFormula::reads_time() const {
  const PlaceFormula rate = by(0);
  return !rate.graph_.is_constant(rate.root_, 0);
}

}  // namespace delf

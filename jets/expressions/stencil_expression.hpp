// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "jets/discrete_lagrangian.hpp"
#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/expression.hpp"

namespace delf {

/// A discrete Lagrangian on the values of a stencil, given as text: a StencilLagrangian for a LagrangianFamily.
class StencilExpression {
 public:
  /// Σ λ_m G_m(u) at every site, for constraints G_m(u) = 0 on d fields, as constraints_of() has them; λ_m is component
  /// d + m. Throws BadInput for `key`.
  static StencilExpression constraint(std::string_view text, const ExpressionNames&, const std::string& key);
  /// L(y1, …, yn; h, k) of the values of one field at n sites. Throws BadInput for `key`.
  static StencilExpression lagrangian(std::string_view text, StencilPattern,
                                      const std::vector<std::pair<std::string, double>>& parameters,
                                      const std::string& key);

  StencilPattern pattern() const { return pattern_; }
  std::vector<VertexValue> values() const { return values_; }

  template <class T>
  T operator()(std::span<const T> y, const Cell& cell) const {
    const int n = static_cast<int>(values_.size());
    return (*evaluation_).template operator()<T>([&](int variable) {
      return variable < n ? y[variable] : T(variable == n ? cell.time_step : cell.space_step);
    });
  }

 private:
  StencilExpression(StencilPattern pattern, std::vector<VertexValue> values, const expressions::Graph& graph, int root);

  StencilPattern pattern_;
  std::vector<VertexValue> values_;  ///< variables by number; h and k follow
  std::shared_ptr<const expressions::Evaluation> evaluation_;
};

}  // namespace delf

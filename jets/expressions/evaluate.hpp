// SPDX-License-Identifier: MIT
#pragma once
#include <utility>
#include <vector>

#include "jets/expressions/graph.hpp"
#include "jets/simd/pack_math.hpp"
#include "lattice/index.hpp"

namespace delf::expressions {

/// One node of a graph, computed for any kind of number T: doubles, numbers with derivatives, packs of them, and abstract
/// ones that prove structure. Where many numbers of one kind are wanted, a Tape is faster.
class Evaluation {
 public:
  Evaluation() = default;
  Evaluation(const Graph&, int root);

  /// variable(number) is the T that a variable stands for.
  template <class T, class Variable>
  T operator()(const Variable& variable) const {
    thread_local std::vector<T> values;
    values.resize(places_);
    for (const Step& step : steps_) {
      const auto at = [&](int place) -> const T& { return values[place]; };
      values[step.to] = value<T>(step, at, variable);
    }
    return std::move(values[steps_.back().to]);
  }

  bool reads(int variable) const;

 private:
  /// A node with the places of its operands; a place is used again after the last node that reads it.
  struct Step {
    Node node;
    int to = 0, a = -1, b = -1;
  };

  template <class T>
  static T value(const Step& step, const auto& at, const auto& variable) {
    switch (step.node.operation) {
      case Operation::constant:
        return T(step.node.value);
      case Operation::variable:
        return variable(step.node.a);
      case Operation::add:
        return at(step.a) + at(step.b);
      case Operation::subtract:
        return at(step.a) - at(step.b);
      case Operation::multiply:
        return at(step.a) * at(step.b);
      case Operation::divide:
        return at(step.a) / at(step.b);
      case Operation::negate:
        return -at(step.a);
      case Operation::power:
        return pow(at(step.a), step.node.value);
      default:
        return function<T>(step.node.operation, at(step.a));
    }
  }
  template <class T>
  static T function(Operation operation, const T& u) {
    switch (operation) {
      case Operation::sin:
        return sin(u);
      case Operation::cos:
        return cos(u);
      case Operation::cosm1:
        return cosm1(u);
      case Operation::tan:
        return tan(u);
      case Operation::exp:
        return exp(u);
      case Operation::log:
        return log(u);
      case Operation::sqrt:
        return sqrt(u);
      case Operation::sinh:
        return sinh(u);
      case Operation::cosh:
        return cosh(u);
      case Operation::tanh:
        return tanh(u);
      default:
        return atan(u);
    }
  }

  std::vector<Step> steps_;
  int places_ = 0;
};

}  // namespace delf::expressions

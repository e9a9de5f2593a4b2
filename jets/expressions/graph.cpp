// SPDX-License-Identifier: MIT
#include "jets/expressions/graph.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

#include "jets/simd/pack_math.hpp"
#include "lattice/index.hpp"

namespace delf::expressions {

using O = Operation;

double apply(Operation function, double x) {
  switch (function) {
    case O::sin:
      return std::sin(x);
    case O::cos:
      return std::cos(x);
    case O::cosm1:
      return delf::cosm1(x);
    case O::tan:
      return std::tan(x);
    case O::exp:
      return std::exp(x);
    case O::log:
      return std::log(x);
    case O::sqrt:
      return std::sqrt(x);
    case O::sinh:
      return std::sinh(x);
    case O::cosh:
      return std::cosh(x);
    case O::tanh:
      return std::tanh(x);
    case O::atan:
      return std::atan(x);
    default:
      throw std::logic_error("no function of one operand");
  }
}

std::size_t Graph::Hash::operator()(const Node& n) const {
  std::uint64_t h = static_cast<std::uint64_t>(n.operation);
  for (const std::uint64_t part : {static_cast<std::uint64_t>(static_cast<std::uint32_t>(n.a)),
                                   static_cast<std::uint64_t>(static_cast<std::uint32_t>(n.b)),
                                   std::bit_cast<std::uint64_t>(n.value == 0 ? 0.0 : n.value)}) {
    h = (h ^ part) * 0x9e3779b97f4a7c15u;
    h ^= h >> 29;
  }
  return delf::at(h);
}

int Graph::intern(const Node& node) {
  const auto [at, made] = known_.try_emplace(node, size());
  if (made) {
    if (nodes_.size() >= most_nodes) throw TooLarge("an expression with its derivatives has too many operations");
    nodes_.push_back(node);
  }
  return at->second;
}

int Graph::constant(double value) { return intern({O::constant, -1, -1, value == 0 ? 0.0 : value}); }
int Graph::variable(int number) { return intern({O::variable, number}); }

int Graph::add(int a, int b) {
  if (is_constant(b)) std::swap(a, b);
  const Node x = (*this)[a], y = (*this)[b];
  if (x.operation == O::constant) {
    if (y.operation == O::constant) return constant(x.value + y.value);
    if (x.value == 0) return b;
    // cos u − 1 keeps all its digits where u is small
    if (x.value == -1 && y.operation == O::cos) return apply(O::cosm1, y.a);
    // c + (d + u) = (c + d) + u
    if (y.operation == O::add && is_constant(y.a)) return add(constant(x.value + (*this)[y.a].value), y.b);
  }
  if (a == b) return multiply(constant(2), a);
  if (y.operation == O::negate) return subtract(a, y.a);
  if (x.operation == O::negate) return subtract(b, x.a);
  if (!is_constant(a) && a > b) std::swap(a, b);
  return intern({O::add, a, b});
}

int Graph::subtract(int a, int b) {
  const Node x = (*this)[a], y = (*this)[b];
  if (a == b) return constant(0);
  if (y.operation == O::constant) return add(constant(-y.value), a);
  if (x.operation == O::constant && x.value == 0) return negate(b);
  if (x.operation == O::constant && x.value == 1 && y.operation == O::cos) return negate(apply(O::cosm1, y.a));
  if (y.operation == O::negate) return add(a, y.a);
  if (x.operation == O::negate) return negate(add(x.a, b));
  return intern({O::subtract, a, b});
}

int Graph::negate(int a) {
  const Node x = (*this)[a];
  if (x.operation == O::constant) return constant(-x.value);
  if (x.operation == O::negate) return x.a;
  if (x.operation == O::subtract) return subtract(x.b, x.a);
  if (x.operation == O::multiply && is_constant(x.a)) return multiply(constant(-(*this)[x.a].value), x.b);
  return intern({O::negate, a});
}

int Graph::multiply(int a, int b) {
  if (is_constant(b)) std::swap(a, b);
  const Node x = (*this)[a], y = (*this)[b];
  const auto constant_factor = [this](const Node& n) { return n.operation == O::multiply && is_constant(n.a); };
  if (x.operation == O::constant) {
    if (y.operation == O::constant) return constant(x.value * y.value);
    if (x.value == 0) return a;
    if (x.value == 1) return b;
    if (x.value == -1) return negate(b);
    if (constant_factor(y)) return multiply(constant(x.value * (*this)[y.a].value), y.b);
    if (y.operation == O::negate) return multiply(constant(-x.value), y.a);
    return intern({O::multiply, a, b});
  }
  if (x.operation == O::negate) return negate(multiply(x.a, b));
  if (y.operation == O::negate) return negate(multiply(a, y.a));
  if (constant_factor(x)) return multiply(x.a, multiply(x.b, b));
  if (constant_factor(y)) return multiply(y.a, multiply(a, y.b));
  if (a > b) std::swap(a, b);
  return intern({O::multiply, a, b});
}

int Graph::divide(int a, int b) {
  const Node x = (*this)[a], y = (*this)[b];
  if (y.operation == O::constant) {
    if (x.operation == O::constant) return constant(x.value / y.value);
    return multiply(constant(1 / y.value), a);
  }
  if (x.operation == O::constant && x.value == 0) return a;
  if (x.operation == O::negate) return negate(divide(x.a, b));
  if (y.operation == O::negate) return negate(divide(a, y.a));
  if (x.operation == O::multiply && is_constant(x.a)) return multiply(x.a, divide(x.b, b));
  if (y.operation == O::multiply && is_constant(y.a)) return multiply(constant(1 / (*this)[y.a].value), divide(a, y.b));
  return intern({O::divide, a, b});
}

int Graph::integer_power(int a, int exponent) {
  if (exponent == 1) return a;
  const int half = integer_power(a, exponent / 2), square = multiply(half, half);
  return exponent % 2 == 0 ? square : multiply(square, a);
}

int Graph::power(int a, double exponent) {
  constexpr double most_products = 16;
  if (exponent == 0) return constant(1);
  if (is_constant(a)) return constant(std::pow((*this)[a].value, exponent));
  if (exponent < 0 && exponent >= -most_products) return divide(constant(1), power(a, -exponent));
  if (exponent > 0 && exponent == std::round(exponent) && exponent <= most_products)
    return integer_power(a, static_cast<int>(exponent));
  if (exponent == 0.5) return apply(O::sqrt, a);
  return intern({O::power, a, -1, exponent});
}

int Graph::power(int a, int b) {
  if (is_constant(b)) return power(a, (*this)[b].value);
  return apply(O::exp, multiply(b, apply(O::log, a)));
}

int Graph::apply(Operation function, int a) {
  if (is_constant(a)) return constant(expressions::apply(function, (*this)[a].value));
  return intern({function, a});
}

std::vector<bool> Graph::reachable(const std::vector<int>& roots) const {
  std::vector<bool> marked(nodes_.size(), false);
  int last = -1;
  for (const int root : roots) marked[root] = true, last = std::max(last, root);
  for (int i = last; i >= 0; --i) {
    const Node& n = (*this)[i];
    if (!marked[i] || n.operation == O::variable) continue;
    if (n.a >= 0) marked[n.a] = true;
    if (n.b >= 0) marked[n.b] = true;
  }
  return marked;
}

/// The derivative of a node from those of its operands: the chain rule.
int Graph::derivative(int node, int a, int b) {
  const Node n = (*this)[node];
  const int zero = constant(0);
  if (has_two_operands(n.operation) ? a == zero && b == zero : a == zero) return zero;
  const auto squared = [this](int u) { return multiply(u, u); };
  switch (n.operation) {
    case O::add:
      return add(a, b);
    case O::subtract:
      return subtract(a, b);
    case O::multiply:
      return add(multiply(a, n.b), multiply(n.a, b));
    case O::divide:
      return divide(subtract(a, multiply(node, b)), n.b);  // (u/v)′ = (u′ − (u/v) v′)/v
    case O::negate:
      return negate(a);
    case O::power:
      return multiply(constant(n.value), multiply(power(n.a, n.value - 1), a));
    case O::sin:
      return multiply(apply(O::cos, n.a), a);
    case O::cos:
    case O::cosm1:
      return negate(multiply(apply(O::sin, n.a), a));
    case O::tan:
      return multiply(add(constant(1), squared(node)), a);
    case O::exp:
      return multiply(node, a);
    case O::log:
      return divide(a, n.a);
    case O::sqrt:
      return divide(multiply(constant(0.5), a), node);
    case O::sinh:
      return multiply(apply(O::cosh, n.a), a);
    case O::cosh:
      return multiply(apply(O::sinh, n.a), a);
    case O::tanh:
      return multiply(subtract(constant(1), squared(node)), a);
    case O::atan:
      return divide(a, add(constant(1), squared(n.a)));
    case O::constant:
    case O::variable:
      break;
  }
  throw std::logic_error("delf: an operation without a derivative");
}

int Graph::differentiate(int root, int variable) {
  const std::vector<bool> wanted = reachable({root});
  std::vector<int> d(root + 1, -1);
  for (int i = 0; i <= root; ++i) {
    if (!wanted[i]) continue;
    const Node n = (*this)[i];
    if (n.operation == O::constant) d[i] = constant(0);
    else if (n.operation == O::variable) d[i] = constant(n.a == variable ? 1 : 0);
    else d[i] = derivative(i, d[n.a], n.b < 0 ? -1 : d[n.b]);
  }
  return d[root];
}

int Graph::substitute(int root, const std::function<int(int variable)>& in_place_of) {
  const std::vector<bool> wanted = reachable({root});
  std::vector<int> made(root + 1, -1);
  for (int i = 0; i <= root; ++i) {
    if (!wanted[i]) continue;
    const Node n = (*this)[i];
    const auto a = [&] { return made[n.a]; };
    const auto b = [&] { return made[n.b]; };
    int& to = made[i];
    switch (n.operation) {
      case O::constant:
        to = i;
        break;
      case O::variable:
        to = in_place_of(n.a);
        break;
      case O::add:
        to = add(a(), b());
        break;
      case O::subtract:
        to = subtract(a(), b());
        break;
      case O::multiply:
        to = multiply(a(), b());
        break;
      case O::divide:
        to = divide(a(), b());
        break;
      case O::negate:
        to = negate(a());
        break;
      case O::power:
        to = power(a(), n.value);
        break;
      default:
        to = apply(n.operation, a());
    }
  }
  return made[root];
}

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <stdexcept>
#include <unordered_map>
#include <vector>

namespace delf::expressions {

enum class Operation : std::uint8_t {
  constant,
  variable,
  add,
  subtract,
  multiply,
  divide,
  negate,
  power,  ///< to a constant exponent
  sin,
  cos,
  cosm1,
  tan,
  exp,
  log,
  sqrt,
  sinh,
  cosh,
  tanh,
  atan
};
constexpr bool is_function(Operation o) { return o >= Operation::sin; }
constexpr bool has_two_operands(Operation o) { return o >= Operation::add && o <= Operation::divide; }

struct Node {
  Operation operation;
  int a = -1, b = -1;  ///< operands; of a variable, a is its number
  double value = 0;    ///< of a constant; the exponent of a power

  bool operator==(const Node&) const = default;
};

/// Thrown when a graph has grown beyond `most_nodes`.
struct TooLarge : std::length_error {
  using std::length_error::length_error;
};

/// Expressions with common subexpressions shared: a node is made once, and operands come before what is made of them. So a
/// loop over indices is an evaluation, and nothing here recurses.
class Graph {
 public:
  static constexpr std::size_t most_nodes = 200'000;

  const Node& operator[](int node) const { return nodes_[node]; }
  int size() const { return static_cast<int>(nodes_.size()); }
  bool is_constant(int node) const { return (*this)[node].operation == Operation::constant; }
  bool is_constant(int node, double value) const { return is_constant(node) && (*this)[node].value == value; }

  // Each simplifies on the way: 0·x, 1·x, x + 0, x − x, constants folded and brought to the front of products.
  int constant(double);
  int variable(int number);
  int add(int a, int b);
  int subtract(int a, int b);
  int multiply(int a, int b);
  int divide(int a, int b);
  int negate(int a);
  /// Integer exponents up to 16 in size as products.
  int power(int a, double exponent);
  /// exp(b log a) if b is not constant.
  int power(int a, int b);
  int apply(Operation function, int a);

  /// ∂root/∂(variable). The rules make nodes of this graph, so that derivatives share what they have in common.
  int differentiate(int root, int variable);
  /// root with other nodes in place of variables.
  int substitute(int root, const std::function<int(int variable)>& in_place_of);
  /// Marks the nodes that the roots are made of.
  std::vector<bool> reachable(const std::vector<int>& roots) const;

 private:
  struct Hash {
    std::size_t operator()(const Node&) const;
  };
  int intern(const Node&);
  int integer_power(int a, int exponent);
  int derivative(int node, int of_a, int of_b);

  std::vector<Node> nodes_;
  std::unordered_map<Node, int, Hash> known_;
};

/// f(x) of a function of one operand.
double apply(Operation function, double x);

}  // namespace delf::expressions

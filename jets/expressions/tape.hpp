// SPDX-License-Identifier: MIT
#pragma once
#include <vector>

#include "jets/expressions/graph.hpp"

namespace delf::expressions {

/// Some nodes of a graph as a list of operations, each of which is carried out for a block of packs that fits the cache
/// before the next: what an operation costs to be looked up is then shared by hundreds of numbers. A product that only one
/// sum reads is fused with it.
class Tape {
 public:
  /// The tape of the variables 0 … variables − 1, the last of which is t.
  Tape(const Graph&, const std::vector<int>& outputs, int variables);
  Tape() = default;

  /// out[o][i], i < count, from in[v][i]. Rows that nothing reads may be null, and t has none. count: a multiple of `lanes`.
  void run(int count, const double* const* in, double t, double* const* out) const;
  int size() const { return static_cast<int>(instructions_.size()); }

 private:
  enum class Code : std::uint8_t {
    fill,         ///< k
    affine,       ///< k a + l
    add,          ///< a + b
    subtract,     ///< a − b
    scaled_add,   ///< k a + b
    scaled_less,  ///< k a − b
    multiply,     ///< k a b
    product_add,  ///< a b + c
    product_less,  ///< a b − c
    less_product,  ///< c − a b
    product_shift,  ///< a b + l
    divide,        ///< a/b
    reciprocal,    ///< k/a
    power,         ///< a^k
    function       ///< k f(l a)
  };
  struct Instruction {
    Code code;
    Operation function = Operation::constant;
    int to = 0, a = 0, b = 0, c = 0;  ///< rows: variables, then outputs, then temporaries
    double k = 1, l = 0;
  };
  class Compiler;

  static void carry_out(const Instruction&, double* const* rows, int packs);

  std::vector<Instruction> instructions_;
  int variables_ = 0, outputs_ = 0, temporaries_ = 0;
  bool reads_t_ = false;
};

}  // namespace delf::expressions

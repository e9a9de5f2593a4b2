// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "jets/expressions/graph.hpp"

namespace delf::expressions {

/// A product of powers of atoms with a numerical coefficient. Atoms are variables, functions of a sum, and sums.
struct Term {
  double coefficient = 1;
  std::map<int, double> powers = {};  ///< by the number of the atom; none is zero
};
/// Terms that differ in their powers.
using Sum = std::vector<Term>;

struct Atom {
  enum Kind { variable, function, sum } kind;
  int number = 0;                        ///< of a variable
  Operation operation = Operation::sin;  ///< of a function
  Sum operand = {};                      ///< of a function, or the sum itself
};

/// Expressions as people write them: sums of products, with like terms collected and common factors taken out where that
/// makes them shorter. 2 φ(1 − φ²)² − 4 φ³(1 − φ²) becomes 2 φ(1 − φ²)(1 − 3φ²).
class Sums {
 public:
  /// Variables for which is_scale holds are taken into sums, as numbers are: a/h for a sum a.
  Sums(const Graph& graph, std::function<bool(int variable)> is_scale)
      : graph_(graph), is_scale_(std::move(is_scale)) {}

  /// The sum of some nodes. Throws TooLarge.
  Sum of(const std::vector<int>& nodes);
  const Atom& atom(int number) const { return atoms_[number]; }
  bool is_scale(int atom_number) const;

 private:
  const Sum& known(int node) const { return of_node_.at(node); }
  Sum made(const Node&);
  Sum plus(Sum, const Sum&, double factor) const;
  Sum times(const Sum&, const Sum&);
  Sum power(const Sum&, double exponent);
  Sum function(Operation, const Sum&);
  Sum with_common_factors(Sum);
  bool take_out(Sum&, int atom_number);
  bool over_one_denominator(Sum&, int atom_number);
  /// A sum as one term: the term itself, or an atom to the first power.
  Term as_term(const Sum&, double exponent);
  int intern(Atom);
  bool is_scale(const Term&) const;

  const Graph& graph_;
  std::function<bool(int)> is_scale_;
  std::vector<Atom> atoms_;
  std::map<std::string, int> numbers_;
  std::map<int, Sum> of_node_;
};

}  // namespace delf::expressions

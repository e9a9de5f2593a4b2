// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "jets/expressions/graph.hpp"
#include "lattice/index.hpp"

namespace delf::expressions {

/// A product of powers of atoms, by their numbers; no exponent is zero.
using Monomial = std::vector<std::pair<int, double>>;
/// The coefficient of a monomial with the size of what was added up to it: what cancels up to rounding is gone.
struct Coefficient {
  double value, size;
};
/// A sum of monomials that differ.
using JetSum = std::map<Monomial, Coefficient>;

/// Power series in small variables whose coefficients are functions of jets, all products multiplied out: the arithmetic of
/// Taylor expansions. Terms beyond the highest order are dropped wherever they arise.
class JetAlgebra {
 public:
  /// Sums of more terms, and more operations on terms, are given up by TooLarge.
  static constexpr std::size_t most_terms = 40'000;
  static constexpr long most_operations = 30'000'000;

  struct Atom {
    enum Kind { variable, function, sum } kind;
    int number = 0;                        ///< of a variable
    Operation operation = Operation::sin;  ///< of a function
    JetSum operand = {};                   ///< of a function, or the sum itself, which has a power that is no product
    Monomial leading = {};                 ///< of a sum: what its other terms take the place of beside negative powers
    double leading_coefficient = 1;
  };

  /// `order_of(variable)` is that of the variable in what is small: 1 of h and k, 0 of jets.
  JetAlgebra(int highest_order, std::function<int(int variable)> order_of)
      : highest_(highest_order), order_of_(std::move(order_of)) {}

  int highest_order() const { return highest_; }
  void set_highest_order(int order) { highest_ = order; }
  const Atom& atom(int number) const { return atoms_[at(number)]; }
  double order(const Monomial&) const;

  static JetSum constant(double);
  JetSum variable(int number);
  /// The atom that is this variable.
  int atom_of(int variable) { return intern({.kind = Atom::variable, .number = variable}); }
  /// A node of a graph, its variables replaced. Throws TooLarge.
  JetSum of(const Graph&, int node, const std::function<JetSum(int variable)>&);
  /// A sum as a node of a graph.
  int node(Graph&, const JetSum&) const;

  void add(JetSum& to, const JetSum&, double factor = 1);
  JetSum times(const JetSum&, const JetSum&);
  JetSum times(const JetSum&, double factor) const;
  /// Throws std::domain_error for 1/0.
  JetSum power(const JetSum&, double exponent);
  JetSum apply(Operation, const JetSum& operand);
  void insert(JetSum& to, const Monomial&, Coefficient);

  /// The derivation that takes each variable to a sum, such as d/dx; what it takes atoms to is kept.
  struct Derivation {
    std::function<JetSum(int variable)> of_variable;
    std::map<int, JetSum> known = {};
  };
  JetSum derive(const JetSum&, Derivation&);
  JetSum by(const JetSum&, int variable);  ///< ∂/∂(variable)

  /// The sum with v + Δ(v) in the place of each variable v, as its Taylor series: every Δ is at least of first order.
  struct Shift {
    std::function<JetSum(int variable)> by;
    std::map<int, JetSum> known = {};  ///< [atom]: what is added to it
  };
  JetSum shifted(const JetSum&, Shift&);
  /// The sum with others in place of variables; none: the variable stays.
  JetSum substituted(const JetSum&, const std::map<int, JetSum>& in_place_of);
  /// The terms of one order.
  JetSum of_order(const JetSum&, int order) const;

  /// The variables that an atom depends on.
  const std::vector<int>& variables_of(int atom) const { return depends_[at(atom)]; }
  bool depends(const JetSum&, const std::function<bool(int variable)>&) const;

 private:
  int intern(Atom);
  JetSum derivative_of_function(Operation, const JetSum& operand);
  JetSum atom_to(int atom, double exponent);
  JetSum difference_of(int atom, Shift&);

  int highest_;
  std::function<int(int)> order_of_;
  std::vector<Atom> atoms_;
  std::vector<double> orders_;             ///< [atom]
  std::vector<std::vector<int>> depends_;  ///< [atom]
  std::map<std::string, int> numbers_;
  long operations_ = 0;
};

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#include "jets/expressions/helmholtz.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "jets/expressions/equations.hpp"
#include "jets/expressions/evaluate.hpp"
#include "jets/expressions/parse.hpp"
#include "jets/expressions/random_jets.hpp"
#include "lattice/error.hpp"
#include "lattice/index.hpp"
#include "lattice/text_parts.hpp"

namespace delf {
namespace {

using namespace expressions;

class Equations {
 public:
  Equations(std::string_view text, const ExpressionNames& names, const std::string& key)
      : names_(names), key_(key), jets_(names) {
    const std::vector<std::string> parts = parts_of(text, ';');
    if (parts.size() != names.fields.size())
      refuse("has " + std::to_string(parts.size()) + (parts.size() == 1 ? " equation for " : " equations for ") +
             std::to_string(names.fields.size()) + (names.fields.size() == 1 ? " field" : " fields") +
             "; give one for each, separated by semicolons");
    for (const std::string& part : parts) F_.push_back(parsed(part));
  }

  void require_self_adjoint() {
    // c_ab^μν = c_ba^μν, then ∂_μ, then none: the first that differs is named
    for (const Order& order : std::array<Order, 6>{{{2, 0}, {1, 1}, {0, 2}, {1, 0}, {0, 1}, {0, 0}}})
      for (int a = 0; a < jets_.d; ++a)
        for (int b = 0; b < jets_.d; ++b) {
          const int own = slope(a, b, order);
          const std::vector<int> adjoint = adjoint_terms(a, b, order);
          std::vector<int> difference = adjoint;
          difference.push_back(graph_.negate(own));
          if (is_zero(difference)) continue;
          refuse_unlike(a, b, order, own, sum(adjoint));
        }
  }

  /// F_a = c_a E_a with E_a of the density.
  void require_those_of(std::string_view density) {
    const int l = parse(graph_, density, jets_.names, key_);
    for (int a = 0; a < jets_.d; ++a) {
      const std::vector<int> terms = euler_lagrange(graph_, l, a, jets_);
      const int E = sum(terms);
      const Evaluation given(graph_, F_[index(a)]), derived(graph_, E);
      std::optional<double> factor;
      at_random_jets(jets_, names_, [&](std::span<const double> jet) {
        const auto at = [&](int v) { return jet[index(v)]; };
        const double ratio = derived.operator()<double>(at) / given.operator()<double>(at);
        if (!factor && std::isfinite(ratio) && ratio != 0) factor = ratio;
      });
      std::vector<int> difference = terms;
      difference.push_back(graph_.multiply(graph_.constant(-factor.value_or(1)), F_[index(a)]));
      if (!is_zero(difference))
        refuse("is not the field equation of " + name(a) + " that the density gives, which is " + formula(E) +
               " = 0; correct one of them");
    }
  }

 private:
  struct Order {
    int in_t, in_x;
  };
  static std::size_t index(int i) { return delf::at(i); }
  [[noreturn]] void refuse(const std::string& why) const { throw BadInput(key_, key_ + ": " + why); }
  const std::string& name(int a) const { return names_.fields[index(a)]; }

  int parsed(const std::string& equation) {
    const std::size_t equals = equation.find('=');
    if (equals == std::string::npos) return parse(graph_, equation, jets_.names, key_);
    const std::string_view text = equation;
    return graph_.subtract(parse(graph_, text.substr(0, equals), jets_.names, key_),
                           parse(graph_, text.substr(equals + 1), jets_.names, key_));
  }
  /// c_ab of a derivative: ∂F_a/∂(∂ᵐ_t ∂ⁿ_x u_b)
  int slope(int a, int b, Order order) {
    return graph_.differentiate(F_[index(a)], jets_.derivative(b, order.in_t, order.in_x));
  }
  int derivative(int node, int in_t, int in_x) {
    for (int n = 0; n < in_t; ++n) node = total_derivative(graph_, node, jets_, true);
    for (int n = 0; n < in_x; ++n) node = total_derivative(graph_, node, jets_, false);
    return node;
  }
  /// The coefficients of ∂ᵐ_t ∂ⁿ_x δu_b in Σ (−∂)^MN (c_ba^MN δu_b), by Leibniz's rule.
  std::vector<int> adjoint_terms(int a, int b, Order order) {
    constexpr int binomial[3][3] = {{1, 0, 0}, {1, 1, 0}, {1, 2, 1}};
    std::vector<int> terms;
    for (int M = order.in_t; M <= 2; ++M)
      for (int N = order.in_x; M + N <= 2; ++N) {
        const int sign = (M + N) % 2 == 0 ? 1 : -1;
        const int factor = sign * binomial[M][order.in_t] * binomial[N][order.in_x];
        const int c = derivative(slope(b, a, {M, N}), M - order.in_t, N - order.in_x);
        terms.push_back(graph_.multiply(graph_.constant(factor), c));
      }
    return terms;
  }
  int sum(const std::vector<int>& terms) {
    int node = graph_.constant(0);
    for (const int term : terms) node = graph_.add(node, term);
    return node;
  }
  std::string formula(int node) const {
    constexpr std::size_t most = 80;
    const std::string text = formula_of(graph_, node, jets_, names_);
    return text.size() <= most ? text : "too long to be written here";
  }
  bool is_zero(const std::vector<int>& terms) const {
    const auto sum = largest_sum(graph_, terms, jets_, names_);
    if (!sum) refuse("has no value at any jet that was tried");
    return *sum <= zero_at_random_jets;
  }
  [[noreturn]] void refuse_unlike(int a, int b, Order order, int own, int adjoint) {
    const std::string by = std::string(index(order.in_t), 't') + std::string(index(order.in_x), 'x');
    const std::string variable = name(b) + (by.empty() ? "" : "_") + by;
    if (a == b && order.in_t + order.in_x == 1) {
      // 2 c^μ = what comes from the second derivatives
      const int right = graph_.multiply(graph_.constant(0.5), graph_.add(own, adjoint));
      refuse("no Lagrangian density has this equation: its coefficient of " + variable + " is " + formula(own) +
             ", and by Helmholtz's conditions it would have to be " + formula(right) +
             (order.in_t == 1 ? " (friction)" : "") +
             "; leave that term out, or multiply the equation by a factor that makes it one, as exp(g*t) does for "
             "g*" +
             variable);
    }
    refuse("no Lagrangian density has these equations: how that of " + name(a) + " changes with " + variable + " (" +
           formula(own) + ") and the other way round (" + formula(adjoint) +
           ") differ, against Helmholtz's conditions; multiply one of them by -1 or another factor, or correct it");
  }

  const ExpressionNames& names_;
  const std::string& key_;
  JetVariables jets_;
  Graph graph_;
  std::vector<int> F_;
};

void bounded(const std::string& key, const auto& what) {
  try {
    what();
  } catch (const TooLarge& large) {
    throw BadInput(key, key + ": " + large.what() + "; simplify the equation");
  }
}

}  // namespace

void require_lagrangian(std::string_view equations, const ExpressionNames& names, const std::string& key) {
  bounded(key, [&] { Equations(equations, names, key).require_self_adjoint(); });
}

void require_field_equations(std::string_view equations, std::string_view density, const ExpressionNames& names,
                             const std::string& key) {
  bounded(key, [&] { Equations(equations, names, key).require_those_of(density); });
}

}  // namespace delf

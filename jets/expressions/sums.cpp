// SPDX-License-Identifier: MIT
#include "jets/expressions/sums.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lattice/index.hpp"

namespace delf::expressions {
namespace {

constexpr std::size_t most_terms = 400;

std::string key_of(const Term& term) {
  std::string key;
  for (const auto& [atom, exponent] : term.powers) key += std::to_string(atom) + "^" + std::to_string(exponent) + " ";
  return key;
}
std::string key_of(const Sum& sum) {
  std::vector<std::string> keys;
  for (const Term& term : sum) {
    char number[32];
    std::snprintf(number, sizeof number, "%.15g", term.coefficient);  // one third is one third, however it came about
    keys.push_back(number + ("*" + key_of(term)));
  }
  std::ranges::sort(keys);
  std::string key;
  for (const std::string& one : keys) key += one + "+ ";
  return key;
}

Term product(const Term& a, const Term& b) {
  Term result = a;
  result.coefficient *= b.coefficient;
  for (const auto& [atom, exponent] : b.powers)
    if ((result.powers[atom] += exponent) == 0) result.powers.erase(atom);
  return result;
}
Term to_power(Term term, double exponent) {
  term.coefficient = std::pow(term.coefficient, exponent);
  for (auto& [atom, power] : term.powers) power *= exponent;
  return term;
}
bool is_integer(double x) { return x == std::round(x); }

}  // namespace

bool Sums::is_scale(int number) const { return atom(number).kind == Atom::variable && is_scale_(atom(number).number); }
bool Sums::is_scale(const Term& term) const {
  return std::ranges::all_of(term.powers, [this](const auto& power) { return is_scale(power.first); });
}

int Sums::intern(Atom atom) {
  std::string key = std::to_string(atom.kind) + ":" +
                    (atom.kind == Atom::variable   ? std::to_string(atom.number)
                     : atom.kind == Atom::function ? std::to_string(static_cast<int>(atom.operation))
                                                   : "") +
                    ":" + key_of(atom.operand);
  const auto [at, made] = numbers_.try_emplace(std::move(key), static_cast<int>(atoms_.size()));
  if (made) atoms_.push_back(std::move(atom));
  return at->second;
}

/// a + factor b, like terms collected; what cancels up to rounding is gone.
Sum Sums::plus(Sum a, const Sum& b, double factor) const {
  for (const Term& term : b) {
    const auto like = std::ranges::find(a, term.powers, &Term::powers);
    if (like == a.end()) {
      a.push_back(term);
      a.back().coefficient *= factor;
      if (a.size() > most_terms) throw TooLarge("it has too many terms");
      continue;
    }
    const double before = like->coefficient;
    like->coefficient += factor * term.coefficient;
    if (std::abs(like->coefficient) <= 1e-13 * std::abs(before)) a.erase(like);
  }
  return a;
}

Term Sums::as_term(const Sum& sum, double exponent) {
  if (sum.size() == 1 && (is_integer(exponent) || sum[0].coefficient > 0)) {
    // √(u²) is |u|, and no power of u
    const bool safe =
        is_integer(exponent) || std::ranges::all_of(sum[0].powers, [](const auto& p) { return !is_integer(p.second); });
    if (safe || sum[0].powers.empty() ||
        (sum[0].powers.size() == 1 && sum[0].powers.begin()->second == 1 && sum[0].coefficient == 1))
      return to_power(sum[0], exponent);
  }
  // of a sum and its multiples one is an atom: that whose smallest coefficient is 1, where it divides the others, and whose
  // constant, or else whose first term, is positive
  Sum base = sum;
  double content = 1;
  if (!base.empty())
    content = std::abs(
        std::ranges::min_element(base, {}, [](const Term& t) { return std::abs(t.coefficient); })->coefficient);
  if (!std::ranges::all_of(base, [&](const Term& t) {
        return std::abs(t.coefficient / content - std::round(t.coefficient / content)) < 1e-12;
      }))
    content = 1;
  if (is_integer(exponent)) {
    const auto constant = std::ranges::find_if(base, [](const Term& t) { return t.powers.empty(); });
    const Term& leading = constant != base.end()
                              ? *constant
                              : *std::ranges::min_element(base, {}, [](const Term& t) { return t.powers; });
    if (leading.coefficient < 0) content = -content;
  }
  // (a − b)/k: the scales that all terms have
  Term scales{1, base.empty() ? std::map<int, double>{} : base[0].powers};
  std::erase_if(scales.powers, [&](const auto& power) {
    return !is_scale(power.first) || !std::ranges::all_of(base, [&](const Term& t) {
      const auto here = t.powers.find(power.first);
      return here != t.powers.end() && here->second == power.second;
    });
  });
  for (Term& term : base) {
    term.coefficient /= content;
    for (const auto& power : scales.powers) term.powers.erase(power.first);
  }
  const double factor = std::pow(content, exponent);
  return product(to_power(scales, exponent),
                 {factor, {{intern({Atom::sum, 0, Operation::sin, std::move(base)}), exponent}}});
}

Sum Sums::times(const Sum& a, const Sum& b) {
  if (a.empty() || b.empty()) return {};
  const auto distribute = [](const Sum& sum, const Term& over) {
    Sum result;
    for (const Term& term : sum) result.push_back(product(term, over));
    return result;
  };
  if (a.size() == 1 && (b.size() == 1 || is_scale(a[0]))) return distribute(b, a[0]);
  if (b.size() == 1 && is_scale(b[0])) return distribute(a, b[0]);
  return {product(as_term(a, 1), as_term(b, 1))};
}

Sum Sums::power(const Sum& a, double exponent) {
  if (a.empty()) return {};
  return {as_term(a, exponent)};
}

Sum Sums::function(Operation operation, const Sum& operand) {
  if (operation == Operation::sqrt) return power(operand, 0.5);
  if (operation == Operation::cosm1) return plus(function(Operation::cos, operand), {{1, {}}}, -1);
  return {{1, {{intern({Atom::function, 0, operation, operand}), 1}}}};
}

/// Terms that share the atom, a sum: what they have in common is taken out if the sum that is left is shorter, expanded.
bool Sums::take_out(Sum& sum, int number) {
  std::vector<std::size_t> sharing;
  for (std::size_t n = 0; n < sum.size(); ++n)
    if (sum[n].powers.contains(number)) sharing.push_back(n);
  if (sharing.size() < 2) return false;
  Term common{1, sum[sharing[0]].powers};
  for (const std::size_t n : sharing)
    for (auto power = common.powers.begin(); power != common.powers.end();) {
      const auto here = sum[n].powers.find(power->first);
      if (here == sum[n].powers.end() || (here->second > 0) != (power->second > 0)) power = common.powers.erase(power);
      // the lower one: of 1/u and 1/u² that is 1/u²
      else power->second = std::min(power->second, here->second), ++power;
    }
  if (common.powers.empty()) return false;
  const Sum operand = atom(number).operand;
  Sum inner;
  for (const std::size_t n : sharing) {
    Term rest = product(sum[n], to_power(common, -1));
    const auto left = rest.powers.find(number);
    const double exponent = left == rest.powers.end() ? 0 : left->second;
    if (exponent != 0 && exponent != 1) return false;
    if (exponent == 1) {
      rest.powers.erase(left);
      for (const Term& term : operand) inner = plus(std::move(inner), {product(term, rest)}, 1);
    } else inner = plus(std::move(inner), {rest}, 1);
  }
  if (inner.size() > sharing.size()) return false;
  for (auto n = sharing.rbegin(); n != sharing.rend(); ++n) sum.erase(sum.begin() + static_cast<std::ptrdiff_t>(*n));
  if (!inner.empty()) sum = plus(std::move(sum), times({common}, with_common_factors(std::move(inner))), 1);
  return true;
}

/// 1 − u/(1 + u) as 1/(1 + u): where some terms have the atom, a sum, in the denominator, and the numerator of all is no
/// longer than they are.
bool Sums::over_one_denominator(Sum& sum, int number) {
  double lowest = 0;
  for (const Term& term : sum)
    if (const auto here = term.powers.find(number); here != term.powers.end()) lowest = std::min(lowest, here->second);
  if (lowest != -1) return false;
  const Sum operand = atom(number).operand;
  Sum numerator;
  for (const Term& term : sum)
    if (term.powers.contains(number)) numerator = plus(std::move(numerator), {product(term, {1, {{number, 1}}})}, 1);
    else
      for (const Term& part : operand) numerator = plus(std::move(numerator), {product(part, term)}, 1);
  if (numerator.size() > sum.size()) return false;
  sum = times(with_common_factors(std::move(numerator)), {{1, {{number, -1}}}});
  return true;
}

Sum Sums::with_common_factors(Sum sum) {
  for (bool changed = true; changed;) {
    changed = false;
    for (std::size_t n = 0; n < sum.size() && !changed; ++n) {
      const auto powers = sum[n].powers;
      for (const auto& [number, exponent] : powers)
        if (atom(number).kind == Atom::sum &&
            (take_out(sum, number) || (sum.size() > 1 && over_one_denominator(sum, number)))) {
          changed = true;
          break;
        }
    }
  }
  // a sum to the first power among others is no factor
  for (std::size_t n = 0; n < sum.size(); ++n)
    if (sum.size() > 1 && sum[n].powers.size() == 1 && sum[n].powers.begin()->second == 1 &&
        atom(sum[n].powers.begin()->first).kind == Atom::sum) {
      const Sum operand = atom(sum[n].powers.begin()->first).operand;
      const double factor = sum[n].coefficient;
      sum.erase(sum.begin() + static_cast<std::ptrdiff_t>(n));
      sum = plus(std::move(sum), operand, factor);
      n = delf::at(-1);
    }
  return sum;
}

Sum Sums::made(const Node& n) {
  switch (n.operation) {
    case Operation::constant:
      return n.value == 0 ? Sum{} : Sum{{n.value, {}}};
    case Operation::variable:
      return {{1, {{intern({Atom::variable, n.a}), 1}}}};
    case Operation::add:
      return with_common_factors(plus(known(n.a), known(n.b), 1));
    case Operation::subtract:
      return with_common_factors(plus(known(n.a), known(n.b), -1));
    case Operation::multiply:
      return times(known(n.a), known(n.b));
    case Operation::divide:
      return times(known(n.a), power(known(n.b), -1));
    case Operation::negate:
      return plus({}, known(n.a), -1);
    case Operation::power:
      return power(known(n.a), n.value);
    default:
      return function(n.operation, known(n.a));
  }
}

Sum Sums::of(const std::vector<int>& nodes) {
  const std::vector<bool> wanted = graph_.reachable(nodes);
  for (int i = 0; i < graph_.size(); ++i)  // operands come first: nothing recurses
    if (wanted[i] && !of_node_.contains(i)) of_node_.emplace(i, made(graph_[i]));
  Sum sum;
  for (const int node : nodes) sum = plus(std::move(sum), known(node), 1);
  return with_common_factors(std::move(sum));
}

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#include "jets/expressions/modified/jet_algebra.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <set>
#include <stdexcept>

#include "lattice/index.hpp"

namespace delf::expressions {
namespace {

constexpr double rounding = 1e-12;

bool is_natural(double e) { return e > 0 && e == std::round(e); }

/// a · b^factor, atoms in order.
Monomial joined(const Monomial& a, const Monomial& b, double factor = 1) {
  Monomial product;
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() || j != b.end()) {
    if (j == b.end() || (i != a.end() && i->first < j->first)) product.push_back(*i++);
    else if (i == a.end() || j->first < i->first) product.emplace_back(j->first, factor * j->second), ++j;
    else {
      if (const double e = i->second + factor * j->second; std::abs(e) > rounding) product.emplace_back(i->first, e);
      ++i, ++j;
    }
  }
  return product;
}
Monomial with_exponent(Monomial m, int atom, double change) { return joined(m, {{atom, change}}); }

double exponent_of(const Monomial& m, int atom) {
  const auto at = std::ranges::find(m, atom, &std::pair<int, double>::first);
  return at == m.end() ? 0 : at->second;
}
bool divides(const Monomial& part, const Monomial& m) {
  return std::ranges::all_of(part, [&](const auto& p) { return exponent_of(m, p.first) >= p.second; });
}

std::string key_of(const JetSum& sum) {
  std::string key;
  for (const auto& [monomial, c] : sum) {
    char number[32];
    std::snprintf(number, sizeof number, "%.12g", c.value);
    key += number;
    for (const auto& [atom, e] : monomial) {
      std::snprintf(number, sizeof number, "*%d^%.6g", atom, e);
      key += number;
    }
    key += '+';
  }
  return key;
}

}  // namespace

double JetAlgebra::order(const Monomial& m) const {
  double sum = 0;
  for (const auto& [atom, e] : m) sum += orders_[at(atom)] * e;
  return sum;
}

int JetAlgebra::intern(Atom atom) {
  const char* kinds = "vfs";
  std::string key(1, kinds[atom.kind]);
  key += atom.kind == Atom::variable   ? std::to_string(atom.number)
         : atom.kind == Atom::function ? std::to_string(static_cast<int>(atom.operation))
                                       : "";
  key += ':' + key_of(atom.operand);
  const auto [place, made] = numbers_.try_emplace(std::move(key), static_cast<int>(atoms_.size()));
  if (!made) return place->second;
  std::set<int> variables;
  if (atom.kind == Atom::variable) variables.insert(atom.number);
  for (const auto& [monomial, c] : atom.operand)
    for (const auto& power : monomial)
      variables.insert(depends_[at(power.first)].begin(), depends_[at(power.first)].end());
  orders_.push_back(atom.kind == Atom::variable && atom.number >= 0 ? order_of_(atom.number) : 0);
  depends_.emplace_back(variables.begin(), variables.end());
  atoms_.push_back(std::move(atom));
  return place->second;
}

/// Adds a term in the one form that equal terms have: natural powers of sums multiplied out, cos² by sin², cosh² by sinh²,
/// and x² (x² + y²)^e for a negative e by y² (x² + y²)^e.
void JetAlgebra::insert(JetSum& to, const Monomial& m, Coefficient c) {
  if (c.value == 0 || order(m) > highest_ + 0.5) return;
  if (++operations_ > most_operations) throw TooLarge("the modified Lagrangian takes too many operations");
  for (const auto& [number, e] : m) {
    const Atom& atom = atoms_[at(number)];
    if (atom.kind == Atom::variable) continue;
    if (atom.kind == Atom::sum && e >= 1) {
      const Monomial rest = with_exponent(m, number, -1);
      const JetSum operand = atom.operand;
      for (const auto& [term, of] : operand)
        insert(to, joined(rest, term), {c.value * of.value, c.size * std::abs(of.value)});
      return;
    }
    if (atom.kind == Atom::sum && e < 0 && !atom.leading.empty() && divides(atom.leading, m)) {
      const double over = 1 / atom.leading_coefficient;
      const Monomial rest = joined(m, atom.leading, -1), leading = atom.leading;
      const JetSum operand = atom.operand;
      insert(to, with_exponent(rest, number, 1), {c.value * over, c.size * std::abs(over)});
      for (const auto& [term, of] : operand)
        if (term != leading)
          insert(to, joined(rest, term), {-c.value * over * of.value, c.size * std::abs(over * of.value)});
      return;
    }
    if (atom.kind == Atom::function && e >= 2 &&
        (atom.operation == Operation::cos || atom.operation == Operation::cosh)) {
      const bool circular = atom.operation == Operation::cos;
      const Monomial rest = with_exponent(m, number, -2);
      const int other = intern(
          {.kind = Atom::function, .operation = circular ? Operation::sin : Operation::sinh, .operand = atom.operand});
      insert(to, rest, c);
      insert(to, with_exponent(rest, other, 2), {circular ? -c.value : c.value, c.size});
      return;
    }
  }
  const auto [place, made] = to.try_emplace(m, c);
  if (made) {
    if (to.size() > most_terms) throw TooLarge("the modified Lagrangian has too many terms");
    return;
  }
  Coefficient& sum = place->second;
  sum.value += c.value, sum.size += c.size;
  if (std::abs(sum.value) <= rounding * sum.size) to.erase(place);
}

JetSum JetAlgebra::constant(double value) {
  if (value == 0) return {};
  return {{{}, {value, std::abs(value)}}};
}
JetSum JetAlgebra::variable(int number) {
  JetSum sum;
  insert(sum, {{atom_of(number), 1}}, {1, 1});
  return sum;
}

void JetAlgebra::add(JetSum& to, const JetSum& sum, double factor) {
  for (const auto& [m, c] : sum) insert(to, m, {factor * c.value, std::abs(factor) * c.size});
}
JetSum JetAlgebra::times(const JetSum& sum, double factor) const {
  if (factor == 0) return {};
  JetSum product = sum;
  for (auto& [m, c] : product) c.value *= factor, c.size *= std::abs(factor);
  return product;
}
JetSum JetAlgebra::times(const JetSum& a, const JetSum& b) {
  JetSum product;
  std::vector<double> orders;
  for (const auto& [m, c] : b) orders.push_back(order(m));
  for (const auto& [m, c] : a) {
    const double left = order(m);
    std::size_t n = 0;
    for (const auto& [m2, c2] : b)
      if (left + orders[n++] <= highest_ + 0.5) insert(product, joined(m, m2), {c.value * c2.value, c.size * c2.size});
  }
  return product;
}

JetSum JetAlgebra::power(const JetSum& base, double exponent) {
  if (exponent == 0) return constant(1);
  if (exponent == 1) return base;
  if (base.empty()) {
    if (exponent < 0) throw std::domain_error("a power of zero");
    return {};
  }
  if (is_natural(exponent) && exponent <= 64) {
    JetSum product = base;
    for (int n = 1; n < static_cast<int>(exponent); ++n) product = times(product, base);
    return product;
  }
  const auto& [m, c] = *base.begin();
  if (base.size() == 1 && (m.empty() || exponent == std::round(exponent)) && (c.value > 0 || !m.empty())) {
    JetSum sum;
    const double value = std::pow(c.value, exponent);
    insert(sum, joined({}, m, exponent), {value, std::abs(value)});
    return sum;
  }
  // c u^e (x + …)^e: what all terms have in common is taken out
  if (exponent == std::round(exponent)) {
    Monomial common = base.begin()->first;
    for (const auto& [term, of] : base)
      std::erase_if(common, [&](auto& p) { return exponent_of(term, p.first) != p.second; });
    if (!common.empty()) {
      JetSum rest, factor;
      for (const auto& [term, of] : base) rest.emplace(joined(term, common, -1), of);
      const JetSum inverse = power(rest, exponent);
      for (const auto& [term, of] : inverse) insert(factor, joined(term, common, exponent), of);
      return factor;
    }
  }
  // 1 is the coefficient of one term
  double content = std::prev(base.end())->second.value;
  if (exponent != std::round(exponent)) content = std::abs(content);
  const JetSum normal = times(base, 1 / content);
  Atom atom{.kind = Atom::sum, .operand = normal};
  for (const auto& [term, of] : normal) {  // the term that is highest in variables, if it is a product of them
    const bool product = !term.empty() && std::ranges::all_of(term, [&](const auto& p) {
      return atoms_[at(p.first)].kind == Atom::variable && is_natural(p.second);
    });
    if (product && (atom.leading.empty() || term > atom.leading)) {
      atom.leading = term;
      atom.leading_coefficient = of.value;
    }
  }
  for (const auto& [term, of] : normal)  // no other term has it as a factor, or its place is never free of it
    if (term != atom.leading && !atom.leading.empty() && divides(atom.leading, term)) {
      atom.leading.clear();
      break;
    }
  JetSum sum;
  const double factor = std::pow(content, exponent);
  insert(sum, {{intern(std::move(atom)), exponent}}, {factor, std::abs(factor)});
  return sum;
}

JetSum JetAlgebra::apply(Operation operation, const JetSum& operand) {
  if (operation == Operation::sqrt) return power(operand, 0.5);
  if (operation == Operation::cosm1) {
    JetSum sum = apply(Operation::cos, operand);
    add(sum, constant(-1));
    return sum;
  }
  if (operand.empty()) return constant(expressions::apply(operation, 0));
  if (operand.size() == 1 && operand.begin()->first.empty())
    return constant(expressions::apply(operation, operand.begin()->second.value));
  JetSum sum;
  insert(sum, {{intern({.kind = Atom::function, .operation = operation, .operand = operand}), 1}}, {1, 1});
  return sum;
}

JetSum JetAlgebra::of(const Graph& graph, int root, const std::function<JetSum(int)>& in_place_of) {
  const std::vector<bool> wanted = graph.reachable({root});
  std::vector<JetSum> made(at(root) + 1);
  for (int i = 0; i <= root; ++i) {
    if (!wanted[at(i)]) continue;
    const Node& n = graph[i];
    JetSum& to = made[at(i)];
    const auto a = [&]() -> const JetSum& { return made[at(n.a)]; };
    const auto b = [&]() -> const JetSum& { return made[at(n.b)]; };
    switch (n.operation) {
      case Operation::constant:
        to = constant(n.value);
        break;
      case Operation::variable:
        to = in_place_of(n.a);
        break;
      case Operation::add:
      case Operation::subtract:
        to = a();
        add(to, b(), n.operation == Operation::add ? 1 : -1);
        break;
      case Operation::multiply:
        to = times(a(), b());
        break;
      case Operation::divide:
        to = times(a(), power(b(), -1));
        break;
      case Operation::negate:
        to = times(a(), -1);
        break;
      case Operation::power:
        to = power(a(), n.value);
        break;
      default:
        to = apply(n.operation, a());
    }
  }
  return made[at(root)];
}

int JetAlgebra::node(Graph& graph, const JetSum& sum) const {
  int total = graph.constant(0);
  for (const auto& [m, c] : sum) {
    int product = graph.constant(c.value);
    for (const auto& [number, e] : m) {
      const Atom& a = atoms_[at(number)];
      const int base = a.kind == Atom::variable   ? graph.variable(a.number)
                       : a.kind == Atom::function ? graph.apply(a.operation, node(graph, a.operand))
                                                  : node(graph, a.operand);
      product = graph.multiply(product, graph.power(base, e));
    }
    total = graph.add(total, product);
  }
  return total;
}

JetSum JetAlgebra::atom_to(int number, double exponent) {
  JetSum sum;
  insert(sum, exponent == 0 ? Monomial{} : Monomial{{number, exponent}}, {1, 1});
  return sum;
}

/// f′(u) as a sum.
JetSum JetAlgebra::derivative_of_function(Operation f, const JetSum& u) {
  JetSum sum;
  switch (f) {
    case Operation::sin:
      return apply(Operation::cos, u);
    case Operation::cos:
      return times(apply(Operation::sin, u), -1);
    case Operation::tan:
      sum = power(apply(f, u), 2);
      add(sum, constant(1));
      return sum;
    case Operation::exp:
      return apply(f, u);
    case Operation::log:
      return power(u, -1);
    case Operation::sinh:
      return apply(Operation::cosh, u);
    case Operation::cosh:
      return apply(Operation::sinh, u);
    case Operation::tanh:
      sum = times(power(apply(f, u), 2), -1);
      add(sum, constant(1));
      return sum;
    case Operation::atan:
      sum = power(u, 2);
      add(sum, constant(1));
      return power(sum, -1);
    default:
      throw std::logic_error("delf: a function without a derivative");
  }
}

JetSum JetAlgebra::derive(const JetSum& sum, Derivation& d) {
  JetSum result;
  for (const auto& [m, c] : sum)
    for (const auto& [number, e] : m) {
      if (!d.known.contains(number)) {
        const Atom a = atoms_[at(number)];
        d.known[number] = a.kind == Atom::variable ? d.of_variable(a.number)
                          : a.kind == Atom::sum
                              ? derive(a.operand, d)
                              : times(derivative_of_function(a.operation, a.operand), derive(a.operand, d));
      }
      const JetSum& inner = d.known.at(number);
      if (inner.empty()) continue;
      const Monomial rest = with_exponent(m, number, -1);
      for (const auto& [term, of] : inner)
        insert(result, joined(rest, term), {c.value * e * of.value, c.size * std::abs(e) * of.size});
    }
  return result;
}
JetSum JetAlgebra::by(const JetSum& sum, int variable) {
  Derivation d{[&](int v) { return constant(v == variable ? 1 : 0); }};
  return derive(sum, d);
}

/// f(u + Δ) − f(u) of an atom.
JetSum JetAlgebra::difference_of(int number, Shift& shift) {
  const Atom a = atoms_[at(number)];
  if (a.kind == Atom::variable) return shift.by(a.number);
  JetSum by = shifted(a.operand, shift);
  add(by, a.operand, -1);
  if (a.kind == Atom::sum || by.empty()) return by;
  // Σ f⁽ⁿ⁾(u) Δⁿ/n!; derivatives by a variable that nothing else is called
  constexpr int dummy = -1;
  JetSum f = apply(a.operation, variable(dummy)), result, product = constant(1);
  for (int n = 1; n <= highest_; ++n) {
    f = this->by(f, dummy);
    product = times(times(product, by), 1.0 / n);
    if (product.empty()) break;
    add(result, times(substituted(f, {{dummy, a.operand}}), product));
  }
  return result;
}

JetSum JetAlgebra::shifted(const JetSum& sum, Shift& shift) {
  JetSum result;
  for (const auto& [m, c] : sum) {
    JetSum product = constant(c.value);
    for (const auto& [number, e] : m) {
      if (!shift.known.contains(number)) shift.known[number] = difference_of(number, shift);
      const JetSum by = shift.known.at(number);
      // (a + Δ)^e = Σ (e over n) a^{e−n} Δⁿ
      JetSum factor = atom_to(number, e), change = constant(1);
      double binomial = 1;
      for (int n = 1; n <= highest_; ++n) {
        binomial *= (e - n + 1) / n;
        change = times(change, by);
        if (binomial == 0 || change.empty()) break;
        add(factor, times(times(atom_to(number, e - n), change), binomial));
      }
      product = times(product, factor);
    }
    add(result, product);
  }
  return result;
}

JetSum JetAlgebra::substituted(const JetSum& sum, const std::map<int, JetSum>& in_place_of) {
  const auto is_touched = [&](int number) {
    return std::ranges::any_of(depends_[at(number)], [&](int v) { return in_place_of.contains(v); });
  };
  std::map<int, JetSum> known;
  JetSum result;
  for (const auto& [m, c] : sum) {
    Monomial untouched;  // first, for it may have negative powers of what is small
    for (const auto& power : m)
      if (!is_touched(power.first)) untouched.push_back(power);
    JetSum product{{untouched, c}};
    for (const auto& [number, e] : m) {
      if (!is_touched(number)) continue;
      if (!known.contains(number)) {
        const Atom a = atoms_[at(number)];
        if (a.kind == Atom::variable) known[number] = in_place_of.at(a.number);
        else {
          const JetSum operand = substituted(a.operand, in_place_of);
          known[number] = a.kind == Atom::sum ? operand : apply(a.operation, operand);
        }
      }
      // factor by factor: a power by itself may be beyond the highest order
      if (is_natural(e))
        for (int n = 0; n < static_cast<int>(e); ++n) product = times(product, known.at(number));
      else product = times(product, power(known.at(number), e));
    }
    add(result, product);
  }
  return result;
}

JetSum JetAlgebra::of_order(const JetSum& sum, int wanted) const {
  JetSum part;
  for (const auto& [m, c] : sum)
    if (std::abs(order(m) - wanted) < 0.5) part.emplace(m, c);
  return part;
}

bool JetAlgebra::depends(const JetSum& sum, const std::function<bool(int)>& is_wanted) const {
  return std::ranges::any_of(sum, [&](const auto& term) {
    return std::ranges::any_of(term.first,
                               [&](const auto& p) { return std::ranges::any_of(depends_[at(p.first)], is_wanted); });
  });
}

}  // namespace delf::expressions

// SPDX-License-Identifier: MIT
#include "jets/expressions/print.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <utility>

namespace delf::expressions {
namespace {

constexpr std::array<std::pair<Operation, const char*>, 10> function_names{{{Operation::sin, "sin"},
                                                                            {Operation::cos, "cos"},
                                                                            {Operation::tan, "tan"},
                                                                            {Operation::exp, "exp"},
                                                                            {Operation::log, "log"},
                                                                            {Operation::sinh, "sinh"},
                                                                            {Operation::cosh, "cosh"},
                                                                            {Operation::tanh, "tanh"},
                                                                            {Operation::atan, "atan"},
                                                                            {Operation::cosm1, "cosm1"}}};

/// A number as p/q, where a fraction of small numbers is as near as rounding allows; else q = 1.
struct Fraction {
  double p, q;
};
Fraction fraction(double value) {
  for (int q = 1; q <= 1000; ++q) {
    const double p = std::round(value * q);
    if (std::abs(p) < 1e6 && p != 0 && std::abs(value - p / q) <= 4e-15 * std::abs(value))
      return {p, static_cast<double>(q)};
  }
  return {value, 1};
}
std::string digits(double value) {
  std::array<char, 40> text;
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

class Printer {
 public:
  Printer(const Sums& sums, const Naming& naming, Notation notation, const std::function<bool(int)>& collected)
      : sums_(sums), naming_(naming), latex_(notation == Notation::latex), collected_(collected) {}

  std::string sum(Sum terms) {
    if (terms.empty()) return "0";
    std::ranges::stable_sort(terms, std::ranges::greater{},
                             [this](const Term& t) { return std::pair(rank(t), t.coefficient > 0); });
    std::string text;
    const auto append = [&](bool negative, const std::string& term) {
      text += text.empty() ? (negative ? "-" : "") : negative ? " - " : " + ";
      text += term;
      if (text.size() > most_printed) throw TooLarge("it is too long to print");
    };
    std::vector<bool> done(terms.size(), false);
    for (std::size_t n = 0; n < terms.size(); ++n) {
      if (done[n]) continue;
      std::vector<std::size_t> alike{n};
      if (const auto rest = without_collected(terms[n]))
        for (std::size_t m = n + 1; m < terms.size(); ++m)
          if (const auto other = without_collected(terms[m]); !done[m] && other && *other == *rest) alike.push_back(m);
      // content · (y₁ + 2y₂ + …) · rest
      double content = std::abs(terms[n].coefficient);
      for (const std::size_t m : alike) content = std::min(content, std::abs(terms[m].coefficient));
      if (alike.size() == 1 || (content == 1 && without_collected(terms[n])->empty())) {
        append(terms[n].coefficient < 0, product(terms[n]));
        continue;
      }
      if (terms[n].coefficient < 0) content = -content;
      Sum inner;
      for (const std::size_t m : alike) {
        done[m] = true;
        inner.push_back({terms[m].coefficient / content, {}});
        for (const auto& power : terms[m].powers)
          if (is_collected(power.first)) inner.back().powers.insert(power);
      }
      append(content < 0, product({content, *without_collected(terms[n])}, bracket(sum(inner))));
    }
    return text;
  }

 private:
  bool is_collected(int atom) const {
    return sums_.atom(atom).kind == Atom::variable && collected_(sums_.atom(atom).number);
  }
  /// The other factors of a term with one collected variable to the first power, all of them scales or parameters.
  std::optional<std::map<int, double>> without_collected(const Term& term) const {
    std::map<int, double> rest;
    int found = 0;
    for (const auto& power : term.powers)
      if (is_collected(power.first) && power.second == 1) ++found;
      else if (sums_.atom(power.first).kind == Atom::variable && !is_collected(power.first)) rest.insert(power);
      else return std::nullopt;
    return found == 1 ? std::optional(rest) : std::nullopt;
  }
  int rank(const Term& term) const {
    int highest = 0;
    for (const auto& [number, exponent] : term.powers)
      if (sums_.atom(number).kind == Atom::variable)
        highest = std::max(highest, naming_.rank(sums_.atom(number).number));
    return highest;
  }

  std::string bracket(const std::string& inside) const {
    return latex_ ? "\\left(" + inside + "\\right)" : "(" + inside + ")";
  }

  /// A sum of equal coefficients as (a + b)/n.
  std::string sum_as_factor(const Sum& terms) {
    const double first = terms[0].coefficient;
    const bool equal = terms.size() > 1 && std::ranges::all_of(terms, [&](const Term& t) {
                         return std::abs(std::abs(t.coefficient) - std::abs(first)) <= 1e-14 * std::abs(first);
                       });
    if (!equal || std::abs(first) == 1) return bracket(sum(terms));
    return bracket(sum_over(terms, std::abs(first)));
  }
  std::string sum_over(Sum terms, double content) {
    for (Term& term : terms) term.coefficient /= content;
    return product({content, {}}, bracket(sum(std::move(terms))));
  }
  std::string operand(const Sum& terms) {
    const double first = terms.empty() ? 1 : std::abs(terms[0].coefficient);
    const bool equal = terms.size() > 1 && first != 1 && std::ranges::all_of(terms, [&](const Term& t) {
                         return std::abs(std::abs(t.coefficient) - first) <= 1e-14 * first;
                       });
    return equal ? sum_over(terms, first) : sum(terms);
  }

  std::string factor(int number, double exponent) {
    const Atom& atom = sums_.atom(number);
    std::string base;
    if (atom.kind == Atom::variable) base = naming_.name(atom.number);
    else if (atom.kind == Atom::sum) {
      if (exponent == 0.5)
        return latex_ ? "\\sqrt{" + operand(atom.operand) + "}" : "sqrt(" + operand(atom.operand) + ")";
      base = sum_as_factor(atom.operand);
    } else {
      const auto name =
          std::ranges::find(function_names, atom.operation, [](const auto& f) { return f.first; })->second;
      const bool known = atom.operation != Operation::atan;
      std::string f = latex_ ? (known ? "\\" : "\\arctan") + std::string(known ? name : "") : std::string(name);
      if (latex_ && exponent != 1) return f + "^{" + number_text(exponent) + "}" + bracket(operand(atom.operand));
      base = f + bracket(operand(atom.operand));
    }
    if (exponent == 0.5) return latex_ ? "\\sqrt{" + base + "}" : "sqrt(" + base + ")";
    if (exponent == 1) return base;
    if (latex_)
      return (base.find('^') == std::string::npos || base.back() == ')' ? base : "{" + base + "}") + "^{" +
             number_text(exponent) + "}";
    const std::string power = number_text(exponent);
    return base + "^" + (power.find('/') == std::string::npos ? power : "(" + power + ")");
  }

  std::string number_text(double value) const {
    const auto [p, q] = fraction(value);
    if (q == 1) return digits(p);
    return latex_ ? "\\frac{" + digits(p) + "}{" + digits(q) + "}" : digits(p) + "/" + digits(q);
  }

  static std::string without_brackets(const std::string& text) {
    constexpr std::string_view left = "\\left(", right = "\\right)";
    if (!text.starts_with(left) || !text.ends_with(right)) return text;
    const std::string inside = text.substr(left.size(), text.size() - left.size() - right.size());
    return inside.find(left) == std::string::npos ? inside : text;
  }

  std::string joined(const std::vector<std::string>& factors) const {
    std::string text;
    for (const std::string& one : factors) text += (text.empty() ? "" : latex_ ? "\\," : "*") + one;
    return text;
  }

  /// The absolute value of a product, with one more factor of text if it is given.
  std::string product(const Term& term, const std::string& further = {}) {
    std::vector<std::string> above, below;
    const auto [p, q] = fraction(std::abs(term.coefficient));
    if (p != 1) above.push_back(digits(p));
    if (q != 1) below.push_back(digits(q));
    // plain variables first, then functions and sums
    for (const auto kind : {Atom::variable, Atom::function, Atom::sum})
      for (const auto& [number, exponent] : term.powers)
        if (sums_.atom(number).kind == kind)
          (exponent > 0 ? above : below).push_back(factor(number, std::abs(exponent)));
    if (!further.empty()) above.push_back(further);
    if (above.empty()) above.emplace_back("1");
    if (latex_ && !below.empty())  // a fraction needs no brackets
      for (auto* part : {&above, &below})
        if (part->size() == 1 && further.empty()) part->front() = without_brackets(part->front());
    if (below.empty()) return joined(above);
    if (latex_) {
      if (!further.empty()) {  // 1/h² (…)
        above.pop_back();
        return "\\frac{" + (above.empty() ? "1" : joined(above)) + "}{" + joined(below) + "}" + further;
      }
      return "\\frac{" + joined(above) + "}{" + joined(below) + "}";
    }
    return joined(above).append(1, '/').append(below.size() == 1 ? below[0] : bracket(joined(below)));
  }

  const Sums& sums_;
  const Naming& naming_;
  bool latex_;
  const std::function<bool(int)>& collected_;
};

}  // namespace

std::string printed(const Sums& sums, const Sum& sum, const Naming& naming, Notation notation,
                    const std::function<bool(int)>& collected) {
  return Printer(sums, naming, notation, collected).sum(sum);
}

std::string latex_name(std::string_view name) {
  constexpr std::array<std::string_view, 24> greek{
      "alpha", "beta", "gamma", "delta", "epsilon", "zeta",    "eta", "theta", "iota", "kappa", "lambda", "mu",
      "nu",    "xi",   "rho",   "sigma", "tau",     "upsilon", "phi", "chi",   "psi",  "omega", "pi",     "varphi"};
  const auto end_of_letters = std::min(name.find_first_of("0123456789_"), name.size());
  const std::string_view head = name.substr(0, end_of_letters);
  std::string rest(name.substr(end_of_letters));
  if (!rest.empty() && rest.front() == '_') rest.erase(0, 1);
  std::erase(rest, '_');
  std::string text = head == "phi"                                   ? "\\varphi"
                     : std::ranges::find(greek, head) != greek.end() ? std::string(1, '\\').append(head)
                     : head.size() > 1                               ? "\\mathrm{" + std::string(head) + "}"
                                                                     : std::string(head);
  return rest.empty() ? text : text + "_{" + rest + "}";
}

}  // namespace delf::expressions

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

/// Elements of MathML. Factors follow each other without a sign, which a reader hears as "times".
std::string row(const std::string& inside) { return "<mrow>" + inside + "</mrow>"; }
std::string operator_sign(const char* sign) { return "<mo>" + std::string(sign) + "</mo>"; }
constexpr auto invisible_times = "\u2062", apply_function = "\u2061", minus = "\u2212";

class Printer {
 public:
  Printer(const Sums& sums, const Naming& naming, Notation notation, const std::function<bool(int)>& collected)
      : sums_(sums),
        naming_(naming),
        latex_(notation == Notation::latex),
        mathml_(notation == Notation::mathml),
        collected_(collected) {}

  std::string sum(Sum terms) {
    if (terms.empty()) return number_text(0);
    std::ranges::stable_sort(terms, std::ranges::greater{},
                             [this](const Term& t) { return std::pair(rank(t), t.coefficient > 0); });
    std::string text;
    const bool outermost = std::exchange(outermost_, false);
    const auto append = [&](bool negative, const std::string& term) {
      if (!mathml_) text += text.empty() ? (negative ? "-" : "") : negative ? " - " : " + ";
      else if (negative || !text.empty())
        text.append(outermost && !text.empty() ? "\n" : "").append(operator_sign(negative ? minus : "+"));
      text += term;
      if (text.size() > (mathml_ ? 12 : 1) * most_printed) throw TooLarge("it is too long to print");
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
    if (mathml_) return row(operator_sign("(") + inside + operator_sign(")"));
    return latex_ ? "\\left(" + inside + "\\right)" : "(" + inside + ")";
  }
  std::string root(const std::string& inside) const {
    if (mathml_) return "<msqrt>" + inside + "</msqrt>";
    return (latex_ ? "\\sqrt{" : "sqrt(") + inside + (latex_ ? "}" : ")");
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
      if (exponent == 0.5) return root(operand(atom.operand));
      base = sum_as_factor(atom.operand);
    } else {
      const auto name =
          std::ranges::find(function_names, atom.operation, [](const auto& f) { return f.first; })->second;
      if (mathml_) return function_in_mathml(name, operand(atom.operand), exponent);
      const bool known = atom.operation != Operation::atan;
      std::string f = latex_ ? (known ? "\\" : "\\arctan") + std::string(known ? name : "") : std::string(name);
      if (latex_ && exponent != 1) return f + "^{" + number_text(exponent) + "}" + bracket(operand(atom.operand));
      base = f + bracket(operand(atom.operand));
    }
    if (exponent == 0.5) return root(base);
    if (exponent == 1) return base;
    if (mathml_) return power_in_mathml(base.starts_with("<msubsup>") ? bracket(base) : base, exponent);
    if (latex_)
      return (base.find('^') == std::string::npos || base.back() == ')' ? base : "{" + base + "}") + "^{" +
             number_text(exponent) + "}";
    const std::string power = number_text(exponent);
    return base + "^" + (power.find('/') == std::string::npos ? power : "(" + power + ")");
  }

  std::string power_in_mathml(const std::string& base, double exponent) const {
    return exponent == 1 ? base : "<msup>" + base + number_text(exponent) + "</msup>";
  }
  std::string function_in_mathml(const std::string& name, const std::string& operand, double exponent) const {
    const auto applied = [&](const std::string& f) { return f + operator_sign(apply_function) + bracket(operand); };
    if (name == "cosm1")  // cos φ − 1
      return power_in_mathml(bracket(applied("<mi>cos</mi>") + operator_sign(minus) + "<mn>1</mn>"), exponent);
    return applied(power_in_mathml("<mi>" + (name == "atan" ? "arctan" : name) + "</mi>", exponent));
  }

  std::string number_digits(double value) const {
    if (!mathml_) return digits(value);
    return value < 0 ? row(operator_sign(minus) + number_digits(-value)) : "<mn>" + digits(value) + "</mn>";
  }
  std::string number_text(double value) const {
    const auto [p, q] = fraction(value);
    if (q == 1) return number_digits(p);
    if (mathml_) return "<mfrac>" + number_digits(p) + number_digits(q) + "</mfrac>";
    return latex_ ? "\\frac{" + digits(p) + "}{" + digits(q) + "}" : digits(p) + "/" + digits(q);
  }

  std::string without_brackets(const std::string& text) const {
    const std::string_view left = mathml_ ? "<mrow><mo>(</mo>" : "\\left(",
                           right = mathml_ ? "<mo>)</mo></mrow>" : "\\right)";
    if (!text.starts_with(left) || !text.ends_with(right)) return text;
    const std::string inside = text.substr(left.size(), text.size() - left.size() - right.size());
    return inside.find(left) == std::string::npos ? inside : text;
  }

  std::string joined(const std::vector<std::string>& factors) const {
    std::string text;
    for (const std::string& one : factors)
      text += (text.empty() ? "" : mathml_ ? operator_sign(invisible_times) : latex_ ? "\\," : "*") + one;
    return text;
  }

  /// The absolute value of a product, with one more factor of text if it is given.
  std::string product(const Term& term, const std::string& further = {}) {
    std::vector<std::string> above, below;
    const auto [p, q] = fraction(std::abs(term.coefficient));
    if (p != 1) above.push_back(number_digits(p));
    if (q != 1) below.push_back(number_digits(q));
    // plain variables first, then functions and sums
    for (const auto kind : {Atom::variable, Atom::function, Atom::sum})
      for (const auto& [number, exponent] : term.powers)
        if (sums_.atom(number).kind == kind)
          (exponent > 0 ? above : below).push_back(factor(number, std::abs(exponent)));
    if (!further.empty()) above.push_back(further);
    if (above.empty()) above.push_back(number_digits(1));
    const bool bar = latex_ || mathml_;
    if (bar && !below.empty())  // a fraction needs no brackets
      for (auto* part : {&above, &below})
        if (part->size() == 1 && further.empty()) part->front() = without_brackets(part->front());
    if (below.empty()) return joined(above);
    if (bar) {
      if (!further.empty()) above.pop_back();  // 1/h² (…)
      if (above.empty()) above.push_back(number_digits(1));
      const std::string numerator = joined(above), denominator = joined(below);
      return (mathml_ ? "<mfrac>" + row(numerator) + row(denominator) + "</mfrac>"
                      : "\\frac{" + numerator + "}{" + denominator + "}") +
             further;
    }
    return joined(above).append(1, '/').append(below.size() == 1 ? below[0] : bracket(joined(below)));
  }

  const Sums& sums_;
  const Naming& naming_;
  bool latex_, mathml_;
  bool outermost_ = true;  ///< no sum has been begun
  const std::function<bool(int)>& collected_;
};

}  // namespace

std::string printed(const Sums& sums, const Sum& sum, const Naming& naming, Notation notation,
                    const std::function<bool(int)>& collected) {
  return Printer(sums, naming, notation, collected).sum(sum);
}

namespace {

/// A name as papers have it: its head, which may be a Greek letter, and its subscript.
struct NameParts {
  std::string head, sub;
  const char* greek = nullptr;  ///< the letter itself
};
NameParts parts_of(std::string_view name) {
  constexpr std::array<std::pair<std::string_view, const char*>, 24> letters{
      {{"alpha", "α"}, {"beta", "β"},  {"gamma", "γ"}, {"delta", "δ"}, {"epsilon", "ε"}, {"zeta", "ζ"},
       {"eta", "η"},   {"theta", "θ"}, {"iota", "ι"},  {"kappa", "κ"}, {"lambda", "λ"},  {"mu", "μ"},
       {"nu", "ν"},    {"xi", "ξ"},    {"rho", "ρ"},   {"sigma", "σ"}, {"tau", "τ"},     {"upsilon", "υ"},
       {"phi", "φ"},   {"chi", "χ"},   {"psi", "ψ"},   {"omega", "ω"}, {"pi", "π"},      {"varphi", "φ"}}};
  const auto end_of_letters = std::min(name.find_first_of("0123456789_"), name.size());
  NameParts parts{std::string(name.substr(0, end_of_letters)), std::string(name.substr(end_of_letters))};
  if (!parts.sub.empty() && parts.sub.front() == '_') parts.sub.erase(0, 1);
  std::erase(parts.sub, '_');
  const auto letter = std::ranges::find(letters, parts.head, &std::pair<std::string_view, const char*>::first);
  if (letter != letters.end()) parts.greek = letter->second;
  return parts;
}

}  // namespace

std::string latex_name(std::string_view name) {
  const auto [head, sub, greek] = parts_of(name);
  const std::string text = head == "phi"     ? "\\varphi"
                           : greek           ? std::string(1, '\\').append(head)
                           : head.size() > 1 ? "\\mathrm{" + head + "}"
                                             : head;
  return sub.empty() ? text : text + "_{" + sub + "}";
}

std::string mathml_name(std::string_view name, const std::string& below, const std::string& above) {
  const auto [head, sub, greek] = parts_of(name);
  const std::string base = "<mi>" + (greek ? std::string(greek) : head) + "</mi>";
  const bool number = sub.find_first_not_of("0123456789") == std::string::npos;
  const std::string own = sub.empty() ? "" : number ? "<mn>" + sub + "</mn>" : "<mi>" + sub + "</mi>";
  const std::string under = row(own + (own.empty() || below.empty() ? "" : operator_sign(",")) + below);
  if (own.empty() && below.empty()) return above.empty() ? base : "<msup>" + base + row(above) + "</msup>";
  return above.empty() ? "<msub>" + base + under + "</msub>" : "<msubsup>" + base + under + row(above) + "</msubsup>";
}

std::string equals_zero(const std::string& sum, Notation notation) {
  return sum + (notation == Notation::mathml ? "<mo>=</mo><mn>0</mn>" : " = 0");
}

}  // namespace delf::expressions

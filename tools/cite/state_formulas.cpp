// SPDX-License-Identifier: MIT
#include "tools/cite/state_formulas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <string_view>
#include <vector>

#include "tools/cite/paper_text.hpp"

namespace delf {
namespace {

struct Token {
  enum Kind { name, number, sign, word, other } kind;
  std::string text;
  bool after_blank = false;
};

/// Names of formulas in LaTeX; functions among them.
const std::map<std::string, std::string>& named_in_latex() {
  static const std::map<std::string, std::string> names{{"phi", "\\varphi"},
                                                        {"psi", "\\psi"},
                                                        {"theta", "\\theta"},
                                                        {"gamma", "\\gamma"},
                                                        {"omega", "\\omega"},
                                                        {"eta", "\\eta"},
                                                        {"alpha", "\\alpha"},
                                                        {"beta", "\\beta"},
                                                        {"kappa", "\\kappa"},
                                                        {"lambda", "\\lambda"},
                                                        {"mu", "\\mu"},
                                                        {"pi", "\\pi"},
                                                        {"epsilon", "\\varepsilon"},
                                                        {"delta", "\\delta"},
                                                        {"sin", "\\sin"},
                                                        {"cos", "\\cos"},
                                                        {"tan", "\\tan"},
                                                        {"exp", "\\exp"},
                                                        {"log", "\\log"},
                                                        {"sinh", "\\sinh"},
                                                        {"cosh", "\\cosh"},
                                                        {"tanh", "\\tanh"},
                                                        {"atan", "\\arctan"},
                                                        {"asin", "\\arcsin"},
                                                        {"arccot", "\\operatorname{arccot}"},
                                                        {"am", "\\operatorname{am}"},
                                                        {"sn", "\\operatorname{sn}"},
                                                        {"cn", "\\operatorname{cn}"},
                                                        {"dn", "\\operatorname{dn}"},
                                                        {"sqrt", "\\sqrt"},
                                                        {"abs", "\\operatorname{abs}"}};
  return names;
}

/// A letter, a letter with digits, or a name of the table, with a subscript: x0, e1, phi_t, sin.
bool is_of_a_formula(const std::string& name) {
  const std::size_t underscore = name.find('_');
  std::string head = name.substr(0, underscore);
  while (!head.empty() && (head.back() == '\'' || head.back() == '~')) head.pop_back();
  if (named_in_latex().contains(head)) return true;
  return !head.empty() && std::all_of(head.begin() + 1, head.end(), [](unsigned char c) { return std::isdigit(c); });
}

std::vector<Token> tokens_of(std::string_view words) {
  std::vector<Token> tokens;
  bool blank = false;
  for (std::size_t at = 0; at < words.size();) {
    const auto c = static_cast<unsigned char>(words[at]);
    std::size_t end = at + 1;
    Token token{Token::other, {}, blank};
    if (std::isspace(c)) {
      blank = true, ++at;
      continue;
    }
    if (std::isalpha(c)) {
      while (end < words.size() && (std::isalnum(static_cast<unsigned char>(words[end])) || words[end] == '_' ||
                                    words[end] == '\'' || words[end] == '~'))
        ++end;
      token.kind = Token::name;
    } else if (std::isdigit(c) ||
               (c == '.' && end < words.size() && std::isdigit(static_cast<unsigned char>(words[end])))) {
      while (end < words.size() && (std::isdigit(static_cast<unsigned char>(words[end])) ||
                                    (words[end] == '.' && end + 1 < words.size() &&
                                     std::isdigit(static_cast<unsigned char>(words[end + 1])))))
        ++end;
      if (end + 1 < words.size() && words[end] == 'e' &&
          (std::isdigit(static_cast<unsigned char>(words[end + 1])) || words[end + 1] == '-' ||
           words[end + 1] == '+')) {
        end += 2;
        while (end < words.size() && std::isdigit(static_cast<unsigned char>(words[end]))) ++end;
      }
      token.kind = Token::number;
    } else if (std::string_view("+-*/^=()|<>").find(static_cast<char>(c)) != std::string_view::npos) {
      token.kind = Token::sign;
    }
    token.text = words.substr(at, end - at);
    if (token.kind == Token::name && !is_of_a_formula(token.text)) token.kind = Token::word;
    tokens.push_back(std::move(token));
    blank = false;
    at = end;
  }
  // the article
  for (std::size_t t = 0; t + 1 < tokens.size(); ++t)
    if (tokens[t].text == "a" && tokens[t + 1].kind == Token::word && tokens[t + 1].after_blank)
      tokens[t].kind = Token::word;
  return tokens;
}

std::string latex_of(const Token& token) {
  if (token.kind == Token::number) {
    const std::string text = number_in_paper(std::stod(token.text), 10);
    return token.text.find('e') == token.text.npos ? token.text : text.substr(1, text.size() - 2);
  }
  if (token.text == "*") return "\\,";
  if (token.kind != Token::name) return token.text;
  const std::size_t underscore = token.text.find('_');
  std::string head = token.text.substr(0, underscore), marks;
  bool tilde = false;
  for (; head.back() == '\'' || head.back() == '~'; head.pop_back())
    head.back() == '~' ? tilde = true : (marks += "'", true);
  const auto found = named_in_latex().find(head);
  std::string latex = found != named_in_latex().end() ? found->second
                      : head.size() > 1               ? fmt::format("{}_{{{}}}", head.substr(0, 1), head.substr(1))
                                                      : head;
  if (tilde) latex = fmt::format("\\tilde{{{}}}", latex);
  latex += marks;
  return underscore == token.text.npos ? latex : fmt::format("{}_{{{}}}", latex, token.text.substr(underscore + 1));
}

/// The end of the group in parentheses that begins at `at`, or of the one token there, with a minus before it.
std::size_t group_end(const std::vector<Token>& run, std::size_t at) {
  if (at < run.size() && run[at].text == "-") ++at;
  if (at + 1 < run.size() && run[at].kind == Token::name && run[at + 1].text == "(" && !run[at + 1].after_blank) ++at;
  if (at >= run.size() || run[at].text != "(") return std::min(at + 1, run.size());
  int depth = 0;
  for (; at < run.size(); ++at) {
    depth += run[at].text == "(" ? 1 : run[at].text == ")" ? -1 : 0;
    if (depth == 0) return at + 1;
  }
  return run.size();
}

std::string latex_of(const std::vector<Token>& run) {
  std::string latex;
  for (std::size_t at = 0; at < run.size(); ++at) {
    const bool is_root = run[at].text == "sqrt" && at + 1 < run.size() && run[at + 1].text == "(";
    if (!latex.empty() && run[at].after_blank) latex += " ";
    if (run[at].text == "^" || is_root) {
      const std::size_t begin = at + 1, end = group_end(run, begin);
      std::vector<Token> inside(run.begin() + static_cast<std::ptrdiff_t>(begin),
                                run.begin() + static_cast<std::ptrdiff_t>(end));
      if (inside.size() > 2 && inside.front().text == "(" && inside.back().text == ")")
        inside.erase(inside.begin()), inside.pop_back();
      latex += fmt::format("{}{{{}}}", is_root ? "\\sqrt" : "^", latex_of(inside));
      at = end - 1;
    } else {
      const std::string token = latex_of(run[at]);
      // \sin x, not \sinx
      if (!token.empty() && std::isalpha(static_cast<unsigned char>(token.front())) && !latex.empty() &&
          std::isalpha(static_cast<unsigned char>(latex.back())) && latex.rfind('\\') != latex.npos &&
          std::all_of(latex.begin() + static_cast<std::ptrdiff_t>(latex.rfind('\\')) + 1, latex.end(),
                      [](unsigned char c) { return std::isalpha(c); }))
        latex += " ";
      latex += token;
    }
  }
  return latex;
}

/// The end of the last ", " before `end` that stands in no parentheses; 0 if there is none.
std::size_t last_item(const std::string& words, std::size_t end) {
  int depth = 0;
  std::size_t begin = 0;
  for (std::size_t at = 0; at < end; ++at) {
    depth += words[at] == '(' ? 1 : words[at] == ')' ? -1 : 0;
    if (depth == 0 && words.compare(at, 2, ", ") == 0) begin = at + 2;
  }
  return begin;
}

/// "f = let s = A; B" as "f = B with s = A", for each formula by itself: "f = let s = A; B, g = let r = C; D".
std::string with_definitions_last(const std::string& words) {
  std::vector<std::string> parts;
  for (std::size_t at = 0; at <= words.size();) {
    const std::size_t end = std::min(words.find("; ", at), words.size());
    parts.push_back(words.substr(at, end - at));
    at = end + 2;
  }
  std::string text, definitions;
  constexpr std::string_view let = "let ", is_let = " = let ";
  std::string head;
  const auto put = [&](const std::string& part) {
    text += (text.empty() ? "" : "; ") + head + part + (head.empty() ? "" : " with " + definitions);
    head.clear();
  };
  for (std::string part : parts) {
    std::size_t inside = part.find(is_let);
    if (inside != part.npos) {
      if (const std::size_t begin = last_item(part, inside); !head.empty() && begin > 0) {
        put(part.substr(0, begin - 2));
        part.erase(0, begin);
        inside -= begin;
      }
      head = part.substr(0, inside + 3);
      definitions = part.substr(inside + is_let.size());
      continue;
    }
    if (!head.empty() && part.starts_with(let)) {
      definitions += ", " + part.substr(let.size());
      continue;
    }
    put(part);
  }
  return text;
}

}  // namespace

std::string with_formulas(const std::string& given) {
  const std::vector<Token> tokens = tokens_of(with_definitions_last(given));
  std::string text;
  std::vector<Token> run;
  int depth = 0;
  const auto put = [&] {
    if (run.empty()) return;
    const bool after_blank = run.front().after_blank && !text.empty();
    // what stands at the ends without a partner is no part of the formula
    std::string before, behind;
    const auto count = [&](const char* sign) { return std::ranges::count(run, sign, &Token::text); };
    while (!run.empty() && count("(") > count(")") && run.front().text == "(") before += "(", run.erase(run.begin());
    while (!run.empty() && count(")") > count("(") && run.back().text == ")") behind += ")", run.pop_back();
    const bool is_formula = std::ranges::any_of(run, [](const Token& t) {
      return t.kind == Token::name || t.text == "=" || (t.kind == Token::number && t.text.find('e') != t.text.npos);
    });
    if (after_blank) text += " ";
    text += before;
    if (is_formula) text += fmt::format("${}$", latex_of(run));
    else
      for (std::size_t t = 0; t < run.size(); ++t) text += (t > 0 && run[t].after_blank ? " " : "") + run[t].text;
    text += behind;
    run.clear();
  };
  for (const Token& token : tokens) {
    const bool in_formula = token.kind == Token::name || token.kind == Token::number || token.kind == Token::sign ||
                            (depth > 0 && !run.empty() && (token.text == ";" || token.text == ","));
    if (in_formula) {
      depth += token.text == "(" ? 1 : token.text == ")" ? -1 : 0;
      run.push_back(token);
      continue;
    }
    put();
    depth = 0;
    text += (token.after_blank && !text.empty() ? " " : "") + token.text;
  }
  put();
  return text;
}

}  // namespace delf

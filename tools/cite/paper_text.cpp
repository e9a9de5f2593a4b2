// SPDX-License-Identifier: MIT
#include "tools/cite/paper_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "tools/cite/references.hpp"
#include "tools/report/text_columns.hpp"

namespace delf {
namespace {

constexpr std::size_t width = 100;

/// Words outside of formulas, for LaTeX.
std::string escaped_for_latex(std::string_view words) {
  static const std::pair<std::string_view, std::string_view> signs[] = {{"\\", "\\textbackslash{}"},
                                                                        {"{", "\\{"},
                                                                        {"}", "\\}"},
                                                                        {"#", "\\#"},
                                                                        {"%", "\\%"},
                                                                        {"&", "\\&"},
                                                                        {"_", "\\_"},
                                                                        {"^", "\\^{}"},
                                                                        {"~", "\\~{}"},
                                                                        {"–", "--"},
                                                                        {"φ", "$\\varphi$"},
                                                                        {"θ", "$\\theta$"},
                                                                        {"ω", "$\\omega$"},
                                                                        {"λ", "$\\lambda$"},
                                                                        {"μ", "$\\mu$"},
                                                                        {"ε", "$\\varepsilon$"},
                                                                        {"Σ", "$\\Sigma$"},
                                                                        {"²", "$^2$"},
                                                                        {"³", "$^3$"},
                                                                        {"⁴", "$^4$"},
                                                                        {"−", "$-$"},
                                                                        {"∂", "$\\partial$"},
                                                                        {"ℓ", "$\\ell$"},
                                                                        {"·", "$\\cdot$"}};
  std::string text;
  while (!words.empty()) {
    const auto sign = std::ranges::find_if(signs, [&](const auto& s) { return words.starts_with(s.first); });
    text += sign == std::end(signs) ? words.substr(0, 1) : sign->second;
    words.remove_prefix(sign == std::end(signs) ? 1 : sign->first.size());
  }
  return text;
}

std::vector<std::string> keys_in(std::string_view citation) {
  std::vector<std::string> keys;
  while (!citation.empty()) {
    const std::size_t end = std::min(citation.find("; "), citation.size());
    keys.emplace_back(citation.substr(citation.starts_with('@') ? 1 : 0, end - (citation.starts_with('@') ? 1 : 0)));
    citation.remove_prefix(std::min(end + 2, citation.size()));
  }
  return keys;
}

using OfText = std::function<std::string(std::string_view)>;
using OfKeys = std::function<std::string(const std::vector<std::string>&)>;

/// Sentences with what `words`, `formula` and `citation` make of their parts.
std::string rendered_parts(std::string_view sentence, const OfText& words, const OfText& formula,
                           const OfKeys& citation) {
  std::string text;
  while (!sentence.empty()) {
    const std::size_t next = std::min({sentence.find('$'), sentence.find("[@"), sentence.size()});
    text += words(sentence.substr(0, next));
    sentence.remove_prefix(next);
    if (sentence.empty()) break;
    const bool is_formula = sentence.front() == '$';
    const std::size_t end = sentence.find(is_formula ? '$' : ']', 1);
    if (end == sentence.npos) return text + words(sentence);
    const std::string_view inside = sentence.substr(1, end - 1);
    text += is_formula ? formula(inside) : citation(keys_in(inside));
    sentence.remove_prefix(end + 1);
  }
  return text;
}

}  // namespace

void PaperText::say(const std::string& words) {
  if (!words.empty()) pieces_.emplace_back(words);
}
void PaperText::display(const std::string& latex, const std::string& plain, const std::string& mark) {
  const std::size_t aligned = latex.rfind("\n  \\end{aligned}"),
                    end = aligned == latex.npos ? latex.rfind("\n\\]") : aligned;
  Display shown{latex, plain};
  if (end != latex.npos) shown.latex.insert(end, mark);
  pieces_.emplace_back(std::move(shown));
}
void PaperText::end_paragraph() { pieces_.emplace_back(ParagraphEnd{}); }

std::vector<std::string> PaperText::cited() const {
  std::vector<std::string> keys;
  const auto nothing = [](std::string_view) { return std::string(); };
  for (const auto& piece : pieces_)
    if (const auto* sentence = std::get_if<std::string>(&piece))
      rendered_parts(*sentence, nothing, nothing, [&](const std::vector<std::string>& more) {
        for (const std::string& key : more)
          if (std::ranges::find(keys, key) == keys.end()) keys.push_back(key);
        return std::string();
      });
  return keys;
}

std::string PaperText::in(PaperFormat format) const {
  const std::vector<std::string> keys = cited();
  const auto as_it_is = [](std::string_view part) { return std::string(part); };
  const auto between_dollars = [](std::string_view part) { return fmt::format("${}$", part); };
  const auto numbered = [&](const std::vector<std::string>& some) {
    std::vector<std::ptrdiff_t> numbers;
    for (const std::string& key : some) numbers.push_back(std::ranges::find(keys, key) - keys.begin() + 1);
    return fmt::format("[{}]", fmt::join(numbers, ", "));
  };
  const auto rendered = [&](const std::string& sentence) {
    if (format == PaperFormat::latex)
      return rendered_parts(sentence, escaped_for_latex, between_dollars, [](const std::vector<std::string>& some) {
        return fmt::format("\\cite{{{}}}", fmt::join(some, ","));
      });
    if (format == PaperFormat::markdown)
      return rendered_parts(sentence, as_it_is, between_dollars, [](const std::vector<std::string>& some) {
        return fmt::format("[@{}]", fmt::join(some, "; @"));
      });
    return rendered_parts(
        sentence, as_it_is, [](std::string_view part) { return plain_formula(std::string(part)); }, numbered);
  };

  std::string text, paragraph;
  const auto put = [&] {
    for (const std::string& line : wrapped(paragraph, width))
      if (!line.empty()) text += line + "\n";
    paragraph.clear();
  };
  for (const auto& piece : pieces_) {
    if (const auto* sentence = std::get_if<std::string>(&piece)) {
      const std::string words = rendered(*sentence);
      paragraph += (paragraph.empty() || words.starts_with(',') || words.starts_with('.') ? "" : " ") + words;
    } else if (const auto* shown = std::get_if<Display>(&piece)) {
      put();
      if (format == PaperFormat::latex) text += shown->latex;
      else if (format == PaperFormat::text) text += (text.ends_with("\n\n") ? "" : "\n") + shown->plain + "\n";
      else {
        const std::size_t begin = shown->latex.find("\\[") + 2, end = shown->latex.rfind("\\]");
        text += fmt::format("\n$${}$$\n\n", std::string_view(shown->latex).substr(begin, end - begin));
      }
    } else {
      put();
      text += "\n";
    }
  }
  put();
  if (format == PaperFormat::latex) return text;
  text += format == PaperFormat::markdown ? "\n## References\n\n" : "\nReferences\n\n";
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const CitedWork* reference = find_reference(keys[k]);
    const std::string words = reference ? in_words(*reference) : "";
    const std::string head =
        format == PaperFormat::markdown ? fmt::format("- `{}`: ", keys[k]) : fmt::format("[{}] ", k + 1);
    const std::vector<std::string> lines = wrapped(head + words + ".", width);
    for (std::size_t line = 0; line < lines.size(); ++line) text += (line == 0 ? "" : "    ") + lines[line] + "\n";
  }
  return text;
}

std::string citation_of(const std::vector<std::string>& keys) {
  return keys.empty() ? "" : fmt::format(" [@{}]", fmt::join(keys, "; "));
}

std::string number_in_paper(double value, int digits) {
  const std::string text = fmt::format("{:.{}g}", value, digits);
  const std::size_t e = text.find('e');
  if (e == text.npos) return fmt::format("${}$", text);
  const std::string mantissa = text.substr(0, e);
  return fmt::format("${}10^{{{}}}$", mantissa == "1" ? "" : mantissa + "\\times", std::stoi(text.substr(e + 1)));
}
std::string equal_in_paper(const std::string& name, double value) {
  return fmt::format("${} = {}", name, number_in_paper(value).substr(1));
}
std::string error_in_paper(double value) { return number_in_paper(value, 2); }

std::string plain_formula(const std::string& latex) {
  static const std::pair<std::string_view, std::string_view> names[] = {
      {"le", "<="},       {"varphi", "phi"}, {"varepsilon", "epsilon"}, {"Delta", "Laplace "},
      {"nabla", "grad "}, {"cdot", "."},     {"operatorname", ""},      {"mathrm", ""},
      {"langle", "<"},    {"rangle", ">"},   {"arctan", "atan"}};
  std::string text, closing;  // what closes the groups that are open
  bool root = false;
  for (std::size_t at = 0; at < latex.size();) {
    const std::string_view rest = std::string_view(latex).substr(at);
    constexpr std::string_view power = "\\times10^{";
    if (rest.starts_with(power) || rest.starts_with("10^{")) {
      const std::size_t begin = rest.find('{') + 1, end = rest.find('}');
      text += (rest.front() == '1' ? "1e" : "e") + std::string(rest.substr(begin, end - begin));
      at += end + 1;
    } else if (rest.front() == '{') {
      const std::string_view group = rest.substr(0, rest.find('}'));
      const bool in_brackets =
          root || (!text.empty() && text.back() == '^' && group.find_first_of("+-*/ ") != group.npos);
      if (in_brackets) text += '(';
      closing += in_brackets ? ')' : ' ';
      root = false, ++at;
    } else if (rest.front() == '}') {
      if (!closing.empty() && closing.back() == ')') text += ')';
      if (!closing.empty()) closing.pop_back();
      ++at;
    } else if (rest.front() == '\\') {
      std::size_t end = 1;
      while (end < rest.size() && std::isalpha(static_cast<unsigned char>(rest[end]))) ++end;
      const std::string_view name = rest.substr(1, end - 1);
      const auto named = std::ranges::find(names, name, &std::pair<std::string_view, std::string_view>::first);
      if (name.empty()) text += ' ', end = std::min<std::size_t>(2, rest.size());  // \,
      else text += named == std::end(names) ? name : named->second;
      root = name == "sqrt";
      at += end;
      if (name == "le") text.insert(text.size() - 2, text.size() > 2 && text[text.size() - 3] != ' ' ? " " : "");
    } else {
      text += rest.front();
      ++at;
    }
  }
  return text;
}

std::string listed(const std::vector<std::string>& items) {
  if (items.size() < 2) return items.empty() ? "" : items[0];
  return fmt::format("{} and {}", fmt::join(items.begin(), items.end() - 1, ", "), items.back());
}

}  // namespace delf

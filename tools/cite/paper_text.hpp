// SPDX-License-Identifier: MIT
#pragma once
#include <string>
#include <variant>
#include <vector>

namespace delf {

enum class PaperFormat {
  latex,     ///< with \cite{…}, of references.bib
  markdown,  ///< with [@…], as Pandoc reads it, and formulas between dollars
  text
};

/// A text for a paper: sentences, in which formulas in LaTeX are between dollars and citations are [@key; key], and
/// displayed equations.
class PaperText {
 public:
  /// Adds a sentence, or a part of one, after a blank.
  void say(const std::string& words);
  /// Adds an equation in a line of its own, in LaTeX between \[ and \], and in plain notation; the mark ends it in LaTeX and
  /// Markdown, whose formulas are parts of sentences.
  void display(const std::string& latex, const std::string& plain, const std::string& mark = {});
  void end_paragraph();

  /// The keys that are cited, in the order of their first citation.
  std::vector<std::string> cited() const;
  /// The text; but for LaTeX, which has references.bib, with the list of references.
  std::string in(PaperFormat) const;

 private:
  struct Display {
    std::string latex, plain;
  };
  struct ParagraphEnd {};
  std::vector<std::variant<std::string, Display, ParagraphEnd>> pieces_;
};

/// " [@a; b]"; nothing for no keys.
std::string citation_of(const std::vector<std::string>& keys);
/// A number as a formula between dollars: $0.125$, $1.2\times10^{-14}$.
std::string number_in_paper(double value, int digits = 6);
/// $t = 0.125$, of a name in LaTeX.
std::string equal_in_paper(const std::string& name, double value);
/// An error or a residual: two digits.
std::string error_in_paper(double value);
/// A formula in LaTeX in the characters of a keyboard: \varphi_{tt} as phi_tt.
std::string plain_formula(const std::string& latex);
/// "one", "two and three", "one, two and three"
std::string listed(const std::vector<std::string>&);

}  // namespace delf

// SPDX-License-Identifier: MIT
#include <string>

#include "tests/catch.hpp"
#include "tests/tools/program.hpp"
#include "tools/cite/paper_text.hpp"
#include "tools/cite/state_formulas.hpp"

using namespace delf;
using testing::contains;

TEST_CASE("a paragraph is written in LaTeX, Markdown and plain text") {
  PaperText text;
  text.say("We solve the φ⁴ equation [@campbell-schonfeld-wingate-1983; delf]");
  text.display("\\[\n  \\varphi_{tt} = 0\n\\]\n", "    phi_tt = 0\n");
  text.say("with 5 % of $m = 2$ & angular_momentum.");
  CHECK(text.cited() == std::vector<std::string>{"campbell-schonfeld-wingate-1983", "delf"});
  CHECK(
      text.in(PaperFormat::latex) ==
      "We solve the $\\varphi$$^4$ equation \\cite{campbell-schonfeld-wingate-1983,delf}\n\\[\n  \\varphi_{tt} = 0\n\\]\n"
      "with 5 \\% of $m = 2$ \\& angular\\_momentum.\n");
  const std::string markdown = text.in(PaperFormat::markdown), plain = text.in(PaperFormat::text);
  CHECK(contains(markdown, "We solve the φ⁴ equation [@campbell-schonfeld-wingate-1983; @delf]\n"));
  CHECK(contains(markdown, "$$\n  \\varphi_{tt} = 0\n$$"));
  CHECK(contains(markdown, "- `delf`: The delf authors"));
  CHECK(contains(plain, "We solve the φ⁴ equation [1, 2]\n"));
  CHECK(contains(plain, "    phi_tt = 0\n"));
  CHECK(contains(plain, "with 5 % of m = 2 & angular_momentum."));
  CHECK(contains(plain, "[1] D. K. Campbell"));
}

TEST_CASE("numbers and formulas of a paper have a plain form") {
  CHECK(number_in_paper(0.125) == "$0.125$");
  CHECK(number_in_paper(1.25e-14, 3) == "$1.25\\times10^{-14}$");
  CHECK(number_in_paper(1e-14) == "$10^{-14}$");
  CHECK(error_in_paper(0.0123456) == "$0.012$");
  CHECK(equal_in_paper("h", 0.5) == "$h = 0.5$");
  CHECK(plain_formula("1.2\\times10^{-14}") == "1.2e-14");
  CHECK(plain_formula("10^{-14}") == "1e-14");
  CHECK(plain_formula("0\\le t\\le 100") == "0 <= t <= 100");
  CHECK(plain_formula("\\varphi_{tt} + \\sin\\varphi") == "phi_tt + sinphi");
  CHECK(plain_formula("\\sqrt{1 - e^{2}} \\sin E, e^{-s^{2}}") == "sqrt(1 - e^2) sin E, e^(-s^2)");
  CHECK(listed({"a", "b", "c"}) == "a, b and c");
  CHECK(listed({"a"}) == "a");
  CHECK(citation_of({}).empty());
}

TEST_CASE("formulas in the words of states are found, and written in LaTeX") {
  CHECK(with_formulas("phi = 4 atan exp(m s), m = 1, s = gamma (x - x0 - v t), x0 = 20") ==
        "$\\varphi = 4 \\arctan \\exp(m s)$, $m = 1$, $s = \\gamma (x - x_{0} - v t)$, $x_{0} = 20$");
  CHECK(
      with_formulas("a kink pi + 2 am(P (x - c t - L/8)/(L/4); kappa) on the first quarter; 1 - kappa = 1e-06") ==
      "a kink $\\pi + 2 \\operatorname{am}(P (x - c t - L/8)/(L/4); \\kappa)$ on the first quarter; $1 - \\kappa = 10^{-6}$");
  CHECK(with_formulas("exact until t = 25.5, at the wall") == "exact until $t = 25.5$, at the wall");
  CHECK(with_formulas("q = (cos E - e, sqrt(1 - e^2) sin E)") == "$q = (\\cos E - e, \\sqrt{1 - e^{2}} \\sin E)$");
  CHECK(with_formulas("phi = let s = x - 5; exp(-s^2)") == "$\\varphi = \\exp(-s^{2})$ with $s = x - 5$");
  // each formula keeps its own definitions
  CHECK(with_formulas("phi(0, x) = let w = 2; w*cos(x), phi_t(0, x) = let r = 3; r*sin(x)") ==
        "$\\varphi(0, x) = w\\,\\cos(x)$ with $w = 2$; $\\varphi_{t}(0, x) = r\\,\\sin(x)$ with $r = 3$");
  CHECK(with_formulas("phi = 2*w*tanh(w*(x - 15 - 4*w^2*t))") ==
        "$\\varphi = 2\\,w\\,\\tanh(w\\,(x - 15 - 4\\,w^{2}\\,t))$");
  CHECK(with_formulas("the Sun and the outer planets on 5 September 1994") ==
        "the Sun and the outer planets on 5 September 1994");
}

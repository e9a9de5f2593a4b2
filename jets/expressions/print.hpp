// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <string>
#include <string_view>

#include "jets/expressions/sums.hpp"

namespace delf::expressions {

enum class Notation {
  plain,  ///< as densities are written: m^2*sin(phi)
  latex,
  mathml  ///< presentation elements; every term of the outermost sum begins on a line of its own
};

/// The spelling of variables, and the order of terms.
struct Naming {
  std::function<std::string(int variable)> name;
  std::function<int(int variable)> rank = [](int) { return 0; };  ///< the highest first
};

/// Texts of more characters are given up, by TooLarge; in MathML, whose tags count, of twelve times as many.
inline constexpr std::size_t most_printed = 6000;

/// A sum of products. Terms that differ in one variable of `collected` alone stand in a bracket before their common factor:
/// (phi(j+1, i) - 2*phi(j, i) + phi(j-1, i))/h^2.
std::string printed(
    const Sums&, const Sum&, const Naming&, Notation,
    const std::function<bool(int variable)>& collected = [](int) { return false; });

/// A name such as lambda or x0 in LaTeX: \lambda, x_{0}.
std::string latex_name(std::string_view name);
/// A name in MathML, its own subscript before those given: φ with `below` and `above`, which are elements.
std::string mathml_name(std::string_view name, const std::string& below = {}, const std::string& above = {});
/// The sum and " = 0" in a notation.
std::string equals_zero(const std::string& sum, Notation);

}  // namespace delf::expressions

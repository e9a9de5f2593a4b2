// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/batch_density.hpp"

namespace delf {

/// What the names in the text of a density stand for.
struct ExpressionNames {
  std::vector<std::string> fields = {"phi"};                   ///< each with its derivatives: phi_t, phi_x, phi_tt, …
  std::vector<std::pair<std::string, double>> parameters = {};
};

/// A Lagrangian density given as text, as fast as a compiled one:
///
///     delf::Scheme{delf::hexagon, delf::expression("0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)", {.parameters = {{"m", 2}}})}
///
/// Names: the fields u and their derivatives u_t, u_x, u_tt, u_tx, u_xx, parameters, t, x, pi, and what `let w = …`
/// defines on a line of its own. Functions: sin, cos, cosm1, tan, exp, log, sqrt, sinh, cosh, tanh, atan, pow. The grammar
/// is in jets/expressions/parse.hpp. Derivatives are exact, and what is proved of the density is as for compiled ones.
///
/// Throws BadInput for `key` with line, character and a caret for what cannot be read, and for a density that does not
/// determine each of its fields.
std::shared_ptr<const BatchDensity> expression(std::string_view text, const ExpressionNames& names = {},
                                               const std::string& key = "theory.density");

/// A formula of t and x alone, such as a starting field.
class Formula {
 public:
  /// Throws BadInput for `key`.
  Formula(std::string_view text, const std::vector<std::pair<std::string, double>>& parameters, const std::string& key);
  ~Formula();
  Formula(Formula&&) noexcept;

  double operator()(double t, double x) const;
  double by_t(double t, double x) const;
  double by_x(double t, double x) const;

 private:
  struct Impl;
  std::unique_ptr<const Impl> impl_;
};

/// The value of a text without any names but pi. Throws BadInput for `key`.
double number_of(std::string_view text, const std::string& key);

/// Throws BadInput for `key` if names are no names, mean something already, or occur twice.
void check_names(const ExpressionNames&, const std::string& key_of_fields, const std::string& key_of_parameters);

}  // namespace delf

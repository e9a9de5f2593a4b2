// SPDX-License-Identifier: MIT
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/batch_density.hpp"
#include "jets/symmetry.hpp"

namespace delf {

/// The meanings of the names in the text of a density.
struct ExpressionNames {
  std::vector<std::string> fields = {"phi"};  ///< each with its derivatives: phi_t, phi_x, phi_tt, …
  std::vector<std::pair<std::string, double>> parameters = {};
};

/// The other statements of a text: symmetries, which require_symmetry() tells apart, and a constraint on the fields.
struct BesidesDensity {
  std::vector<LinearSymmetry> symmetries = {}, up_to_divergence = {};
  std::string constraint = {};
};

/// A density that knows the text it is made of.
class SymbolicDensity : public BatchDensity {
 public:
  const SymbolicDensity* formula() const override { return this; }
  const std::string& text() const { return text_; }
  const ExpressionNames& names() const { return names_; }
  /// The innermost part of the density, or of its gradient, that has no value at a jet, the variables in the order of a
  /// JetBatch: "log(phi) has no value, where phi = -0.1". Empty if all have values.
  std::string without_value(std::span<const double> jet, double t, double x) const;
  /// Symmetries that change the density by a divergence. What they conserve is not a sum over a row alone, so that they are
  /// none of symmetries().
  const std::vector<LinearSymmetry>& up_to_divergence() const { return besides_.up_to_divergence; }
  /// G of the constraint G = 0; empty if there is none.
  const std::string& constraint() const { return besides_.constraint; }

 protected:
  SymbolicDensity(std::string_view text, ExpressionNames names, BesidesDensity besides)
      : text_(text), names_(std::move(names)), besides_(std::move(besides)) {}

 private:
  bool has_values(std::span<const double> jet, double t, double x) const;

  std::string text_;
  ExpressionNames names_;
  BesidesDensity besides_;
};

/// A Lagrangian density given as text, as fast as a compiled one:
///
///     delf::Scheme{delf::hexagon, delf::expression("0.5*phi_t^2 - 0.5*phi_x^2 + m^2*(cos(phi) - 1)", {.parameters = {{"m", 2}}})}
///
/// Names: the fields u and their derivatives u_t, u_x, u_tt, u_tx, u_xx, parameters, t, x, pi, and what `let w = …`
/// defines on a line of its own. Functions: sin, cos, cosm1, tan, exp, log, sqrt, sinh, cosh, tanh, atan, pow. The grammar
/// is in jets/expressions/parse.hpp. Derivatives are exact, and what is proved of the density is as for compiled ones.
///
/// Throws BadInput for `key` with line and character for what cannot be read, and for a density that does not
/// determine each of its fields. Symmetries are taken as they are, besides the translations that the form proves.
std::shared_ptr<const SymbolicDensity> expression(std::string_view text, const ExpressionNames& names = {},
                                                  const std::string& key = "theory.density",
                                                  const BesidesDensity& = {});

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

/// The value of a text of numbers, pi and `parameters`. Throws BadInput for `key`.
double number_of(std::string_view text, const std::string& key,
                 const std::vector<std::pair<std::string, double>>& parameters = {});

/// Throws BadInput for `key` if names are no names, mean something already, or occur twice.
void check_names(const ExpressionNames&, const std::string& key_of_fields, const std::string& key_of_parameters);

}  // namespace delf

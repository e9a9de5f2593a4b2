// SPDX-License-Identifier: MIT
#include <cmath>
#include <numbers>
#include <optional>

#include "jets/expressions/expression.hpp"
#include "lattice/error.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"

namespace delf {
namespace initial {
namespace {

std::string value_key(const std::string& field) { return "initial." + field; }
std::string velocity_key(const std::string& field) { return "initial." + field + "_t"; }
std::string exact_key(const std::string& field) { return "exact." + field; }

/// One field: φ(0, x) and φ_t(0, x); or φ(t, x), which is then a solution to compare with.
struct FieldFormula {
  Formula value;
  std::optional<Formula> velocity;  ///< where the value is of t = 0 alone; none: at rest
  std::string text;
};

/// Fields by formulas of x, or of t and x. Around a circle they are continued by what they gain from 0 to L:
///
///     n = ⌊x/L⌋,   φ(t, x) = f(t, x − nL) + 2π·winding·n
///
class FormulaState final : public State {
 public:
  FormulaState(std::vector<FieldFormula> fields, bool solves, const Lattice& lattice, std::optional<int> winding)
      : fields_(std::move(fields)), exact_(solves), circle_(lattice.is_circle()), length_(lattice.length()) {
    if (circle_) winding_ = winding.value_or(static_cast<int>(std::lround(gain(fields_.front()) / turn)));
    for (const FieldFormula& f : fields_)
      if (circle_) seam_ = std::max(seam_, std::abs(gain(f) - turn * winding_));
  }

  int components() const override { return static_cast<int>(fields_.size()); }
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double n = circle_ ? std::floor(x / length_) : 0.0, s = x - n * length_;
    for (std::size_t a = 0; a < fields_.size(); ++a) {
      const FieldFormula& f = fields_[a];
      const double time = exact_ ? t : 0;
      const double phi_t = exact_ ? f.value.by_t(time, s) : f.velocity ? (*f.velocity)(0, s) : 0.0;
      out[a] = {f.value(time, s) + turn * winding_ * n, phi_t, f.value.by_x(time, s)};
    }
  }
  bool exact() const override { return exact_; }
  int winding() const override { return winding_; }
  std::string description() const override {
    std::string line = "formula:";
    for (const FieldFormula& f : fields_) line += (&f == &fields_.front() ? " " : "; ") + f.text;
    if (seam_ > 1e-8) line += "; off by " + text(seam_) + " at the seam";
    return line;
  }

 private:
  static constexpr double turn = 2 * std::numbers::pi;
  /// f(0, L) − f(0, 0)
  double gain(const FieldFormula& f) const { return f.value(0, length_) - f.value(0, 0); }

  std::vector<FieldFormula> fields_;
  bool exact_, circle_;
  double length_, seam_ = 0;
  int winding_ = 0;
};

std::unique_ptr<State> formula(const StateBuild& build) {
  // theory.NAME as NAME, and the length of space
  std::vector<std::pair<std::string, double>> numbers;
  constexpr std::string_view of_theory = "theory.";
  for (const auto& [key, value] : build.values)
    if (const double* number = std::get_if<double>(&value); number && key.starts_with(of_theory))
      numbers.emplace_back(key.substr(of_theory.size()), *number);
  if (build.lattice.space() != Space::point) numbers.emplace_back("L", build.lattice.length());

  const auto text_of = [&](const std::string& key) { return build.values.maybe<std::string>(key); };
  std::vector<FieldFormula> fields;
  std::optional<bool> all_exact;
  for (const std::string& name : build.request.fields) {
    const auto value = text_of(value_key(name)), velocity = text_of(velocity_key(name)), exact = text_of(exact_key(name));
    if (exact && (value || velocity))
      throw BadInput(exact_key(name), exact_key(name) + " = " + *exact + ": gives the start too; remove " +
                                          (value ? value_key(name) : velocity_key(name)));
    if (!exact && !value)
      throw BadInput(value_key(name), value_key(name) + ": must be given; write it as a formula of x, or " + exact_key(name) +
                                          " as one of t and x");
    if (all_exact.value_or(exact.has_value()) != exact.has_value())
      throw BadInput(exact_key(name), exact_key(name) + ": must be given for all fields or for none; complete or remove it");
    all_exact = exact.has_value();
    if (exact) fields.push_back({Formula(*exact, numbers, exact_key(name)), std::nullopt, name + " = " + *exact});
    else {
      fields.push_back({Formula(*value, numbers, value_key(name)), std::nullopt, name + "(0, x) = " + *value});
      if (velocity) {
        fields.back().velocity.emplace(*velocity, numbers, velocity_key(name));
        fields.back().text += ", " + name + "_t(0, x) = " + *velocity;
      }
    }
  }
  return std::make_unique<FormulaState>(std::move(fields), all_exact.value_or(false), build.lattice, build.request.winding);
}

std::vector<Parameter> further(const std::vector<std::string>& fields) {
  std::vector<Parameter> all;
  const auto add = [&](const std::string& key, const std::string& help) {
    all.push_back({.key = key, .fallback = std::string(), .help = help, .otherwise = "none"});
  };
  for (const std::string& name : fields) add(value_key(name), name + "(0, x), a formula of x");
  for (const std::string& name : fields) add(velocity_key(name), "its rate there; 0 if not given");
  for (const std::string& name : fields)
    add(exact_key(name), name + "(t, x), a solution to start from and to compare with");
  return all;
}

}  // namespace
}  // namespace initial

extern const StateEntry formula_state;
const StateEntry formula_state{
    .name = "formula",
    .formula = "initial.FIELD (and initial.FIELD_t) by formulas of x, or exact.FIELD by one of t and x; chosen by these keys",
    .parameters = {},
    .exact = {},
    .approximate = {},
    .place = Place::anywhere,
    .build = initial::formula,
    .any_theory = true,
    .further = initial::further};

}  // namespace delf

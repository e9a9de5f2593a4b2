// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>

#include "jets/expressions/expression.hpp"
#include "jets/expressions/formula_jet.hpp"
#include "jets/expressions/graph.hpp"
#include "lattice/error.hpp"
#include "schemes/monodromy.hpp"
#include "schemes/smooth_state.hpp"
#include "schemes/states/momenta.hpp"
#include "schemes/states/parameters.hpp"
#include "schemes/states/state_registry.hpp"
#include "schemes/theory_numbers.hpp"

namespace delf {
namespace initial {
namespace {

std::string value_key(const std::string& field) { return "initial." + field; }
std::string velocity_key(const std::string& field) { return "initial." + field + "_t"; }
constexpr auto momenta_key = "initial.p";
std::string exact_key(const std::string& field) { return "exact." + field; }

/// One field: φ(0, x) and φ_t(0, x); or φ(t, x), which is then a solution to compare with.
struct FieldFormula {
  Formula value;
  std::optional<Formula> velocity;  ///< where the value is of t = 0 alone; none: at rest
  std::string text, key, formula;
};

/// Fields by formulas of x, or of t and x. Around a circle they are continued by what they gain from 0 to L:
///
///     n = ⌊x/L⌋,   φ(t, x) = f(t, x − nL) + (2π·winding + gain) n
///
class FormulaState final : public State, public SmoothState {
 public:
  FormulaState(std::vector<FieldFormula> fields, std::vector<std::pair<std::string, double>> numbers, bool solves,
               const Lattice& lattice, const StateRequest& request)
      : fields_(std::move(fields)),
        exact_(solves),
        circle_(lattice.is_circle()),
        length_(lattice.length()),
        numbers_(std::move(numbers)) {
    if (!circle_) return;
    const bool alone = gain_of(request.values) == 0;  // of a gain in units of the field no part is taken for a winding
    winding_ = request.winding.value_or(
        alone ? static_cast<int>(std::lround(gain(fields_.front()) / (2 * std::numbers::pi))) : 0);
    monodromy_ = 2 * std::numbers::pi * winding_ + gain_of(request.values);
    double range = 0;  // of all fields: one of several may be small
    for (const FieldFormula& f : fields_) range = std::max(range, range_of(f, lattice));
    for (const FieldFormula& f : fields_) require_closed(f, range);
  }

  int components() const override { return static_cast<int>(fields_.size()); }
  void at(double t, double x, std::span<FieldPoint> out) const override {
    const double n = circle_ ? std::floor(x / length_) : 0.0, s = x - n * length_;
    for (std::size_t a = 0; a < fields_.size(); ++a) {
      const FieldFormula& f = fields_[a];
      const double time = exact_ ? t : 0;
      const double phi_t = exact_ ? f.value.by_t(time, s) : f.velocity ? (*f.velocity)(0, s) : 0.0;
      out[a] = {f.value(time, s) + monodromy_ * n, phi_t, f.value.by_x(time, s)};
    }
  }
  bool exact() const override { return exact_; }
  std::optional<std::vector<double>> jet(double t, double x, int order) const override {
    if (!exact_) return std::nullopt;
    if (std::exchange(order_, order) != order) {
      jets_.clear();
      try {
        for (const FieldFormula& f : fields_) jets_.emplace_back(f.formula, numbers_, f.key, order);
      } catch (const expressions::TooLarge&) {
        jets_.clear();
      }
    }
    if (jets_.empty()) return std::nullopt;
    const std::size_t d = fields_.size();
    std::vector<double> all;
    for (std::size_t a = 0; a < d; ++a) {
      const std::vector<double> one = jets_[a](t, x);
      all.resize(one.size() * d);
      for (std::size_t n = 0; n < one.size(); ++n) all[n * d + a] = one[n];
    }
    return all;
  }
  int winding() const override { return winding_; }
  std::string description() const override {
    std::string line = "formula:";
    for (const FieldFormula& f : fields_) line += (&f == &fields_.front() ? " " : "; ") + f.text;
    if (seam_ > 1e-8) line += "; off by " + text(seam_) + " at the seam";
    return line;
  }

 private:
  /// f(0, L) − f(0, 0)
  double gain(const FieldFormula& f) const { return f.value(0, length_) - f.value(0, 0); }
  static double range_of(const FieldFormula& f, const Lattice& lattice) {
    double least = f.value(0, lattice.length()), most = least;
    for (int i = 0; i < lattice.sites(); ++i) {
      const double phi = f.value(0, lattice.position(i));
      least = std::min(least, phi), most = std::max(most, phi);
    }
    return most - least;
  }
  /// A tail that does not fit is no more than a small part of what the fields span. A solution is that of the line where it
  /// does not close: a run says how far it is off.
  void require_closed(const FieldFormula& f, double range) {
    constexpr double largest_part = 0.01;
    const double jump = std::abs(gain(f) - monodromy_),
                 rounding = 1e-12 * (std::abs(f.value(0, 0)) + std::abs(monodromy_));
    seam_ = std::max(seam_, jump);
    if (exact_ || !(jump > largest_part * range + rounding)) return;
    const double turns = gain(f) / (2 * std::numbers::pi), whole = std::round(turns);
    const bool winds = std::abs(turns - whole) < 1e-6 * std::max(1.0, std::abs(whole));
    throw BadInput(f.key, f.key + ": gains " + text(gain(f)) + " around the circle, and with boundary.winding = " +
                              std::to_string(winding_) + " it should gain " + text(monodromy_) +
                              ": it jumps at the seam by " + text(jump) + "; use " +
                              (winds ? "boundary.winding = " + text(whole)
                                     : "boundary.gain = " + text(gain(f)) + " without boundary.winding") +
                              ", a field that closes, or lattice.space = interval");
  }

  std::vector<FieldFormula> fields_;
  bool exact_, circle_;
  double length_, seam_ = 0, monodromy_ = 0;
  int winding_ = 0;
  std::vector<std::pair<std::string, double>> numbers_;
  mutable std::vector<FormulaJet> jets_;  ///< made when they are asked for
  mutable int order_ = -1;                ///< that they are of
};

/// initial.p is the start of a field that is called p.
bool names_a_field(const std::vector<std::string>& fields) { return std::ranges::find(fields, "p") != fields.end(); }

std::unique_ptr<State> formula(const StateBuild& build) {
  // theory.NAME as NAME, and the length of space
  std::vector<std::pair<std::string, double>> numbers = theory_numbers(build.values);
  if (build.lattice.space() != Space::point) numbers.emplace_back("L", build.lattice.length());

  const auto text_of = [&](const std::string& key) { return build.values.maybe<std::string>(key); };
  std::vector<FieldFormula> fields;
  std::optional<bool> all_exact;
  for (const std::string& name : build.request.fields) {
    const auto value = text_of(value_key(name)), velocity = text_of(velocity_key(name)),
               exact = text_of(exact_key(name));
    if (exact && (value || velocity))
      throw BadInput(exact_key(name), exact_key(name) + " = " + *exact + ": gives the start too; remove " +
                                          (value ? value_key(name) : velocity_key(name)));
    if (!exact && !value)
      throw BadInput(value_key(name), value_key(name) + ": must be given; write it as a formula of x, or " +
                                          exact_key(name) + " as one of t and x");
    if (all_exact.value_or(exact.has_value()) != exact.has_value())
      throw BadInput(exact_key(name),
                     exact_key(name) + ": must be given for all fields or for none; complete or remove it");
    all_exact = exact.has_value();
    if (exact)
      fields.push_back(
          {Formula(*exact, numbers, exact_key(name)), std::nullopt, name + " = " + *exact, exact_key(name), *exact});
    else {
      fields.push_back({Formula(*value, numbers, value_key(name)), std::nullopt, name + "(0, x) = " + *value,
                        value_key(name), *value});
      if (velocity) {
        fields.back().velocity.emplace(*velocity, numbers, velocity_key(name));
        fields.back().text += ", " + name + "_t(0, x) = " + *velocity;
      }
    }
  }
  if (build.values.has(momenta_key) && !names_a_field(build.request.fields)) {
    if (all_exact.value_or(false) || build.lattice.space() != Space::point)
      throw BadInput(
          momenta_key,
          std::string(momenta_key) + ": is for lattice.space = point and fields that are given at t = 0; leave it out");
    std::vector<double> q;
    for (const FieldFormula& f : fields) q.push_back(f.value(0, 0));
    const std::vector<double> v = velocities_of_momenta(build, q, velocity_key(build.request.fields.front()));
    for (std::size_t a = 0; a < fields.size(); ++a) {
      const std::string number = fmt::format("{:.17g}", v[a]);
      fields[a].velocity.emplace(number, numbers, momenta_key);
      fields[a].text += ", " + build.request.fields[a] + "_t(0, x) = " + text(v[a]) + " by its momentum";
    }
  }
  return std::make_unique<FormulaState>(std::move(fields), std::move(numbers), all_exact.value_or(false), build.lattice,
                                        build.request);
}

std::vector<Parameter> further(const std::vector<std::string>& fields) {
  std::vector<Parameter> all;
  const auto add = [&](const std::string& key, const std::string& help) {
    all.push_back({.key = key, .fallback = std::string(), .help = help, .otherwise = "none"});
  };
  for (const std::string& name : fields) add(value_key(name), name + "(0, x), a formula of x");
  for (const std::string& name : fields) add(velocity_key(name), "its rate there; 0 if not given");
  if (!names_a_field(fields))
    add(momenta_key, "p = dL/dq_t of every field on a point, separated by commas, in place of their rates");
  for (const std::string& name : fields)
    add(exact_key(name), name + "(t, x), a solution to start from and to compare with");
  return all;
}

}  // namespace
}  // namespace initial

extern const StateEntry formula_state;
const StateEntry formula_state{
    .name = "formula",
    .formula =
        "initial.FIELD (and initial.FIELD_t) by formulas of x, or exact.FIELD by one of t and x; chosen by these keys",
    .parameters = {},
    .exact = {},
    .approximate = {},
    .place = Place::anywhere,
    .build = initial::formula,
    .any_theory = true,
    .further = initial::further,
    .sources = {"delf"}};

}  // namespace delf

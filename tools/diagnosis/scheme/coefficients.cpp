// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/least_squares.hpp"

namespace delf {
namespace {

/// time + a space + b force + c velocity ≈ 0
struct Fit {
  double a = 1, b = 1, c = 0;
  double a_error = 0, b_error = 0, c_error = 0;
  double force = 0;
  double remains = 0;  ///< the largest |E| left, beside the largest force
  bool to_rounding = false;
  bool has_space = true, has_force = true;
  const char* rule = "";  ///< how φ_t is taken, if it is there
};

Eigen::VectorXd or_zero(const Eigen::VectorXd& column, double scale) {
  constexpr double rounding = 64 * std::numeric_limits<double>::epsilon();
  return column.cwiseAbs().maxCoeff() <= rounding * scale ? Eigen::VectorXd::Zero(column.size()) : column;
}

Fit fitted(const Sample::Split& s, bool friction, double half_step, double tolerance) {
  std::vector<Eigen::VectorXd> columns{-or_zero(s.space, s.scale), -or_zero(s.force, s.scale)};
  // φ_t backwards is its central difference less hφ_tt/2, and time is −φ_tt in the same units
  if (friction) columns.push_back(-or_zero(s.velocity - half_step * s.time, s.scale));
  const LeastSquares of = least_squares(s.time, columns);
  Fit fit{of.coefficients[0], of.coefficients[1], friction ? of.coefficients[2] : 0};
  fit.a_error = of.errors[0], fit.b_error = of.errors[1], fit.c_error = friction ? of.errors[2] : 0;
  fit.has_space = std::isfinite(fit.a_error), fit.has_force = std::isfinite(fit.b_error);
  fit.force = s.time.cwiseAbs().maxCoeff();  // as the rows have it
  fit.remains = of.remains / fit.force;
  fit.to_rounding = of.remains <= 10 * tolerance * s.scale;
  return fit;
}

// "4.02 ± 0.03"
std::string with_error(double value, double error) {
  if (std::abs(value) < 1e-9) return "0";
  if (!(error > 1e-9 * std::abs(value))) return fmt::format("{:.7g}", value);
  return fmt::format("{:.6g} ± {:.1g}", value, error);
}

std::string percent(double share) {
  return share < 1e-5 ? fmt::format("{:.1e}", share) : fmt::format("{:.2g} %", 100 * share);
}

/// The meaning of coefficients other than 1, 1, 0; empty if they are these.
std::string meaning(const Fit& fit, const Problem& p) {
  // Differences below what remains are not reported.
  const double blur = std::max(fit.to_rounding ? 1e-9 : 2 * fit.remains, 1e-9);
  const auto is = [&](double x, double target, double error) {
    return std::abs(x - target) <= std::max(4 * error, blur * std::max(1.0, std::abs(x)));
  };
  const double h = p.time_step, L = p.lattice.length();
  const bool field = p.lattice.space() != Space::point;
  std::vector<std::string> words;
  const bool a_right = !fit.has_space || is(fit.a, 1, fit.a_error),
             b_right = !fit.has_force || is(fit.b, 1, fit.b_error);
  const bool alike = fit.has_space && fit.has_force &&
                     is(fit.a / fit.b, 1, fit.a_error / std::abs(fit.a) + fit.b_error / std::abs(fit.b));
  const auto off = [](double ratio) { return fmt::format("{:.3g} %", 100 * std::abs(ratio - 1)); };
  if (!a_right && !b_right && alike && fit.b > 0) {
    const double ratio = std::sqrt(fit.b);
    words.push_back(fmt::format("the time step is {:.7g}, not {:.7g} (off by {}): try lattice.time_step = {:.10g}",
                                h * ratio, h, off(ratio), h * ratio));
  } else {
    if (!a_right) {
      if (fit.a > 0) {
        const double speed = std::sqrt(fit.a);
        words.push_back(fmt::format(
            "the wave speed is {:.7g}, or k is off by {}: try lattice.length = {:.10g}, or theory.speed = {:.10g}",
            speed, off(1 / speed), L / speed, speed * p.parameters.maybe<double>("theory.speed").value_or(1)));
      } else words.push_back(is(fit.a, 0, fit.a_error) ? "no D²φ acts" : "D²φ has the wrong sign");
    }
    if (!b_right) {
      if (is(fit.b, 0, fit.b_error)) words.push_back("no force N′(φ) acts");
      else if (is(fit.b, -1, fit.b_error)) words.push_back("the force N′(φ) has the wrong sign");
      else if (!field && fit.b > 0)
        words.push_back(
            fmt::format("the force is {:.7g} times that of the theory, or the time step is {:.7g}, not {:.7g} (off by "
                        "{}): try lattice.time_step = {:.10g}",
                        fit.b, h * std::sqrt(fit.b), h, off(std::sqrt(fit.b)), h * std::sqrt(fit.b)));
      else
        words.push_back(
            fmt::format("the force N′(φ) is {:.7g} times that of the theory (off by {})", fit.b, off(fit.b)));
    }
  }
  if (fit.c != 0 && !is(fit.c, 0, fit.c_error))
    words.push_back(fmt::format("there is friction {} φ_t, φ_t {}", with_error(fit.c, fit.c_error), fit.rule));
  return fmt::format("{}", fmt::join(words, ", and "));
}

std::string equation(const Fit& fit) {
  std::string text = "φ_tt = ";
  if (fit.has_space) text += fmt::format("({}) D²φ", with_error(fit.a, fit.a_error));
  if (fit.has_force) text += fmt::format("{}({}) N′(φ)", fit.has_space ? " + " : "", with_error(fit.b, fit.b_error));
  if (fit.c != 0) text += fmt::format(" − ({}) φ_t", with_error(fit.c, fit.c_error));
  return text;
}

std::string upper_first(std::string text) {
  if (!text.empty() && text[0] >= 'a' && text[0] <= 'z') text[0] = static_cast<char>(text[0] - 'a' + 'A');
  return text;
}

}  // namespace

std::optional<Finding> find_coefficients(const Evidence& evidence, const Sample& sample) {
  if (!can_be_split(evidence.problem)) return std::nullopt;
  std::optional<Fit> nearest;
  const double half = evidence.problem.time_step / 2;
  struct Rule {
    bool friction;
    double half;
    const char* words;
  };
  const std::array rules{Rule{false, 0, ""}, Rule{true, 0, "by central differences"},
                         Rule{true, half, "of the row before"}, Rule{true, -half, "of the row after"}};
  std::vector<std::pair<const NamedScheme*, Sample::Split>> splits;
  for (const NamedScheme& scheme : sample.schemes())
    if (auto split = sample.split(scheme.problem)) splits.emplace_back(&scheme, std::move(*split));
  for (const Rule& rule : rules)
    for (const auto& [scheme, split] : splits) {
      Fit fit = fitted(split, rule.friction, rule.half, evidence.tolerance);
      fit.rule = rule.words;
      if (fit.to_rounding) {
        const std::string means = meaning(fit, evidence.problem), keys = keys_of(scheme->problem, evidence.problem);
        if (means.empty()) continue;  // a scheme whose equations hold
        return Finding{"coefficients", fmt::format("{}. With it the rows solve the equations of {}{} to rounding: {}.",
                                                   upper_first(means), scheme->name,
                                                   keys.empty() ? "" : " (" + keys + ")", equation(fit))};
      }
      // Friction is reported if the rows are nearer by it than by any other scheme, and far nearer.
      if (!nearest || fit.remains < (rule.friction && nearest->c == 0 ? 0.1 : 1) * nearest->remains) nearest = fit;
    }
  if (!nearest) return std::nullopt;
  // Another scheme of the theory leaves as much as those that were tried differ by.
  const double explained = std::clamp(2 * sample.spread() / nearest->force, 0.02, 0.25);
  const std::string remains = percent(nearest->remains);
  if (nearest->remains > explained)
    return Finding{
        "coefficients",
        fmt::format("No time step, length or coefficient of this theory explains the rows: {} of the largest "
                    "force remains, at best with {}. It is another theory, or these are not its consecutive "
                    "rows.",
                    remains, equation(*nearest)),
        true, false};
  const std::string means = meaning(*nearest, evidence.problem);
  if (means.empty())
    return Finding{"coefficients",
                   fmt::format("The theory, the time step and the length are right to {} of the largest force: {}. The "
                               "scheme is none that was tried, or its steps were not solved to this tolerance.",
                               remains, equation(*nearest)),
                   true, false};
  return Finding{"coefficients",
                 fmt::format("{}. What remains is {} of the largest force: {}; the scheme is none that was "
                             "tried, or its steps were not solved to this tolerance.",
                             upper_first(means), remains, equation(*nearest)),
                 true, false};
}

}  // namespace delf

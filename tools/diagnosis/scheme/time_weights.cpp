// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "schemes/theories/field_theory.hpp"
#include "schemes/theories/theory_registry.hpp"
#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/least_squares.hpp"

namespace delf {
namespace {

struct Weights {
  std::array<double, 3> space{}, force{};
};

bool near(double x, double y) { return std::abs(x - y) < 1e-6; }
bool are(const std::array<double, 3>& w, double before, double at, double after) {
  return near(w[0], before) && near(w[1], at) && near(w[2], after);
}

std::string list(const std::array<double, 3>& w) {
  const auto number = [](double x) { return near(x, 0) ? std::string("0") : fmt::format("{:.6g}", x); };
  return fmt::format("{}, {}, {}", number(w[0]), number(w[1]), number(w[2]));
}

/// The weights for a linear force, of which three rows make φ_tt itself, N′(φ₊ − 2φ + φ₋) = N′(1) h² φ_tt: it is taken
/// at one of them.
std::optional<LeastSquares> with_one_force(const Eigen::VectorXd& time, const std::vector<Eigen::VectorXd>& columns,
                                           double allowed) {
  for (const std::size_t at : {4u, 3u, 5u}) {
    std::vector<Eigen::VectorXd> some = columns;
    for (const std::size_t other : {3u, 4u, 5u})
      if (other != at) some[other].setZero();
    if (LeastSquares fit = least_squares(time, some); fit.remains <= allowed) return fit;
  }
  return std::nullopt;
}

}  // namespace

// (φ_{j+1} − 2φ_j + φ_{j−1})/h² = Σ_r a_r D²φ_{j+r} + b_r N′(φ_{j+r}),  r = −1, 0, 1, of every scheme's D² and N′
std::optional<Finding> find_time_weights(const Evidence& evidence, const Sample& sample) {
  if (!can_be_split(evidence.problem) || evidence.rows < 9) return std::nullopt;
  const Problem given = completed(evidence.problem);
  const bool linear =
      make_theory(find_theory(given.theory), given.parameters)->density().nonlinearity() == Nonlinearity::none;
  for (const NamedScheme& scheme : sample.schemes()) {
    const auto at = sample.split(scheme.problem), before = sample.split(scheme.problem, -1),
               after = sample.split(scheme.problem, 1);
    if (!at || !before || !after || before->time.size() != at->time.size() || after->time.size() != at->time.size() ||
        at->time.size() < 24)
      continue;
    const double rounding = 64 * std::numeric_limits<double>::epsilon() * at->scale;
    std::vector<Eigen::VectorXd> columns;
    for (const auto* split : {&*before, &*at, &*after}) columns.push_back(-split->space);
    for (const auto* split : {&*before, &*at, &*after}) columns.push_back(-split->force);
    for (Eigen::VectorXd& column : columns)
      if (column.cwiseAbs().maxCoeff() <= rounding) column.setZero();
    const double allowed = 10 * evidence.tolerance * at->scale;
    // A matter of coefficients, or of nothing at all.
    if (least_squares(at->time, {columns[1], columns[4]}).remains <= allowed) return std::nullopt;
    const auto fit =
        linear ? with_one_force(at->time, columns, allowed) : std::optional(least_squares(at->time, columns));
    if (!fit || !(fit->remains <= allowed)) continue;
    Weights w;
    std::copy_n(fit->coefficients.begin(), 3, w.space.begin());
    std::copy_n(fit->coefficients.begin() + 3, 3, w.force.begin());
    const bool field = w.space != std::array<double, 3>{}, source = w.force != std::array<double, 3>{};
    const auto all_are = [&](double b, double a, double c) {
      return (!field || are(w.space, b, a, c)) && (!source || are(w.force, b, a, c));
    };
    if (all_are(1, 0, 0))
      return Finding{
          "time-weights",
          "The rows are those of explicit Euler: φ_tt at a row is the force at the row before it. Add the new "
          "φ_t to φ, not the old one, and they are leapfrog's."};
    if (all_are(0, 0, 1))
      return Finding{"time-weights",
                     "The rows are those of implicit Euler: φ_tt at a row is the force at the row after it."};
    std::vector<std::string> words;
    if (field) words.push_back(fmt::format("D²φ of the rows j − 1, j, j + 1 with the weights {}", list(w.space)));
    if (source) words.push_back(fmt::format("N′(φ) with the weights {}", list(w.force)));
    return Finding{
        "time-weights",
        fmt::format("The rows average in time: φ_tt at row j takes {}{}.", fmt::join(words, ", and "),
                    keys_of(scheme.problem, evidence.problem).empty() ? "" : " (D² and N′ of " + scheme.name + ")")};
  }
  return std::nullopt;
}

}  // namespace delf

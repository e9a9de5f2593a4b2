// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "tools/diagnosis/findings.hpp"
#include "tools/diagnosis/least_squares.hpp"
#include "tools/diagnosis/own_equations.hpp"
#include "tools/diagnosis/sampled_rows.hpp"

namespace delf {
namespace {

/// The quotients by which a program takes φ_t in a friction γ φ_t: of the rows above and below, or of the last step.
struct Quotient {
  const char* words;
  int from, to;  ///< rows from the one below the equation
};
constexpr Quotient quotients[] = {{"(y₊ − y₋)/2h", 0, 2}, {"(y − y₋)/h", 0, 1}};

/// γ of each site by E = hkm γ φ_t: the friction that makes its equations hold in all rows; nothing if none does, or few
/// sites need any.
std::optional<std::vector<double>> friction(const Evidence& e, const std::vector<int>& sites, const Quotient& by) {
  const auto S = sites.size();
  std::vector<Eigen::VectorXd> target(S, Eigen::VectorXd(sampled_rows(e))), step(target);
  const double largest = look_at_sampled_rows(e, e.monodromy, [&](std::int64_t n, const auto& rows, const auto& E) {
    for (std::size_t s = 0; s < S; ++s) {
      const std::size_t i = sites[s];
      target[s][n] = E[i].sum;
      step[s][n] = rows[by.to][i] - rows[by.from][i];
    }
  });
  const double allowed = 4 * e.tolerance * scale_of_terms(e.system, largest), h = e.system.time_step();
  std::vector<double> gamma;
  int explained = 0;
  for (std::size_t s = 0; s < S; ++s) {
    const LeastSquares fit = least_squares(target[s], {step[s]});
    if (!(fit.remains <= allowed)) return std::nullopt;
    if (target[s].lpNorm<Eigen::Infinity>() > 1e3 * allowed) ++explained;
    double mass = 0;  // −∂E/∂y₊ = km/h
    for (const Coefficient& c : e.system.linearised({0, sites[s]}, 0))
      if (c.offset.time == 1 && c.offset.space == 0) mass = -c.value;
    if (!(mass > 0)) return std::nullopt;
    gamma.push_back(fit.coefficients[0] * (by.to - by.from) / (h * mass));
  }
  if (explained < 3) return std::nullopt;
  return gamma;
}

}  // namespace

// Sites next to one another have a friction of their own, and the others none.
std::optional<Finding> find_sponge(const Evidence& e) {
  const Lattice& lattice = e.system.lattice();
  const auto sites = e.failed.sites();
  if (lattice.space() == Space::point || e.system.components() != 1 || e.system.height() != 1 || e.rows < 12 ||
      sites.size() < 3 || 2 * static_cast<std::int64_t>(e.failed.rows().size()) < e.failed.rows_tried() ||
      4 * static_cast<int>(sites.size()) > 3 * lattice.sites())
    return std::nullopt;
  for (const Quotient& by : quotients) {
    const auto gamma = friction(e, sites, by);
    if (!gamma) continue;
    const auto most = std::ranges::max_element(*gamma, {}, [](double g) { return std::abs(g); });
    std::string where;
    for (std::size_t first = 0; first < sites.size();) {
      std::size_t last = first;
      while (last + 1 < sites.size() && sites[last + 1] == sites[last] + 1) ++last;
      where += fmt::format("{}{} to {}", where.empty() ? "" : ", ", sites[first], sites[last]);
      first = last + 1;
    }
    return Finding{
        "sponge",
        fmt::format("An absorbing layer: at the sites {} there is a friction γ(x) φ_t, φ_t = {}, of {:.4g} at "
                    "most (site {}). Everywhere else the equations hold, and with it there too.",
                    where, by.words, *most, sites[most - gamma->begin()])};
  }
  return std::nullopt;
}

}  // namespace delf

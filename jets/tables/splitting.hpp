// SPDX-License-Identifier: MIT
#pragma once
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

#include "jets/tables/stencil_table.hpp"

namespace delf {

/// The correction of a kernel: kicks and drifts by turns, kicks[0], drifts[0], kicks[1], …, as fractions of h, one kick
/// more than drifts. Applied once to φ and its rate, they give the first row of the kernel, with the momenta below that
/// row; undone on a copy of a row, the same with signs turned in reverse order, they give φ and its rate there.
struct Processor {
  std::vector<double> kicks, drifts;
  bool empty() const { return kicks.empty(); }
};

/// One time step of length 1 in sub-steps: a sub-step s goes on by drifts[s], and between sub-steps, at its beginning
/// and at its end the potential part of the action acts with the weights kicks[0 … S]. Palindromes; both sum to 1, and
/// some weights go back in time. The kicks of two steps that meet are one.
struct Splitting {
  std::vector<double> kicks, drifts;
  Processor processor = {};  ///< none: rows are what they stand for
  double gradient = 0;  ///< g, if its one kick has g h² F₂² in the action, F₂ the force of the potential part
  double offset = 0;    ///< of its rows in time from the steps: fractions of h
};

inline constexpr int highest_splitting_order = 8;

/// The Splitting of order 2, 4, 6 or 8; without weights for an order that there is none for. Orders 4 and 6 count on an
/// action whose φ_t enters as ½φ_t² alone.
///
/// Sources: 4 and 6, of 6 and 11 sub-steps: S. Blanes, P. C. Moan, J. Comput. Appl. Math. 142 (2002) 313, Table 3,
/// "SRKN b" (at the same cost their errors are some ten and thirty times smaller than those of compositions of
/// leapfrog); 8, the composition of leapfrog steps of s17odr8a: W. Kahan, R.-C. Li, Math. Comp. 66 (1997) 1089.
inline Splitting splitting_of_order(int order) {
  // w_1 … w_n and a last one that brings the sum to 1, mirrored at it or after it
  const auto mirrored = [](std::vector<double> half, bool at_last) {
    double rest = at_last ? 1 : 0.5;
    for (const double w : half) rest -= at_last ? 2 * w : w;
    half.push_back(rest);
    const std::vector<double> given = half;
    half.insert(half.end(), given.rbegin() + (at_last ? 1 : 0), given.rend());
    return half;
  };
  switch (order) {
    case 2:
      return {{0.5, 0.5}, {1}};
    case 4:
      return {mirrored({0.0829844064174052, 0.396309801498368, -0.0390563049223486}, true),
              mirrored({0.245298957184271, 0.604872665711080}, false)};
    case 6:
      return {
          mirrored(
              {0.0414649985182624, 0.198128671918067, -0.0400061921041533, 0.0752539843015807, -0.0115113874206879},
              false),
          mirrored({0.123229775946271, 0.290553797799558, -0.127049212625417, -0.246331761062075, 0.357208872795928},
                   true)};
    case 8: {
      Splitting result;
      result.drifts =
          mirrored({0.13020248308889008087881763, 0.56116298177510838456196441, -0.38947496264484728640807860,
                    0.15884190655515560089621075, -0.39590389413323757733623154, 0.18453964097831570709183254,
                    0.25837438768632204729397911, 0.29501172360931029887096624},
                   true);
      const auto& gamma = result.drifts;
      result.kicks.push_back(gamma.front() / 2);
      for (std::size_t s = 1; s < gamma.size(); ++s) result.kicks.push_back((gamma[s - 1] + gamma[s]) / 2);
      result.kicks.push_back(gamma.back() / 2);
      return result;
    }
    default:
      return {};
  }
}

/// A splitting on one site, whose nodes are the rows between the sub-steps. In sub-step s, of the length a_s h,
///
///     L = Σ w ℓ(φ, φ_t)       over both rows of the sub-step, with φ of the row and φ_t = (q_above − q)/(a_s h).
///
/// The rows' weights w sum to a_s in a sub-step, and to the kick b at a row: leapfrog with its halves where both are
/// alike. Weights may be negative: a sub-step goes back then, and its measure is negative.
inline StencilTable splitting_element(const Splitting& splitting) {
  const std::vector<double>& fractions = splitting.drifts;
  const int S = static_cast<int>(fractions.size());
  StencilTable element{.pattern = {}, .points = {}, .nodes = {}};
  std::vector<double> times{0};
  for (const double fraction : fractions) {
    element.nodes.push_back({.time = times.back()});
    times.push_back(times.back() + fraction);
  }
  times.back() = 1;
  for (int s = 0; s <= S; ++s) element.pattern.vertices.push_back({.time = s / S, .space = 0, .node = s % S});
  double lower = 0, upper = 0;  // w of the two rows of a sub-step
  for (std::size_t s = 0; s < fractions.size(); ++s) {
    lower = splitting.kicks[s] - upper;
    upper = fractions[s] - lower;
    std::vector phi_t(fractions.size() + 1, 0.0);
    phi_t[s + 1] = 1 / fractions[s];
    phi_t[s] = -1 / fractions[s];
    for (const std::size_t row : {s, s + 1}) {
      const double weight = row == s ? lower : upper;
      if (std::abs(weight) < 1e-14) continue;  // no kick at this end of a step
      std::vector phi(phi_t.size(), 0.0);
      phi[row] = 1;
      TablePoint point{.weight = weight, .time = times[row] + splitting.offset, .slots = {}};
      point.set(JetSlot::phi, phi), point.set(JetSlot::phi_t, phi_t);
      element.points.push_back(std::move(point));
    }
  }
  return element;
}

/// Kernels that a processor makes accurate: fewer kicks a step than a Splitting of their effective order.
///
/// ti4, effective order 4, one kick a step, with a gradient: M. Takahashi, M. Imada, J. Phys. Soc. Jpn. 53 (1984) 3765.
/// It is half a drift, the kick, and half a drift; rows here are those of its kick, half a step after the steps'. b6,
/// effective order 6, six kicks a step. Both processors and b6 solve the order conditions modulo [B, [B, [B, A]]], found for
/// delf. Without weights for another name.
inline Splitting processed_splitting(std::string_view kernel) {
  if (kernel == "ti4") {
    return {.kicks = {0.5, 0.5},
            .drifts = {1},
            .processor = {.kicks = {0.14517794752584913, -0.23490285351377259, 0.08972490598792346, 0},
                          .drifts = {0.10962581259747214, -0.28700410342450847, 0.17737829082703633 + 0.5}},
            .gradient = 1. / 24,
            .offset = 0.5};
  }
  if (kernel == "b6") {
    const std::vector<double> kicks{0.15426122198939585, 0.31853107603989516,  -0.04360543987449397,
                                    0.14162628369040591, -0.04360543987449397, 0.31853107603989516,
                                    0.15426122198939585};
    // Below the kernel's first row, half of whose kick belongs to the step before.
    return {
        .kicks = kicks,
        .drifts = {0.30369867247212499, 0.45239193016891718, -0.25609060264104217, -0.25609060264104217,
                   0.45239193016891718, 0.30369867247212499},
        .processor = {.kicks = {0.059548543876326097, -0.026547929323253723, -0.10727531364448431,
                                -0.00010536307839572923, 0.073854548493523367, 0.00052551367628429908, -kicks.front()},
                      .drifts = {-0.16768434077177133, 0.24251221352932537, 0.14636529932537761, -0.086198192245715179,
                                 -0.24525447662922846, 0.11025949680201199}}};
  }
  return {};
}

}  // namespace delf

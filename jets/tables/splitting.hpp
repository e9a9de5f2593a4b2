// SPDX-License-Identifier: MIT
#pragma once
#include <cstddef>
#include <vector>

namespace delf {

/// One time step of length 1 in sub-steps: a sub-step s goes on by drifts[s], and between sub-steps, at its beginning
/// and at its end the potential part of the action acts with the weights kicks[0 … S]. Palindromes; both sum to 1, and
/// some weights go back in time. The kicks of two steps that meet are one.
struct Splitting {
  std::vector<double> kicks, drifts;
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

}  // namespace delf

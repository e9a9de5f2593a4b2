// SPDX-License-Identifier: MIT
#pragma once
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "jets/expressions/euler_lagrange.hpp"

namespace delf::expressions {

/// Sums relative to their terms that count as zero.
inline constexpr double zero_at_random_jets = 1e-11;

/// Calls with the values of the variables at random jets, the same ones each time: half of them from -1 to 1, half of them
/// between 0 and 2, where logarithms and roots have values.
void at_random_jets(const JetVariables&, const ExpressionNames&,
                    const std::function<void(std::span<const double> jet)>&);

/// The largest |Σ terms|/Σ|terms| at random jets at which all terms are numbers; nothing if there are none.
std::optional<double> largest_sum(const Graph&, const std::vector<int>& terms, const JetVariables&,
                                  const ExpressionNames&);

}  // namespace delf::expressions
